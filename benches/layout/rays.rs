//! Pictures: which samples of which rays are taken.

use super::registers::{ASIDE, LANES};

/// Rays per side of the picture, a voxel apart, and of a tile.
const RAYS: usize = 512;
const TILE: usize = 16;
const STEP: f64 = 0.5;

/// Ellipsoids that just fit the volume, times these, are the surfaces; whoever is so near, in voxels, takes samples.
const SURFACES: [f64; 4] = [0.95, 0.85, 0.78, 0.4];
const NEAR: f64 = 4.0;

/// Positions are integers, in such parts of a voxel.
pub(crate) const BITS: i32 = 20;

/// Equal steps of all lanes: where the first one begins.
pub(crate) struct Run {
    pub(crate) first: [i32; 3],
    pub(crate) samples: i32,
}

pub(crate) struct Picture {
    dims: [usize; 3],
    runs: Vec<Run>,
    lanes: [[i32; LANES]; 3],
    step: [i32; 3],
}

impl Picture {
    /// Rays through the middle of a volume; of `every` so many rows of tiles one, whole.
    pub(crate) fn new(dims: [usize; 3], direction: [f64; 3], near: bool, every: usize) -> Self {
        let normalized = |v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt());
        let direction = normalized(direction);
        // Rows of the picture go along x, or along y where rays go along x.
        let aside = if direction[0] > 0.9 { 1 } else { 0 };
        let right = normalized([0, 1, 2].map(|a| f64::from(a == aside) - direction[aside] * direction[a]));
        let up = [0, 1, 2].map(|a| {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            direction[b] * right[c] - direction[c] * right[b]
        });
        let fixed = |x: f64| (x * f64::from(1 << BITS)).round() as i32;
        let place = |n: usize, a: usize| (n % ASIDE) as f64 * right[a] + (n / ASIDE) as f64 * up[a];
        let lanes = [0, 1, 2].map(|a| std::array::from_fn(|n| fixed(place(n, a))));
        let step = direction.map(|x| fixed(x * STEP));
        let mut picture = Picture { dims, runs: Vec::new(), lanes, step };
        let middle = RAYS as f64 / 2.0;
        for top in (0..RAYS).step_by(TILE).filter(|top| top / TILE % every == every / 2) {
            for left in (0..RAYS).step_by(TILE) {
                for y in (top..top + TILE).step_by(LANES / ASIDE) {
                    for x in (left..left + TILE).step_by(ASIDE) {
                        let (x, y) = (x as f64 - middle, y as f64 - middle);
                        picture.add([0, 1, 2].map(|a| dims[a] as f64 / 2.0 + x * right[a] + y * up[a]), near);
                    }
                }
            }
        }
        picture
    }

    /// Adds what the rays of a register meet, whose first one goes through this place.
    fn add(&mut self, through: [f64; 3], near: bool) {
        let unit = f64::from(1 << BITS);
        let (mut begin, mut end) = (f64::NEG_INFINITY, f64::INFINITY);
        for a in 0..3 {
            let lanes = self.lanes[a].map(|x| f64::from(x) / unit);
            let (least, most) = lanes.iter().fold((0.0, 0.0), |(l, m): (f64, f64), &x| (l.min(x), m.max(x)));
            let step = f64::from(self.step[a]) / unit;
            let to = |x: f64| (x - through[a]) / step;
            let (one, other) = (to(1.01 - least), to(self.dims[a] as f64 - 2.01 - most));
            (begin, end) = (begin.max(one.min(other)), end.min(one.max(other)));
        }
        let mut since = None;
        let mut n = begin.ceil();
        while n <= end + 1.0 {
            let place = |lane: usize, a: usize| {
                through[a] + n * f64::from(self.step[a]) / unit + f64::from(self.lanes[a][lane]) / unit
            };
            // The middle of the register speaks for all.
            let middle = [0, 1, 2].map(|a| (place(0, a) + place(LANES - 1, a)) / 2.0);
            let takes = n <= end && (!near || is_near(middle, self.dims));
            match since {
                None if takes => since = Some((n, [0, 1, 2].map(|a| (place(0, a) * unit).round() as i32))),
                Some((first, at)) if !takes => {
                    self.push(Run { first: at, samples: (n - first) as i32 });
                    since = None;
                }
                _ => {}
            }
            n += 1.0;
        }
    }

    /// Cells are not at the border: neither a lane's first nor its last one, so none between them.
    fn push(&mut self, run: Run) {
        for (a, lane) in (0..3).flat_map(|a| (0..LANES).map(move |lane| (a, lane))) {
            let first = run.first[a] + self.lanes[a][lane];
            let inside = |at: i32| at >> BITS >= 1 && at >> BITS <= self.dims[a] as i32 - 3;
            assert!(inside(first) && inside(first + (run.samples - 1) * self.step[a]));
        }
        self.runs.push(run);
    }

    pub(crate) fn dims(&self) -> [usize; 3] {
        self.dims
    }

    pub(crate) fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// From the first lane to each along an axis.
    pub(crate) fn lanes(&self, a: usize) -> &[i32; LANES] {
        &self.lanes[a]
    }

    /// From sample to sample.
    pub(crate) fn step(&self) -> [i32; 3] {
        self.step
    }

    pub(crate) fn samples(&self) -> f64 {
        self.runs.iter().map(|run| LANES as f64 * f64::from(run.samples)).sum()
    }
}

/// Whether a surface is near; its distance is estimated by the slope of the function that is constant on ellipsoids.
fn is_near(at: [f64; 3], dims: [usize; 3]) -> bool {
    let (mut square, mut slope) = (0.0, 0.0);
    for a in 0..3 {
        let radius = dims[a] as f64 / 2.0;
        let x = (at[a] - radius) / radius;
        square += x * x;
        slope += (x / radius) * (x / radius);
    }
    let (length, slope) = (f64::sqrt(square), f64::sqrt(slope));
    SURFACES.iter().any(|surface| (length - surface).abs() * length < NEAR * slope)
}
