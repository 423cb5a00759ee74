//! The first local maximum along a ray, from the exact cubics in f64.

use crate::field::Voxel;
use crate::math::bernstein::{critical_points, range, value};

use super::cells::Segment;
use super::lattice::{Lattice, along};

/// What counts as a local maximum, in stored units; see [`crate::scene::ValueOf::LocalMaximum`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Peak {
    /// -1 where values fall as stored numbers rise, else 1.
    pub(super) sign: f64,
    pub(super) threshold: f64,
    /// The fall that ends a maximum, above 0.
    pub(super) fall: f64,
}

impl Peak {
    /// The stored value of the first local maximum, or of the overall one if there is none; `None` if the ray misses the
    /// volume.
    ///
    /// Between its ends and critical points a cubic is monotone, so the largest value so far and the deepest fall below it
    /// are decided at these points alone.
    pub(super) fn first<V: Voxel>(
        &self,
        lattice: &Lattice<'_, V>,
        segments: impl Iterator<Item = Segment>,
    ) -> Option<f64> {
        let threshold = self.sign * self.threshold;
        let mut most = f64::NEG_INFINITY;
        for segment in segments {
            let corners = lattice.corners::<f64>(segment.cell).map(|v| self.sign * v);
            // Below the threshold only what is larger than all before matters; above it every fall does.
            if most < threshold && range(&corners)[1] <= most {
                continue;
            }
            let cubic = along(&corners, &segment);
            let (critical, count) = critical_points(&cubic);
            let inner = critical.into_iter().take(count).map(|u| value(&cubic, u));
            for v in [cubic[0]].into_iter().chain(inner).chain([cubic[3]]) {
                most = most.max(v);
                if most >= threshold && v < most - self.fall {
                    return Some(self.sign * most);
                }
            }
        }
        most.is_finite().then_some(self.sign * most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::exact::cells::Domain;
    use crate::scene::{Clip, Ray};
    use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};
    use glam::DVec3;

    /// The first maximum along x of a volume that is constant across it, from either side.
    fn first(line: &[i16], threshold: f64, backwards: bool) -> f64 {
        let n = line.len();
        let samples = (0..n * 4).map(|i| line[i % n]).collect();
        let grid = Grid::axis_aligned([n, 2, 2], DVec3::ONE).unwrap();
        let volume = Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap();
        let Samples::I16(samples) = volume.samples() else { unreachable!("made of 16-bit samples") };
        let (x, direction) = if backwards { (n as f64 + 3.0, -DVec3::X) } else { (-3.0, DVec3::X) };
        let ray = Ray { origin_mm: DVec3::new(x, 0.37, 0.81), direction };
        let peak = Peak { sign: 1.0, threshold, fall: 1e-9 };
        let clip = Clip::default();
        let domain = Domain::of(&volume, &clip);
        let inside = domain.inside(&ray).expect("the ray meets the volume");
        peak.first(&Lattice::new(&volume, samples), domain.segments(inside)).expect("of finite values")
    }

    #[test]
    fn definition_by_example() {
        for (line, threshold, forwards, backwards) in [
            (&[0, 100, 0, 300, 0][..], 50.0, 100.0, 300.0),
            (&[0, 100, 0, 300, 0], 100.0, 100.0, 300.0),
            (&[0, 100, 0, 300, 0], 101.0, 300.0, 300.0),
            // None reaches the threshold: the overall maximum.
            (&[0, 100, 0, 300, 0, 200, 0], 301.0, 300.0, 300.0),
            // A plateau that goes on rising is no maximum; one that falls is.
            (&[0, 100, 100, 300, 300, 0, 500], 50.0, 300.0, 500.0),
            // Outside everything is lower.
            (&[200, 100, 300, 0], 150.0, 200.0, 300.0),
            (&[200, 100, 300, 0], 250.0, 300.0, 300.0),
            // Rising to the end.
            (&[0, 100, 200, 900], 50.0, 900.0, 900.0),
            (&[70, 70, 70, 70], 50.0, 70.0, 70.0),
        ] {
            let found = [first(line, threshold, false), first(line, threshold, true)];
            let expected = [forwards, backwards];
            let apart = (0..2).map(|i| (found[i] - expected[i]).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-9, "{line:?} from {threshold}: found {found:?}, expected {expected:?}");
        }
    }
}
