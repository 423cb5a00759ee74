//! Arrays by index in kernels.

/// The array of `f(0), f(1), …`, of at least one element. As [`std::array::from_fn`], but a plain loop: that one's closures
/// are left as calls in nested generic code, which cost a fifth of a kernel's time when measured.
#[inline(always)]
pub fn each<T: Copy, const N: usize>(mut f: impl FnMut(usize) -> T) -> [T; N] {
    let mut all = [f(0); N];
    for (k, x) in all.iter_mut().enumerate().skip(1) {
        *x = f(k);
    }
    all
}
