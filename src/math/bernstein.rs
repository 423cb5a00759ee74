//! Polynomials in Bernstein form over `[0, 1]`.
//!
//! `p(u) = Σ_k b_k C(n,k) u^k (1−u)^{n−k}`. What makes the form right for error bounds (Farouki 2012): the polynomial lies
//! within the range of its coefficients; its mean over `[0, 1]` is the mean of its coefficients; and every operation here is
//! a convex combination, so rounding never exceeds a few units in the last place of the largest coefficient.

use super::{Number, Real, each};

/// A cubic in Bernstein form.
pub type Cubic<R> = [R; 4];

/// `(1 − t) · a + t · b`, in the form that is exact for `a = b`: a plateau stays on the side of a jump that it is on.
#[inline(always)]
pub fn lerp<R: Number>(a: R, b: R, t: R) -> R {
    t.mul_plus(b - a, a)
}

/// Smallest and largest coefficient: an enclosure of the polynomial over `[0, 1]`.
#[inline(always)]
pub fn range<R: Number, const N: usize>(b: &[R; N]) -> [R; 2] {
    let [mut low, mut high] = [b[0], b[0]];
    for &x in &b[1..] {
        low = low.min(x);
        high = high.max(x);
    }
    [low, high]
}

/// Sum of the coefficients, which is the integral over `[0, 1]` times their number.
#[inline(always)]
pub fn sum<R: Number, const N: usize>(b: &[R; N]) -> R {
    let mut sum = b[0];
    for &x in &b[1..] {
        sum += x;
    }
    sum
}

/// Value at `u`, by de Casteljau's scheme.
#[inline(always)]
pub fn value<R: Number>(b: &Cubic<R>, u: R) -> R {
    blossom(b, u, u, u)
}

/// Derivative at `u`.
#[inline(always)]
pub fn slope<R: Number>(b: &Cubic<R>, u: R) -> R {
    let (p, q, r) = (lerp(b[0], b[1], u), lerp(b[1], b[2], u), lerp(b[2], b[3], u));
    R::from_f64(3.0) * (lerp(q, r, u) - lerp(p, q, u))
}

/// The polar form (Ramshaw 1989) of a cubic at three arguments.
#[inline(always)]
fn blossom<R: Number>(b: &Cubic<R>, u: R, v: R, w: R) -> R {
    let (p, q, r) = (lerp(b[0], b[1], u), lerp(b[1], b[2], u), lerp(b[2], b[3], u));
    lerp(lerp(p, q, v), lerp(q, r, v), w)
}

/// The same cubic over `[from, to]`, mapped to `[0, 1]`.
#[inline(always)]
pub fn restrict<R: Number>(b: &Cubic<R>, from: R, to: R) -> Cubic<R> {
    [blossom(b, from, from, from), blossom(b, from, from, to), blossom(b, from, to, to), blossom(b, to, to, to)]
}

/// The same cubic up to `u` and from there on, each mapped to `[0, 1]`: de Casteljau's scheme.
#[inline(always)]
pub fn split<R: Number>(b: &Cubic<R>, u: R) -> [Cubic<R>; 2] {
    let (p, q, r) = (lerp(b[0], b[1], u), lerp(b[1], b[2], u), lerp(b[2], b[3], u));
    let (s, t) = (lerp(p, q, u), lerp(q, r, u));
    let middle = lerp(s, t, u);
    [[b[0], p, s, middle], [middle, t, r, b[3]]]
}

/// The trilinear interpolant of eight corner values (x fastest) along the segment from `a` to `b` inside the unit cell: an
/// exact cubic. A trilinear function is affine in each argument, so its values at the corners of the box spanned by `a` and
/// `b` are its polar form, and the cubic's coefficients are means of those.
#[inline(always)]
pub fn trilinear_along<R: Number>(corners: &[R; 8], a: [R; 3], b: [R; 3]) -> Cubic<R> {
    let c = corners;
    // Along x, at a and b, for the four edges (y, z).
    let (x00, x10, x01, x11) =
        (lerp(c[0], c[1], a[0]), lerp(c[2], c[3], a[0]), lerp(c[4], c[5], a[0]), lerp(c[6], c[7], a[0]));
    let (w00, w10, w01, w11) =
        (lerp(c[0], c[1], b[0]), lerp(c[2], c[3], b[0]), lerp(c[4], c[5], b[0]), lerp(c[6], c[7], b[0]));
    // Then along y; names give the ends chosen for (x, y), the number the face in z.
    let (aa0, aa1) = (lerp(x00, x10, a[1]), lerp(x01, x11, a[1]));
    let (ab0, ab1) = (lerp(x00, x10, b[1]), lerp(x01, x11, b[1]));
    let (ba0, ba1) = (lerp(w00, w10, a[1]), lerp(w01, w11, a[1]));
    let (bb0, bb1) = (lerp(w00, w10, b[1]), lerp(w01, w11, b[1]));
    // Then along z.
    let (aaa, aab) = (lerp(aa0, aa1, a[2]), lerp(aa0, aa1, b[2]));
    let (aba, abb) = (lerp(ab0, ab1, a[2]), lerp(ab0, ab1, b[2]));
    let (baa, bab) = (lerp(ba0, ba1, a[2]), lerp(ba0, ba1, b[2]));
    let (bba, bbb) = (lerp(bb0, bb1, a[2]), lerp(bb0, bb1, b[2]));
    let third = R::from_f64(1.0 / 3.0);
    // As a deviation from one of the three, so that equal values give exactly that value.
    [aaa, mean(baa, aba, aab, third), mean(bba, bab, abb, third), bbb]
}

#[inline(always)]
fn mean<R: Number>(p: R, q: R, r: R, third: R) -> R {
    third.mul_plus((q - p) + (r - p), p)
}

/// Product of two cubics, of degree six.
#[inline(always)]
pub fn product<R: Number>(a: &Cubic<R>, b: &Cubic<R>) -> [R; 7] {
    // C(3,i) C(3,j) / C(6,i+j)
    const BINOMIAL_3: [f64; 4] = [1.0, 3.0, 3.0, 1.0];
    const BINOMIAL_6: [f64; 7] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
    let mut result = [R::ZERO; 7];
    for (i, &x) in a.iter().enumerate() {
        for (j, &y) in b.iter().enumerate() {
            let factor = R::from_f64(BINOMIAL_3[i] * BINOMIAL_3[j] / BINOMIAL_6[i + j]);
            result[i + j] = factor.mul_plus(x * y, result[i + j]);
        }
    }
    result
}

/// A cubic as a polynomial of degree six.
#[inline(always)]
pub fn elevate<R: Number>(a: &Cubic<R>) -> [R; 7] {
    product(a, &[R::ONE; 4])
}

/// Product with the linear function from `low` at 0 to `high` at 1; `M` must be `N + 1`.
#[inline(always)]
pub fn times_linear<R: Number, const N: usize, const M: usize>(b: &[R; N], low: R, high: R) -> [R; M] {
    const { assert!(M == N + 1, "the product has one more coefficient") };
    each(
        #[inline(always)]
        |k| {
            let t = R::from_f64(k as f64 / N as f64);
            let from_high = if k > 0 { t * high * b[k - 1] } else { R::ZERO };
            let from_low = if k < N { (R::ONE - t) * low * b[k] } else { R::ZERO };
            from_low + from_high
        },
    )
}

/// Where in the open interval `(0, 1)` the derivative of a cubic vanishes, ascending, and how many of the two count.
#[inline(always)]
pub fn critical_points<R: Real>(b: &Cubic<R>) -> ([R; 2], usize) {
    let (d0, d1, d2) = (b[1] - b[0], b[2] - b[1], b[3] - b[2]);
    let none = ([R::ZERO; 2], 0);
    if (d0 >= R::ZERO && d1 >= R::ZERO && d2 >= R::ZERO) || (d0 <= R::ZERO && d1 <= R::ZERO && d2 <= R::ZERO) {
        return none;
    }
    // d(u) = d0 (1−u)² + 2 d1 u (1−u) + d2 u²  =  a u² + 2 h u + d0.
    let a = (d0 - d1) + (d2 - d1);
    let h = d1 - d0;
    let discriminant = h * h - a * d0;
    if discriminant.partial_cmp(&R::ZERO) != Some(std::cmp::Ordering::Greater) {
        return none;
    }
    // The stable pair of roots: no difference of nearly equal numbers.
    let q = -(h + if h < R::ZERO { -discriminant.sqrt() } else { discriminant.sqrt() });
    let inside = |u: R| u > R::ZERO && u < R::ONE;
    let (first, second) = (d0 / q, q / a);
    match (inside(first), inside(second)) {
        (true, true) => ([first.min(second), first.max(second)], 2),
        (true, false) => ([first, R::ZERO], 1),
        (false, true) => ([second, R::ZERO], 1),
        (false, false) => none,
    }
}

/// Where a cubic that is monotone on `[from, to]` takes the value `target`, which lies between its values at the ends.
/// Newton's iteration kept inside a shrinking bracket, so that it always ends.
#[inline]
pub fn crossing<R: Real>(b: &Cubic<R>, target: R, from: R, to: R) -> R {
    let (mut low, mut high) = (from, to);
    let rising = value(b, to) > value(b, from);
    let half = R::from_f64(0.5);
    let mut u = half * (low + high);
    for _ in 0..80 {
        let (p, q, r) = (lerp(b[0], b[1], u), lerp(b[1], b[2], u), lerp(b[2], b[3], u));
        let (s, t) = (lerp(p, q, u), lerp(q, r, u));
        let miss = lerp(s, t, u) - target;
        if miss == R::ZERO {
            return u;
        }
        if (miss > R::ZERO) == rising {
            high = u;
        } else {
            low = u;
        }
        let slope = R::from_f64(3.0) * (t - s);
        let newton = u - miss / slope;
        // NaN and infinity from a flat place fail the comparison and bisect.
        let next = if newton > low && newton < high { newton } else { half * (low + high) };
        if (next - u).abs() <= R::EPSILON * half || next <= low || next >= high {
            return next;
        }
        u = next;
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trilinear(c: &[f64; 8], [x, y, z]: [f64; 3]) -> f64 {
        let at = |i: usize, x: f64| if i == 1 { x } else { 1.0 - x };
        (0..8).map(|n| c[n] * at(n & 1, x) * at(n >> 1 & 1, y) * at(n >> 2, z)).sum()
    }

    const CORNERS: [f64; 8] = [3.0, -70.0, 12.5, 900.0, -1000.0, 41.0, 300.0, 77.0];

    #[test]
    fn a_trilinear_function_along_a_segment_is_this_cubic() {
        let (a, b) = ([0.1, 0.9, 0.0], [0.7, 0.2, 1.0]);
        let cubic = trilinear_along(&CORNERS, a, b);
        for i in 0..=20 {
            let u = f64::from(i) / 20.0;
            let point = std::array::from_fn(|k| lerp(a[k], b[k], u));
            let (found, expected) = (value(&cubic, u), trilinear(&CORNERS, point));
            assert!((found - expected).abs() < 1e-11, "at {u}: found {found}, expected {expected}");
        }
    }

    #[test]
    fn a_constant_stays_exactly_constant_in_f32() {
        let cubic = trilinear_along(&[0.1f32; 8], [0.3, 0.77, 0.123], [0.9, 0.01, 0.456]);
        assert_eq!(cubic, [0.1; 4]);
        assert_eq!(restrict(&cubic, 0.123, 0.456), [0.1; 4]);
    }

    #[test]
    fn restriction_keeps_the_values() {
        let cubic = [1.0, -4.0, 9.0, 2.0];
        let part = restrict(&cubic, 0.25, 0.75);
        for i in 0..=10 {
            let u = f64::from(i) / 10.0;
            assert!((value(&part, u) - value(&cubic, 0.25 + 0.5 * u)).abs() < 1e-14);
        }
        for at in [0.0, 0.3, 1.0] {
            let (halves, parts) = (split(&cubic, at), [restrict(&cubic, 0.0, at), restrict(&cubic, at, 1.0)]);
            let apart = (0..8).map(|k| (halves[k / 4][k % 4] - parts[k / 4][k % 4]).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-14, "split at {at}: {halves:?}, expected {parts:?}");
        }
    }

    #[test]
    fn products_are_the_products_of_the_values() {
        let (a, b) = ([1.0, -4.0, 9.0, 2.0], [0.5, 3.0, -1.0, 0.25]);
        let p = product(&a, &b);
        let q: [f64; 5] = times_linear(&a, 2.0, -1.0);
        for i in 0..=10 {
            let u = f64::from(i) / 10.0;
            let bernstein = |c: &[f64]| {
                let n = c.len() - 1;
                let choose = |k: usize| (0..k).fold(1.0, |x, i| x * (n - i) as f64 / (i + 1) as f64);
                (0..=n).map(|k| c[k] * choose(k) * u.powi(k as i32) * (1.0 - u).powi((n - k) as i32)).sum::<f64>()
            };
            assert!((bernstein(&p) - value(&a, u) * value(&b, u)).abs() < 1e-13, "product at {u}");
            assert!((bernstein(&q) - value(&a, u) * lerp(2.0, -1.0, u)).abs() < 1e-13, "times linear at {u}");
        }
    }

    #[test]
    fn critical_points_are_found_in_order() {
        // p' ∝ (u − 0.2)(u − 0.7): coefficients by integrating its Bernstein form.
        let (d0, d1, d2) = (0.14, 0.14 - 0.45, 0.14 - 0.9 + 1.0);
        let cubic = [0.0, d0, d0 + d1, d0 + d1 + d2];
        let (points, count) = critical_points(&cubic);
        assert_eq!(count, 2);
        assert!((points[0] - 0.2).abs() < 1e-12 && (points[1] - 0.7).abs() < 1e-12, "{points:?}");
        assert_eq!(critical_points(&[0.0, 1.0, 2.0, 3.0]).1, 0, "a straight line has none");
        assert_eq!(critical_points(&[5.0f32; 4]).1, 0, "nor has a constant");
        let (parabola, count) = critical_points(&[0.0, 1.0, 1.0, 0.0]);
        assert!(count == 1 && (parabola[0] - 0.5f64).abs() < 1e-15, "a vanishing cubic term: {parabola:?}");
    }

    #[test]
    fn crossings_are_found_to_rounding() {
        let cubic = [-3.0, 4.0, 5.0, 30.0];
        for i in 1..50 {
            let target = -3.0 + 33.0 * f64::from(i) / 50.0;
            let u = crossing(&cubic, target, 0.0, 1.0);
            assert!((value(&cubic, u) - target).abs() < 1e-13, "target {target}: found {}", value(&cubic, u));
        }
        // A triple root, where Newton's iteration is slow and the derivative vanishes.
        let flat = [-1.0, 1.0, -1.0, 1.0].map(|x: f64| x * 0.125);
        let u = crossing(&flat, 0.0, 0.0, 1.0);
        assert!((u - 0.5).abs() < 1e-5, "found {u}");
    }
}
