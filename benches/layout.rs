//! How samples should lie in memory: in lines, or in bricks.
//!
//! `cargo bench --bench layout`. Rays in tiles of 16 x 16, neighbours together as in the kernels, take a sample every half voxel, each
//! interpolated between eight voxels, and with a gradient by central differences from 32. Of a volume in lines neighbours along x are
//! read together, and a place in memory is a sum of products; of one in bricks each voxel is read by itself, at a sum of three looked-up
//! terms. One thread; the layouts take turns, medians of the ratios of each turn. What is read is the same: it is checked.
#![allow(missing_docs, reason = "a program")]
#![allow(clippy::print_stdout, reason = "the table that it is for")]

use std::time::Instant;

/// Rays per side of the picture, and of a tile.
const RAYS: usize = 96;
const TILE: usize = 16;
const NEIGHBOURS: usize = 4;
const TURNS: usize = 3;
const STEP: f32 = 0.5;

/// Edge of a brick, voxels, as a power of two; 0 for lines.
const LAYOUTS: [(&str, u32); 3] = [("lines", 0), ("bricks of 4³", 2), ("bricks of 8³", 3)];

/// 73 MB, and the largest that is measured elsewhere.
const VOLUMES: [[usize; 3]; 2] = [[512, 512, 140], [512, 512, 512]];

/// Directions of rays, in voxels: along the axes, and across all.
const VIEWS: [(&str, [f32; 3]); 4] = [
    ("along x", [1.0, 0.02, 0.03]),
    ("along y", [0.03, 1.0, 0.02]),
    ("along z", [0.02, 0.03, 1.0]),
    ("oblique", [0.62, 0.55, 0.56]),
];

/// Samples, and by axis where in memory each index lies.
struct Laid {
    samples: Vec<i16>,
    terms: [Vec<u32>; 3],
}

impl Laid {
    fn new(dims: [usize; 3], log2: u32) -> Self {
        let edge = 1usize << log2;
        let bricks = dims.map(|n| n.div_ceil(edge));
        let of_brick = edge * edge * edge;
        let strides = [of_brick, of_brick * bricks[0], of_brick * bricks[0] * bricks[1]];
        let inner = [1, edge, edge * edge];
        let term = |a: usize, i: usize| ((i >> log2) * strides[a] + (i & (edge - 1)) * inner[a]) as u32;
        let terms = [0, 1, 2].map(|a| (0..dims[a]).map(|i| term(a, i)).collect::<Vec<u32>>());
        let mut samples = vec![0; of_brick * bricks.iter().product::<usize>()];
        for k in 0..dims[2] {
            for j in 0..dims[1] {
                for i in 0..dims[0] {
                    let value = (i * 7 + j * 13 + k * 29) % 2048;
                    samples[(terms[0][i] + terms[1][j] + terms[2][k]) as usize] = value as i16;
                }
            }
        }
        Laid { samples, terms }
    }

    /// The voxels that a value needs, or a gradient as well: those of the cell and, beyond its faces, their neighbours; `[k][j][i]`, the
    /// cell's lower corner being number 1 along each axis.
    #[inline(always)]
    fn around<const IN_LINES: bool, const LIT: bool>(&self, [i, j, k]: [usize; 3], dims: [usize; 3]) -> Around {
        let mut around = [[[0.0; 4]; 4]; 4];
        for (z, plane) in around.iter_mut().enumerate() {
            for (y, line) in plane.iter_mut().enumerate() {
                let (is_inner, is_corner) = ((1..3).contains(&y) && (1..3).contains(&z), y % 3 == 0 && z % 3 == 0);
                if is_corner || (!is_inner && !LIT) {
                    continue;
                }
                // A line through the cell is read from one voxel before it to one behind it; others are as long as the cell.
                let span = if is_inner && LIT { 0..4 } else { 1..3 };
                if IN_LINES {
                    let first = i + dims[0] * ((j + y - 1) + dims[1] * (k + z - 1));
                    let read = &self.samples[first + span.start - 1..first + span.end - 1];
                    for (to, &sample) in line[span].iter_mut().zip(read) {
                        *to = f32::from(sample);
                    }
                } else {
                    let [by_x, by_y, by_z] = &self.terms;
                    let start = by_y[j + y - 1] + by_z[k + z - 1];
                    for x in span {
                        line[x] = f32::from(self.samples[(by_x[i + x - 1] + start) as usize]);
                    }
                }
            }
        }
        around
    }
}

/// Voxels around a cell, `[k][j][i]`.
type Around = [[[f32; 4]; 4]; 4];

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + t * (b - a)
}

/// What is interpolated in the cell that begins so many voxels further on.
#[inline(always)]
fn value(around: &Around, [i, j, k]: [usize; 3], [x, y, z]: [f32; 3]) -> f32 {
    let edge = |j: usize, k: usize| mix(around[k][j][i], around[k][j][i + 1], x);
    mix(mix(edge(j, k), edge(j + 1, k), y), mix(edge(j, k + 1), edge(j + 1, k + 1), y), z)
}

/// The sum of all samples of a view, and how many there are.
fn rendered<const IN_LINES: bool, const LIT: bool>(laid: &Laid, dims: [usize; 3], direction: [f32; 3]) -> (f64, u64) {
    let along = (0..3).max_by(|&a, &b| direction[a].total_cmp(&direction[b])).unwrap_or(0);
    let (u, v) = ((along + 1) % 3, (along + 2) % 3);
    let (mut sum, mut count) = (0.0, 0);
    let blocks = |n: usize, of: usize| (0..n).step_by(of);
    for top in blocks(RAYS, TILE) {
        for left in blocks(RAYS, TILE) {
            for (dy, dx) in blocks(TILE, NEIGHBOURS).flat_map(|y| blocks(TILE, NEIGHBOURS).map(move |x| (y, x))) {
                // A block of rays goes on together, as lanes do.
                let mut at = [[0.0; 3]; NEIGHBOURS * NEIGHBOURS];
                for (n, at) in at.iter_mut().enumerate() {
                    let place = |from: usize, n: usize| (from + n) as f32 / RAYS as f32;
                    at[u] = 1.0 + place(left + dx, n % NEIGHBOURS) * (dims[u] - 4) as f32;
                    at[v] = 1.0 + place(top + dy, n / NEIGHBOURS) * (dims[v] - 4) as f32;
                    at[along] = 1.0;
                }
                let steps = ((dims[along] - 4) as f32 / (STEP * direction[along])) as usize;
                for _ in 0..steps {
                    for at in &mut at {
                        if (0..3).all(|a| at[a] < (dims[a] - 2) as f32) {
                            let cell = [at[0] as usize, at[1] as usize, at[2] as usize];
                            let fraction = [0, 1, 2].map(|a| at[a] - cell[a] as f32);
                            let around = laid.around::<IN_LINES, LIT>(cell, dims);
                            let mut sample = value(&around, [1; 3], fraction);
                            if LIT {
                                let difference = |high: [usize; 3], low: [usize; 3]| {
                                    value(&around, high, fraction) - value(&around, low, fraction)
                                };
                                let [x, y, z] = [
                                    difference([2, 1, 1], [0, 1, 1]),
                                    difference([1, 2, 1], [1, 0, 1]),
                                    difference([1, 1, 2], [1, 1, 0]),
                                ];
                                sample += (x * x + y * y + z * z).sqrt();
                            }
                            sum += f64::from(sample);
                            count += 1;
                        }
                        for a in 0..3 {
                            at[a] += STEP * direction[a];
                        }
                    }
                }
            }
        }
    }
    (sum, count)
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Times of all layouts in turns, as a row of the table.
fn row<const LIT: bool>(volumes: &[Laid; LAYOUTS.len()], dims: [usize; 3], (view, direction): (&str, [f32; 3])) {
    let mut times = [const { Vec::new() }; LAYOUTS.len()];
    let mut sums = [0.0; LAYOUTS.len()];
    for _ in 0..TURNS {
        for (n, laid) in volumes.iter().enumerate() {
            let start = Instant::now();
            let in_lines = LAYOUTS[n].1 == 0;
            let (sum, count) = if in_lines {
                rendered::<true, LIT>(laid, dims, direction)
            } else {
                rendered::<false, LIT>(laid, dims, direction)
            };
            times[n].push(start.elapsed().as_secs_f64() * 1e9 / count as f64);
            sums[n] = sum;
        }
    }
    assert!(sums.iter().all(|&sum| sum == sums[0]), "another layout, other samples: {sums:?}");
    let cell = |n: usize| {
        let ratios = times[n].iter().zip(&times[0]).map(|(t, lines)| t / lines).collect();
        format!("{:.1} ({:.2} of lines)", median(times[n].clone()), median(ratios))
    };
    let ([nx, ny, nz], what) = (dims, if LIT { "value and gradient" } else { "value" });
    println!("| {nx} x {ny} x {nz} | {view} | {what} | {} | {} | {} |", cell(0), cell(1), cell(2));
}

fn main() {
    println!("| volume | view | read | {} |", LAYOUTS.map(|(name, _)| format!("{name}, ns per sample")).join(" | "));
    println!("| --- | --- | --- | --: | --: | --: |");
    for dims in VOLUMES {
        let volumes = LAYOUTS.map(|(_, log2)| Laid::new(dims, log2));
        for view in VIEWS {
            row::<false>(&volumes, dims, view);
            row::<true>(&volumes, dims, view);
        }
    }
}
