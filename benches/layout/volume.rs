//! Volumes in each layout, and what a kernel reads of them.
#![allow(unsafe_code, reason = "reads at places that are known to be there")]

use super::rays::{BITS, Picture};
use super::registers::{Floats, Ints, pairs_around, quads_around};

/// Edge of a brick, cells, as a power of two, 0 for lines; and of how many axes, x first, it stores neighbours of its cells.
pub(crate) struct Layout {
    pub(crate) name: &'static str,
    log2: usize,
    aprons: usize,
}

pub(crate) const LAYOUTS: [Layout; 6] = [
    Layout { name: "lines", log2: 0, aprons: 0 },
    Layout { name: "8³, apron", log2: 3, aprons: 3 },
    Layout { name: "16³, apron", log2: 4, aprons: 3 },
    Layout { name: "8³, apron along x", log2: 3, aprons: 1 },
    Layout { name: "16³, apron along x", log2: 4, aprons: 1 },
    Layout { name: "8³, no apron", log2: 3, aprons: 0 },
];

/// Samples behind the last one, which are read with it.
const BEHIND: usize = 4;

pub(crate) trait Measured {
    /// The sum of all samples of a picture.
    fn sum(&self, picture: &Picture) -> f64;
    /// Memory, times that of the samples.
    fn memory(&self) -> f64;
}

impl<const L: usize, const LIT: bool> Measured for Laid<L, LIT> {
    fn sum(&self, picture: &Picture) -> f64 {
        // SAFETY: `main` has asked the processor.
        unsafe { self.walked(picture) }
    }
    fn memory(&self) -> f64 {
        (self.samples.len() - BEHIND) as f64 / self.dims.iter().product::<usize>() as f64
    }
}

/// Samples in layout number `L`, with the apron that values need, or the one that gradients do.
pub(crate) struct Laid<const L: usize, const LIT: bool> {
    samples: Vec<i16>,
    dims: [usize; 3],
    /// Distances in memory from brick to brick.
    bricks: [i32; 3],
}

impl<const L: usize, const LIT: bool> Laid<L, LIT> {
    const LINES: bool = LAYOUTS[L].log2 == 0;
    const APRONS: usize = LAYOUTS[L].aprons;
    const LOG2: usize = LAYOUTS[L].log2;
    /// Voxels that a brick stores besides its cells' lower corners, along axes with an apron: before them, and in all.
    const BEFORE: usize = if LIT { 1 } else { 0 };
    const APRON: usize = if LIT { 3 } else { 1 };
    const EDGE_X: usize = (1 << Self::LOG2) + if Self::APRONS > 0 { Self::APRON } else { 0 };
    const EDGE: usize = (1 << Self::LOG2) + if Self::APRONS > 1 { Self::APRON } else { 0 };

    pub(crate) fn new(dims: [usize; 3]) -> Self {
        let edges = if Self::LINES { dims } else { [Self::EDGE_X, Self::EDGE, Self::EDGE] };
        let count = if Self::LINES { [1; 3] } else { dims.map(|n| n.div_ceil(1 << Self::LOG2)) };
        let of_brick: usize = edges.iter().product();
        let mut samples = Vec::with_capacity(of_brick * count.iter().product::<usize>() + BEHIND);
        // Where a stored voxel comes from, brick by brick.
        let from = [0, 1, 2].map(|a| {
            let before = if a < Self::APRONS { Self::BEFORE } else { 0 };
            let place = |n: usize| (((n / edges[a]) << Self::LOG2) + n % edges[a]).saturating_sub(before);
            (0..edges[a] * count[a]).map(|n| place(n).min(dims[a] - 1)).collect::<Vec<usize>>()
        });
        let [xs, ys, zs] = [0, 1, 2].map(|a| from[a].chunks(edges[a]));
        for zs in zs {
            for ys in ys.clone() {
                for xs in xs.clone() {
                    for (&k, &j) in zs.iter().flat_map(|k| ys.iter().map(move |j| (k, j))) {
                        samples.extend(xs.iter().map(|i| ((i * 7 + j * 13 + k * 29) & 2047) as i16));
                    }
                }
            }
        }
        samples.extend([0; BEHIND]);
        let bricks = [of_brick, of_brick * count[0], of_brick * count[0] * count[1]].map(|n| n as i32);
        Laid { samples, dims, bricks }
    }

    /// Distance in memory to the next voxel of a brick: known to the compiler, but for lines.
    #[inline(always)]
    fn stride(&self, a: usize) -> i32 {
        let (x, y) = if Self::LINES { (self.dims[0], self.dims[1]) } else { (Self::EDGE_X, Self::EDGE) };
        [1, x as i32, (x * y) as i32][a]
    }

    /// What a coordinate adds to a place in memory: computed, which takes less time than looking it up.
    #[inline(always)]
    fn term(&self, a: usize, at: Ints) -> Ints {
        let within = at * Ints::splat(self.stride(a));
        if Self::LINES {
            return within;
        }
        let brick = at.shifted_right(Self::LOG2 as i32);
        within + brick * Ints::splat(self.bricks[a] - (self.stride(a) << Self::LOG2))
    }

    /// The pairs at a cell's lower corner, on lines that lie so many voxels further along y and z.
    #[inline(always)]
    fn pairs<const N: usize>(&self, [x, y, z]: [Ints; 3], lines: [[i32; 2]; N]) -> [[Floats; 2]; N] {
        let mut pairs = [[Floats::splat(0.0); 2]; N];
        // SAFETY: `Picture` has no sample nearer to the border than a voxel, nor than two from the far one; see `walked`.
        unsafe {
            if Self::LINES || Self::APRONS == 3 {
                let at = self.term(0, x) + self.term(1, y) + self.term(2, z);
                return pairs_around(self.first(), at, self.away(lines));
            }
            for n in 0..N {
                let line = self.term(1, y + Ints::splat(lines[n][0])) + self.term(2, z + Ints::splat(lines[n][1]));
                [pairs[n]] = pairs_around(self.first(), line + self.term(0, x), [0]);
                if Self::APRONS == 0 {
                    let next = line + self.term(0, x + Ints::splat(1));
                    [[pairs[n][1], _]] = pairs_around(self.first(), next, [0]);
                }
            }
        }
        pairs
    }

    /// Likewise the voxels from one before the corner to two behind it.
    #[inline(always)]
    fn quads<const N: usize>(&self, [x, y, z]: [Ints; 3], lines: [[i32; 2]; N]) -> [[Floats; 4]; N] {
        let mut quads = [[Floats::splat(0.0); 4]; N];
        // SAFETY: as for pairs.
        unsafe {
            if Self::LINES || Self::APRONS == 3 {
                let at = self.term(0, x) + self.term(1, y) + self.term(2, z);
                return quads_around(self.first().sub(1), at, self.away(lines));
            }
            for n in 0..N {
                let line = self.term(1, y + Ints::splat(lines[n][0])) + self.term(2, z + Ints::splat(lines[n][1]));
                if Self::APRONS == 1 {
                    [quads[n]] = quads_around(self.first().sub(1), line + self.term(0, x), [0]);
                    continue;
                }
                for k in 0..4 {
                    let at = line + self.term(0, x + Ints::splat(k as i32 - 1));
                    [[quads[n][k], _]] = pairs_around(self.first(), at, [0]);
                }
            }
        }
        quads
    }

    /// Where the first cell's lower corner is.
    #[inline(always)]
    fn first(&self) -> *const i16 {
        let axes = if Self::LINES { 0 } else { Self::APRONS };
        let before: i32 = (0..axes).map(|a| self.stride(a)).sum();
        self.samples[before as usize * Self::BEFORE..].as_ptr()
    }

    #[inline(always)]
    fn away<const N: usize>(&self, lines: [[i32; 2]; N]) -> [isize; N] {
        let mut away = [0; N];
        for n in 0..N {
            away[n] = (lines[n][0] * self.stride(1) + lines[n][1] * self.stride(2)) as isize;
        }
        away
    }

    /// Value, and length of the gradient, of cells with these lower corners.
    #[inline(always)]
    fn sample(&self, corner: [Ints; 3], at: [Floats; 3]) -> Floats {
        let cell = [[0, 0], [1, 0], [0, 1], [1, 1]];
        if !LIT {
            return trilinear(self.pairs(corner, cell), at);
        }
        let [a, b, c, d] = self.quads(corner, cell);
        let [above_a, above_c, below_b, below_d] = self.pairs(corner, [[-1, 0], [-1, 1], [2, 0], [2, 1]]);
        let [front_a, front_b, behind_c, behind_d] = self.pairs(corner, [[0, -1], [1, -1], [0, 2], [1, 2]]);
        let mut along_x = [[Floats::splat(0.0); 2]; 4];
        for (n, line) in [a, b, c, d].into_iter().enumerate() {
            along_x[n] = [line[2] - line[0], line[3] - line[1]];
        }
        let x = trilinear(along_x, at);
        let [a, b, c, d] = [[a[1], a[2]], [b[1], b[2]], [c[1], c[2]], [d[1], d[2]]];
        let y = across([above_a, a, above_c, c], [b, below_b, d, below_d], at);
        let z = across([front_a, front_b, a, b], [c, d, behind_c, behind_d], at);
        trilinear([a, b, c, d], at) + (x * x + y * y + z * z).sqrt()
    }

    /// The sum of all samples of a picture.
    #[target_feature(enable = "avx2,fma")]
    fn walked(&self, picture: &Picture) -> f64 {
        // Whatever is read of a cell of the picture is there.
        assert_eq!(self.dims, picture.dims());
        let (step, mut sum) = (picture.step(), 0.0);
        for run in picture.runs() {
            let mut of_run = Floats::splat(0.0);
            let mut at = [Ints::splat(0); 3];
            for a in 0..3 {
                at[a] = Ints::splat(run.first[a]) + Ints::load(picture.lanes(a));
            }
            for _ in 0..run.samples {
                let (mut corner, mut fraction) = (at, [of_run; 3]);
                for a in 0..3 {
                    corner[a] = at[a].shifted_right(BITS);
                    let scale = Floats::splat(1.0 / (1 << BITS) as f32);
                    fraction[a] = Floats::from_ints(at[a].and((1 << BITS) - 1)) * scale;
                    at[a] = at[a] + Ints::splat(step[a]);
                }
                of_run = of_run + self.sample(corner, fraction);
            }
            sum += of_run.sum();
        }
        sum
    }
}

#[inline(always)]
fn trilinear([a, b, c, d]: [[Floats; 2]; 4], [u, v, w]: [Floats; 3]) -> Floats {
    let lower = a[0].lerp(a[1], u).lerp(b[0].lerp(b[1], u), v);
    lower.lerp(c[0].lerp(c[1], u).lerp(d[0].lerp(d[1], u), v), w)
}

/// Differences across the lines of a cell, interpolated.
#[inline(always)]
fn across(low: [[Floats; 2]; 4], high: [[Floats; 2]; 4], at: [Floats; 3]) -> Floats {
    let mut differences = low;
    for n in 0..4 {
        differences[n] = [high[n][0] - low[n][0], high[n][1] - low[n][1]];
    }
    trilinear(differences, at)
}
