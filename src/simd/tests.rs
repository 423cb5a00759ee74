//! One body over all levels: every lane does what one number does, to the bit.

use super::{
    Around, Away, BATCH, Doubles, Ints, Kernel, Lanes, Level, Mask, Pairs, Stencil, TWO_BATCHES, Table, Tables,
};
use crate::math::each;

/// Numbers of all magnitudes, signs and roundings, the same on each call.
fn numbers(count: usize, seed: u32) -> Vec<f32> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state
    };
    let of = |bits: u32, by: i32| (bits as f32 / u32::MAX as f32 - 0.5) * 2f32.powi(by % 20);
    (0..count).map(|_| of(next(), next() as i32 >> 8)).collect()
}

/// Samples at any place and at places with a good many on either side, with their neighbours.
#[inline(always)]
fn with_neighbours<V: Pairs, L: Lanes>(samples: &[V], places: L::Ints, inner: L::Ints) -> Vec<L> {
    let Around { lines, rows, slabs } = V::around::<L>(samples, inner, &Stencil::new(2, 5));
    let pairs = [
        V::pairs::<L, 1>(samples, places, &Away::HERE).to_vec(),
        V::pairs::<L, 2>(samples, inner, &Away::new([-3, 2])).to_vec(),
    ];
    let quads = [
        V::quads::<L, 1>(samples, places, &Away::HERE).to_vec(),
        V::quads::<L, 2>(samples, inner, &Away::new([-8, 700])).to_vec(),
    ];
    let pairs = [&pairs.concat()[..], &rows, &slabs].concat().concat();
    let quads = [&quads.concat()[..], &lines].concat().concat();
    let differences = [pairs[0] - pairs[3], quads[0] - quads[3]];
    let stored = [&pairs[..], &quads, &differences].concat();
    let rises = [
        V::rises::<L, 1>(samples, places, &Away::HERE).to_vec(),
        V::rises::<L, 2>(samples, inner, &Away::new([-3, 2])).to_vec(),
    ];
    stored.into_iter().map(V::to_lanes).chain(rises.concat().concat()).collect()
}

/// Everything that lanes compute, as bits, 16 numbers at a time whatever the level.
struct Everything;

impl Kernel for Everything {
    type Output = Vec<u32>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<u32> {
        let (a, b) = (numbers(4096, 1), numbers(4096, 2));
        let samples: Vec<i16> = numbers(999, 3).iter().map(|x| (x * 100.0) as i16).collect();
        let tables = [9, 31, 50].map(|n| Table::new(&numbers(n, 4)));
        let bytes: Vec<u8> = samples.iter().map(|&x| x as u8).collect();
        let places: Vec<i32> = a.iter().map(|x| (x.abs() * 7.0) as i32).collect();
        let wholes: Vec<i32> = samples.iter().map(|&x| i32::from(x) * 77).collect();
        let sixteen: [f32; BATCH] = std::array::from_fn(|i| b[i]);
        let thirty_two: [f32; TWO_BATCHES] = std::array::from_fn(|i| b[i]);
        let mut out = vec![Vec::new(); 166];
        for at in (0..4096).step_by(L::LANES) {
            let (x, y) = (L::load(&a[at..]), L::load(&b[at..]));
            let places = L::Ints::load(&places[at..]);
            let less = x.lt(y);
            let whole = x.round().to_ints();
            let found = [
                x + y,
                x - y,
                x * y,
                x / y,
                -x,
                x.min(y),
                x.max(y),
                x.abs().sqrt(),
                x.abs().absorbed(),
                x.abs().mean_transmittance(),
                L::select(less, x, y),
                x.round(),
                L::from_ints(whole),
                L::from_ints(x.to_ints()),
                L::power_of_two(L::Ints::select(less, L::Ints::splat(-126), L::Ints::splat(127))),
                L::pick(&tables[0], places),
                L::pick(&tables[1], places),
                L::pick(&tables[2], places),
                L::from_ints(places + whole - L::Ints::splat(3)),
                x.mul_plus(y, x),
                x.minus_product(y, y),
                L::select(x.le(x).and(less), x, y),
                L::select(less.or(y.lt(L::ZERO)), x, y),
                L::select(<L::Mask as Mask>::ALL.and_not(less), x, y),
                L::select(places.eq(L::Ints::splat(7)), x, y),
                L::select(places.lt(whole), x, y),
                L::from_ints(places * whole - places.min(whole).shifted_right(2)),
                L::from_ints(whole.and(L::Ints::splat(0xff0f)) + places.max(whole)),
                L::pick16(&sixteen, places),
                L::pick32(&thirty_two, places),
            ];
            let (d, e) = (L::Doubles::from_ints(places) * L::Doubles::splat(0.37), L::Doubles::from_ints(whole));
            let few = L::Ints::splat(3).min(places.max(whole));
            let few = few.max(L::Ints::splat(0));
            let more = [
                L::from_doubles(d - e),
                L::from_doubles(x.to_doubles() * y.to_doubles()),
                L::from_doubles(d.floor() + e),
                L::from_doubles(d.mul_plus(e, d)),
                L::from_doubles(d.min(e)),
                L::from_doubles(L::Doubles::select(d.lt(e), d * e, e)),
                L::from_doubles(L::Doubles::select(d.le(e).and_not(less), d, e)),
                L::from_ints(d.to_ints()),
                L::from_ints(few * whole),
                L::from_ints(whole.without_low_bits(few)),
                L::from_ints(few.power_of_two()),
                L::from_ints(L::Ints::bytes(&bytes, places)),
                L::gather(&b[..777], places),
                L::from_ints(L::Ints::gather(&wholes, places)),
            ];
            let mut lanes = vec![0.0; L::LANES];
            let near = places.and(L::Ints::splat(0xff)) + L::Ints::splat(8);
            let vectors = L::vectors(b.as_chunks::<4>().0, near);
            let read = [with_neighbours::<i16, L>(&samples, places, near), with_neighbours::<f32, L>(&b, places, near)];
            for (k, v) in found.into_iter().chain(read.concat()).chain(vectors).chain(more).enumerate() {
                v.store(&mut lanes);
                out[k].extend(lanes.iter().map(|v| v.to_bits()));
            }
        }
        for batch in a.as_chunks::<BATCH>().0 {
            let (before, all) = L::accumulated(&batch.map(|x| crate::math::absorbed_f32(x.abs())));
            out[164].extend(before.map(f32::to_bits));
            out[165].extend([(all + L::sum(batch)).to_bits(); BATCH]);
        }
        out.concat()
    }
}

#[test]
fn every_level_computes_the_same_bits() {
    let expected = Level::Scalar.run(Everything);
    for level in Level::ALL.into_iter().filter(|l| l.is_available()) {
        let found = level.run(Everything);
        assert_eq!(found.len(), expected.len());
        for (at, (f, e)) in found.iter().zip(&expected).enumerate() {
            // The sign and payload of a NaN mean nothing.
            let (f, e) = (f32::from_bits(*f), f32::from_bits(*e));
            assert!(
                f.to_bits() == e.to_bits() || (f.is_nan() && e.is_nan()),
                "{level}, operation {}: {f:?}, one number gives {e:?}",
                at / 4096
            );
        }
    }
}

/// The lanes of a register below a bound, moved to the front.
struct Below(f32);

impl Kernel for Below {
    type Output = (Vec<f32>, Vec<i32>);

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let all = numbers(512, 9);
        let (mut kept, mut from) = (Vec::new(), Vec::new());
        let (mut lanes, mut ints) = (vec![0.0; L::LANES], vec![0; L::LANES]);
        for at in (0..512).step_by(L::LANES) {
            let x = L::load(&all[at..]);
            let mask = x.lt(L::from_f64(f64::from(self.0)));
            let count = mask.bits().count_ones() as usize;
            x.compress(mask).store(&mut lanes);
            let place = L::Ints::count() + L::Ints::splat(at as i32);
            place.compress(mask).store(&mut ints);
            kept.extend(&lanes[..count]);
            from.extend(&ints[..count]);
            assert_eq!(mask.any(), count > 0);
        }
        (kept, from)
    }
}

/// Numbers put where a mask is true, in order: what [`Below`] takes out, put back.
struct PutBack(f32);

impl Kernel for PutBack {
    type Output = (Vec<f32>, Vec<i32>);

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let all = numbers(512, 9);
        let (mut put, mut ranks) = (vec![0.0; 512], vec![0; 512]);
        for at in (0..512).step_by(L::LANES) {
            let x = L::load(&all[at..]);
            let mask = x.lt(L::from_f64(f64::from(self.0)));
            L::select(mask, x.compress(mask).expand(mask), L::ZERO).store(&mut put[at..]);
            let place = L::Ints::count() + L::Ints::splat(at as i32);
            let back = place.compress(mask).expand(mask);
            L::Ints::select(mask, back, L::Ints::splat(-1)).store(&mut ranks[at..]);
        }
        (put, ranks)
    }
}

#[test]
fn expansion_undoes_compression() {
    for bound in [-1e30, -0.5, 0.0, 3.0, 1e30] {
        let all = numbers(512, 9);
        let put: Vec<f32> = all.iter().map(|&x| if x < bound { x } else { 0.0 }).collect();
        let ranks: Vec<i32> = (0..512).map(|i| if all[i as usize] < bound { i } else { -1 }).collect();
        for level in Level::ALL {
            assert_eq!(level.run(PutBack(bound)), (put.clone(), ranks.clone()), "{level}, below {bound}");
        }
    }
}

#[test]
fn compression_keeps_what_is_chosen_in_order() {
    for bound in [-1e30, -0.5, 0.0, 3.0, 1e30] {
        let all = numbers(512, 9);
        let from: Vec<i32> = (0..512).filter(|&i| all[i as usize] < bound).collect();
        let kept: Vec<f32> = from.iter().map(|&i| all[i as usize]).collect();
        for level in Level::ALL {
            assert_eq!(level.run(Below(bound)), (kept.clone(), from.clone()), "{level}, below {bound}");
        }
    }
}

/// Vectors of four rows of numbers, as every level stores them.
struct Stored;

impl Kernel for Stored {
    type Output = Vec<[f32; 4]>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let rows: [Vec<f32>; 4] = std::array::from_fn(|c| numbers(512, c as u32));
        let mut all = Vec::new();
        for at in (0..512).step_by(L::LANES) {
            let mut vectors = [[0.0; 4]; BATCH];
            L::store_vectors(each(|c| L::load(&rows[c][at..])), &mut vectors);
            // And back.
            let loaded = L::load_vectors(&vectors);
            L::store_vectors(loaded, &mut vectors);
            all.extend_from_slice(&vectors[..L::LANES]);
        }
        all
    }
}

#[test]
fn vectors_are_stored_lane_by_lane() {
    let rows: [Vec<f32>; 4] = std::array::from_fn(|c| numbers(512, c as u32));
    let bits = |all: Vec<[f32; 4]>| all.concat().into_iter().map(f32::to_bits).collect::<Vec<u32>>();
    let expected = bits((0..512).map(|k| each(|c| rows[c][k])).collect());
    for level in Level::ALL {
        assert_eq!(bits(level.run(Stored)), expected, "{level}");
    }
}

/// Entries of tables, looked up together, number by number.
struct Picked<'t>(&'t [[f32; 3]]);

impl Kernel for Picked<'_> {
    type Output = Vec<[f32; 3]>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let tables = Tables::new(self.0);
        let mut all = Vec::new();
        for at in (0..64).step_by(L::LANES) {
            let found = tables.pick::<L>(L::Ints::count() + L::Ints::splat(at));
            let mut rows = [[0.0; BATCH]; 3];
            found.into_iter().zip(&mut rows).for_each(|(x, row)| x.store(row));
            all.extend((0..L::LANES).map(|k| rows.map(|row| row[k])));
        }
        all
    }
}

#[test]
fn tables_are_looked_up_together_as_one_by_one() {
    for entries in [1, 3, 16, 17, 32, 50] {
        let tables: Vec<[f32; 3]> = (0..entries).map(|k| [0.5, 100.0, -7.0].map(|x| x * k as f32 + x)).collect();
        let expected: Vec<[f32; 3]> = (0..64).map(|k| tables[Ord::min(k, entries - 1)]).collect();
        for level in Level::ALL {
            assert_eq!(level.run(Picked(&tables)), expected, "{level}, {entries} entries");
        }
    }
}

#[test]
fn levels_are_known_by_name() {
    for level in Level::ALL.into_iter().filter(|l| l.is_available()) {
        assert_eq!(level.to_string().parse(), Ok(level));
    }
    assert!("sse".parse::<Level>().unwrap_err().contains("avx2"), "a wrong name lists the right ones");
    assert!(Level::widest().is_available() && Level::Scalar.is_available());
}

#[test]
fn accumulated_opacity_is_accurate_however_small() {
    for opacity in [1e-30f32, 1e-8, 1e-3, 0.25, 1.0] {
        let (before, all) = f32::accumulated(&[opacity; BATCH]);
        for (k, &found) in before.iter().chain([&all]).enumerate().skip(1) {
            let expected = -(k as f64 * (-f64::from(opacity)).ln_1p()).exp_m1();
            let apart = (f64::from(found) / expected - 1.0).abs();
            assert!(apart < 1e-6, "{k} of opacity {opacity:e}: {found:e}, expected {expected:e}");
        }
    }
}
