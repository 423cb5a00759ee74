//! Connected parts: voxels of one class that are joined through faces.
//!
//! Rows are cut into runs of one class, and runs that touch are united (union-find over runs, He, Chao and Suzuki 2008), so
//! memory goes with the number of runs and not of voxels: 24 bytes for each.

/// Through which faces voxels are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Joined {
    /// All six.
    InVolume,
    /// Those four within a slice of constant k.
    InSlices,
}

/// Voxels of one class in a row.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// Linear index of its first voxel.
    first: usize,
    /// A run of the same part that comes before it, itself for the part's root; in the end, the number of its part.
    parent: usize,
    /// Number of voxels; a row has fewer than 2³² of them.
    voxels: u32,
    class: u8,
}

impl Run {
    /// One after its last voxel.
    fn end(&self) -> usize {
        self.first + self.voxels as usize
    }
}

/// A connected part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Part {
    /// The class of its voxels.
    pub(super) class: u8,
    /// Their number.
    pub(super) voxels: usize,
    /// True if one of them is on the border of the lattice, or of its slice if joined in slices.
    pub(super) on_border: bool,
}

/// The connected parts of all classes but 0.
pub(super) struct Parts {
    runs: Vec<Run>,
    parts: Vec<Part>,
}

impl Parts {
    /// Parts of the classes that `class` gives to linear indices.
    pub(super) fn new(dims: [usize; 3], joined: Joined, class: impl Fn(usize) -> u8) -> Self {
        let [nx, ny, nz] = dims;
        let mut runs: Vec<Run> = Vec::new();
        let mut first_of_row = Vec::with_capacity(ny * nz + 1);
        for row in 0..ny * nz {
            first_of_row.push(runs.len());
            cut(row, nx, &class, &mut runs);
            let mine = first_of_row[row]..runs.len();
            if row % ny > 0 {
                join(&mut runs, nx, first_of_row[row - 1]..first_of_row[row], mine.clone());
            }
            if row >= ny && joined == Joined::InVolume {
                join(&mut runs, nx * ny, first_of_row[row - ny]..first_of_row[row - ny + 1], mine);
            }
        }
        Self::gathered(dims, joined, runs)
    }

    fn gathered(dims: [usize; 3], joined: Joined, mut runs: Vec<Run>) -> Self {
        let [nx, ny, nz] = dims;
        let mut parts = Vec::new();
        for n in 0..runs.len() {
            let Run { first, parent, voxels, class } = runs[n];
            // A run's parent comes before it, and so holds the number of its part by now. The root of a part is its first run, so
            // that parts are in the order of their first voxels.
            let own = if parent == n { parts.len() } else { runs[parent].parent };
            if parent == n {
                parts.push(Part { class, voxels: 0, on_border: false });
            }
            runs[n].parent = own;
            let (i, row) = (first % nx, first / nx);
            let (j, k) = (row % ny, row / ny);
            let end_slice = joined == Joined::InVolume && (k == 0 || k == nz - 1);
            let part = &mut parts[own];
            part.voxels += voxels as usize;
            part.on_border |= i == 0 || i + voxels as usize == nx || j == 0 || j == ny - 1 || end_slice;
        }
        Parts { runs, parts }
    }

    /// The parts, in the order of their first voxels.
    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Calls `visit` with the linear indices of each run and the number of its part.
    pub(super) fn for_each_run(&self, mut visit: impl FnMut(std::ops::Range<usize>, usize)) {
        for run in &self.runs {
            visit(run.first..run.end(), run.parent);
        }
    }
}

/// Cuts a row into runs.
fn cut(row: usize, nx: usize, class: impl Fn(usize) -> u8, runs: &mut Vec<Run>) {
    let end_of_row = (row + 1) * nx;
    let mut first = row * nx;
    while first < end_of_row {
        let own = class(first);
        let end = (first + 1..end_of_row).find(|&index| class(index) != own).unwrap_or(end_of_row);
        if own != 0 {
            runs.push(Run { first, parent: runs.len(), voxels: (end - first) as u32, class: own });
        }
        first = end;
    }
}

/// Unites the runs of two rows that touch, the rows so many voxels apart.
fn join(runs: &mut [Run], apart: usize, mut before: std::ops::Range<usize>, mut after: std::ops::Range<usize>) {
    while let (Some(a), Some(b)) = (before.clone().next(), after.clone().next()) {
        let (one, other) = (runs[a], runs[b]);
        let (start, end) = (one.first + apart, one.end() + apart);
        if one.class == other.class && start < other.end() && other.first < end {
            let (a, b) = (root(runs, a), root(runs, b));
            runs[a.max(b)].parent = a.min(b);
        }
        if end <= other.end() {
            before.next();
        } else {
            after.next();
        }
    }
}

/// The root of a run's part, the path to it halved on the way.
fn root(runs: &mut [Run], mut n: usize) -> usize {
    while runs[n].parent != n {
        runs[n].parent = runs[runs[n].parent].parent;
        n = runs[n].parent;
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the definition: a flood through faces, voxel by voxel.
    fn flooded(dims: [usize; 3], joined: Joined, classes: &[u8]) -> Vec<Part> {
        let [nx, ny, nz] = dims;
        let mut seen = vec![false; classes.len()];
        let mut parts = Vec::new();
        for start in 0..classes.len() {
            if seen[start] || classes[start] == 0 {
                continue;
            }
            let mut part = Part { class: classes[start], voxels: 0, on_border: false };
            let mut open = vec![start];
            seen[start] = true;
            while let Some(index) = open.pop() {
                part.voxels += 1;
                let at = [index % nx, index / nx % ny, index / (nx * ny)];
                let axes = if joined == Joined::InVolume { 3 } else { 2 };
                for axis in 0..axes {
                    part.on_border |= at[axis] == 0 || at[axis] == dims[axis] - 1;
                    for step in [-1_isize, 1] {
                        let mut next = at;
                        let Some(n) = at[axis].checked_add_signed(step).filter(|n| *n < dims[axis]) else { continue };
                        next[axis] = n;
                        let neighbour = next[0] + nx * (next[1] + ny * next[2]);
                        if !seen[neighbour] && classes[neighbour] == part.class {
                            seen[neighbour] = true;
                            open.push(neighbour);
                        }
                    }
                }
            }
            parts.push(part);
        }
        assert_eq!(nx * ny * nz, classes.len());
        parts
    }

    #[test]
    fn they_are_those_of_a_flood_fill() {
        for (dims, seed) in [([9, 8, 7], 1_u64), ([1, 6, 5], 2), ([7, 1, 4], 3), ([16, 16, 1], 4), ([5, 5, 5], 5)] {
            for classes_in_all in [2, 3] {
                let mut state = seed;
                let mut next = || {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    ((state >> 33) % classes_in_all) as u8
                };
                let classes: Vec<u8> = (0..dims.iter().product()).map(|_| next()).collect();
                for joined in [Joined::InVolume, Joined::InSlices] {
                    let found = Parts::new(dims, joined, |index| classes[index]);
                    let expected = flooded(dims, joined, &classes);
                    assert_eq!(found.parts(), expected, "{dims:?}, {joined:?}, {classes_in_all} classes");
                    let mut voxels = vec![0; expected.len()];
                    found.for_each_run(|run, part| {
                        assert!(run.clone().all(|index| classes[index] == expected[part].class), "a run has one class");
                        voxels[part] += run.len();
                    });
                    assert!(voxels.iter().zip(&expected).all(|(v, part)| *v == part.voxels), "runs cover the parts");
                }
            }
        }
    }
}
