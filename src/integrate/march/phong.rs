//! Shading as VTK's GPU mapper does it, for `march: { reflection: vtk-phong }`.
//!
//! Where it departs from [`Shading`]: the highlight is Phong's, `(r·v)^shininess` with the mirrored light `r`; there is no
//! fade where the gradient vanishes; a colour brighter than 1 is cut off; and the gradient is a difference of values
//! `n/(n − 1)` voxels before and after the sample along an axis of `n` voxels, clamped at the border, where central
//! differences at the voxels are one voxel apart and one-sided. The one sample of a ray that is shorter than a step lies behind
//! the volume. Its value is that of the border, and its differences are taken around the place beyond, each end of them
//! clamped by itself, so that they reach less far into the volume (`tests/vtk/rays.py` follows such rays).
//!
//! Unless a headlight is the only light, VTK takes another path. There a headlight shines along the camera's axis; ambient
//! light is left out (it is added without the colour of what it falls on, from lights that have none by default); on a
//! side turned away from the light the highlight is mirrored at the wrong side; and the normal is turned into the
//! camera's frame by a matrix whose factors are in the wrong order and transposed, see [`misplaced`].

use glam::{DMat3, DVec3, Mat3, Vec3};

use crate::classify::Rgbs;
use crate::field::{Cell, Position, Spacing, Trilinear, Voxel};
use crate::integrate::shade::{Course, Shader, Spot};
use crate::scene::{Camera, Light, Shading};
use crate::volume::Grid;

/// VTK's shading.
pub(in super::super) struct VtkPhong<'a> {
    definition: &'a Shading,
    /// What a headlight shines along if it is not the only light.
    forward: DVec3,
    /// A headlight and nothing else.
    headlight_alone: bool,
    /// What is done to a gradient in HU/mm before it is a normal.
    to_normal: Mat3,
    /// Distance of the two values of a difference from the sample, voxels.
    reach: [f64; 3],
    ambient: f32,
    shininess: f32,
    /// The brightest straight colour.
    brightest: f32,
}

/// What is constant along one ray.
#[derive(Default)]
pub(in super::super) struct Aim {
    beams: Vec<Beam>,
    /// From where the ray's only sample is held to where it is; see [`Course`].
    beyond_voxels: [f64; 3],
}

/// A light as seen along one ray.
struct Beam {
    towards: [f32; 3],
    to_eye: [f32; 3],
    /// `l·v`.
    between: f32,
    diffuse: [f32; 3],
    specular: [f32; 3],
}

impl<'a> VtkPhong<'a> {
    /// Shading for a camera and a grid. VTK cuts bright colours off where the transfer function reads the value alone, and
    /// not with 2D transfer functions.
    pub(in super::super) fn new(definition: &'a Shading, camera: &Camera, grid: &Grid, reads_gradient: bool) -> Self {
        let headlight_alone = matches!(definition.lights[..], [Light::Headlight { .. }]);
        VtkPhong {
            definition,
            forward: camera.forward(),
            headlight_alone,
            to_normal: if headlight_alone { Mat3::IDENTITY } else { misplaced(camera, grid).as_mat3() },
            reach: grid.dims().map(|n| n as f64 / (n.max(2) - 1) as f64),
            ambient: if headlight_alone { definition.ambient as f32 } else { 0.0 },
            shininess: definition.shininess as f32,
            brightest: if reads_gradient { f32::INFINITY } else { 1.0 },
        }
    }
}

impl Shader for VtkPhong<'_> {
    const SHADES: bool = true;
    const NAME: &'static str = "vtk-phong";
    type Aim = Aim;

    fn aim(&self, course: &Course, aim: &mut Aim) {
        let to_eye = -course.direction;
        aim.beyond_voxels = course.beyond_voxels.to_array();
        aim.beams.clear();
        aim.beams.extend(self.definition.lights.iter().map(|light| {
            let (towards, color) = match *light {
                Light::Headlight { color } if self.headlight_alone => (to_eye, color),
                Light::Headlight { color } => (-self.forward, color),
                Light::Directional { towards, color } => (towards, color),
            };
            Beam {
                towards: towards.as_vec3().to_array(),
                to_eye: to_eye.as_vec3().to_array(),
                between: towards.dot(to_eye) as f32,
                diffuse: color.map(|c| (c * self.definition.diffuse) as f32),
                specular: color.map(|c| (c * self.definition.specular) as f32),
            }
        }));
    }

    #[inline(always)]
    fn gradient_per_index<V: Voxel, K: Spacing>(
        &self,
        aim: &Aim,
        field: &Trilinear<'_, V, K>,
        position: Position,
        _cell: &Cell,
    ) -> [f32; 3] {
        let dims = field.dims();
        let value = |axis: usize, voxels: f64| field.value(&field.cell(position.beside(axis, voxels, dims)));
        std::array::from_fn(|axis| {
            let (beyond, reach) = (aim.beyond_voxels[axis], self.reach[axis]);
            0.5 * (value(axis, beyond + reach) - value(axis, beyond - reach))
        })
    }

    #[inline(always)]
    fn shade(
        &self,
        aim: &Aim,
        [r, g, b, opacity]: Rgbs<f32>,
        _: &Spot,
        gradient: impl FnOnce() -> [f32; 3],
    ) -> Rgbs<f32> {
        let gradient_per_mm = (self.to_normal * Vec3::from_array(gradient())).to_array();
        let mut reflected = [self.ambient; 3];
        let mut highlight = [0.0; 3];
        let square = dot(gradient_per_mm, gradient_per_mm);
        if square > 0.0 {
            let toward_normal = -1.0 / square.sqrt();
            for beam in &aim.beams {
                let facing = dot(gradient_per_mm, beam.towards) * toward_normal;
                let lit = if self.definition.two_sided { facing.abs() } else { facing.max(0.0) };
                let to_eye = dot(gradient_per_mm, beam.to_eye) * toward_normal;
                // `lit` where the mirrored direction has `facing`: right only on the lit side of a surface.
                let mirrored = 2.0 * if self.headlight_alone { facing } else { lit } * to_eye - beam.between;
                let gloss = if lit > 0.0 { mirrored.clamp(0.0, 1.0).powf(self.shininess) } else { 0.0 };
                for c in 0..3 {
                    reflected[c] += beam.diffuse[c] * lit;
                    highlight[c] += beam.specular[c] * gloss;
                }
            }
        }
        let most = self.brightest * opacity;
        let shaded = |q: f32, c: usize| (q * reflected[c] + opacity * highlight[c]).min(most);
        [shaded(r, 0), shaded(g, 1), shaded(b, 2), opacity]
    }
}

/// The matrix that VTK 9.7 makes of a gradient where there are scene lights, seen from the patient.
///
/// With the rotation `R` into the camera's frame, the volume's rotation `V` and the lengths `S` of its sides, a gradient `g`
/// along the volume's axes belongs at `R V g`; VTK's shader computes `S Vᵀ R g`. The two agree for a cube along the
/// patient's axes only.
fn misplaced(camera: &Camera, grid: &Grid) -> DMat3 {
    let to_camera = DMat3::from_cols(camera.right(), camera.up(), -camera.forward()).transpose();
    let m = grid.index_to_lps_mm().matrix3;
    let mut axes = DMat3::from_cols(m.x_axis.normalize(), m.y_axis.normalize(), m.z_axis.normalize());
    if axes.determinant() < 0.0 {
        // Left-handed images are given to VTK with their slices reversed.
        axes.z_axis = -axes.z_axis;
    }
    let cells = DVec3::from_array(grid.dims().map(|n| (n - 1) as f64));
    let sides = DMat3::from_diagonal(cells * grid.spacing_mm());
    to_camera.transpose() * sides * axes.transpose() * to_camera * axes.transpose()
}

#[inline(always)]
fn dot([ax, ay, az]: [f32; 3], [bx, by, bz]: [f32; 3]) -> f32 {
    ax * bx + ay * by + az * bz
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Projection;

    fn shading(lights: Vec<Light>) -> Shading {
        Shading {
            ambient: 0.1,
            diffuse: 0.5,
            specular: 0.25,
            shininess: 8.0,
            two_sided: true,
            soft_gradient_per_mm: 0.0,
            lights,
        }
    }

    fn shaded(definition: &Shading, gradient: [f32; 3]) -> [f32; 4] {
        let grid = Grid::axis_aligned([5, 5, 5], DVec3::ONE).unwrap();
        let parallel = Projection::Parallel { height_mm: 1.0 };
        let camera = Camera::look_at(-9.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, parallel, [1, 1]).unwrap();
        let shader = VtkPhong::new(definition, &camera, &grid, false);
        let mut aim = Aim::default();
        shader.aim(&Course::inside(DVec3::Z), &mut aim);
        let spot = Spot { cell: Cell { corner: [0; 3], fraction: [0.0; 3] }, distance_mm: 0.0 };
        shader.shade(&aim, [0.5, 0.5, 0.5, 0.5], &spot, || gradient)
    }

    #[test]
    fn a_headlight_is_mirrored_by_twice_the_angle() {
        // The normal at 30 degrees to the ray: cosine √3/2, and cos 60° = 1/2 between the mirrored light and the eye.
        let definition = shading(vec![Light::Headlight { color: [1.0; 3] }]);
        let expected = 0.5 * (0.1 + 0.5 * 0.75_f32.sqrt()) + 0.5 * 0.25 * 0.5_f32.powi(8);
        for side in [1.0, -1.0] {
            let found = shaded(&definition, [0.5 * side, 0.0, 0.75_f32.sqrt() * side]);
            assert!((found[0] - expected).abs() < 1e-6, "side {side}: found {}, expected {expected}", found[0]);
        }
    }

    #[test]
    fn with_another_light_there_is_no_ambient_light() {
        let away = Light::Directional { towards: DVec3::X, color: [1.0; 3] };
        assert_eq!(shaded(&shading(vec![away]), [0.0, 0.0, 1.0])[0], 0.0, "across the light");
    }

    #[test]
    fn beyond_the_border_differences_reach_less_far_into_the_volume() {
        // x² + 10 y between voxels of 5 along an axis: differences are of values 1.25 voxels before and after.
        let definition = shading(vec![Light::Headlight { color: [1.0; 3] }]);
        let dims = [5, 5, 5];
        let voxels: Vec<f32> = (0..125).map(|v| ((v % 5) * (v % 5) + 10 * (v / 5 % 5)) as f32).collect();
        let grid = Grid::axis_aligned(dims, DVec3::ONE).unwrap();
        let parallel = Projection::Parallel { height_mm: 1.0 };
        let camera = Camera::look_at(-9.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, parallel, [1, 1]).unwrap();
        let shader = VtkPhong::new(&definition, &camera, &grid, false);
        let field = Trilinear::new(&voxels, dims).unwrap();
        // Places on x with y = 2 and z = 2, and what is at both ends of the difference.
        for (x, before, after) in [
            (2.0, 1.0 - 0.25, 9.0 + 0.25 * 7.0),
            (4.0, 4.0 + 0.75 * 5.0, 16.0),
            (4.5, 9.0 + 0.25 * 7.0, 16.0),
            (5.5, 16.0, 16.0),
            (-0.5, 0.0, 0.75),
            (-1.5, 0.0, 0.0),
        ] {
            let (place, held) = (DVec3::new(x, 2.0, 2.0), DVec3::new(x.clamp(0.0, 4.0), 2.0, 2.0));
            let mut aim = Aim::default();
            shader.aim(&Course { direction: DVec3::Z, beyond_voxels: place - held }, &mut aim);
            let position = Position::new(held, dims);
            let found = shader.gradient_per_index(&aim, &field, position, &position.even_cell());
            let expected = [0.5 * (after - before), 12.5, 0.0];
            let apart = (0..3).map(|a| (f64::from(found[a]) - expected[a]).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-5, "x = {x}: found {found:?}, expected {expected:?}");
        }
    }

    #[test]
    fn normals_are_right_for_a_cube_along_the_axes_and_not_for_a_slab() {
        let camera = Camera::look_at(
            DVec3::new(9.0, -20.0, 4.0),
            DVec3::ZERO,
            DVec3::Z,
            Projection::Perspective { fov_degrees: 30.0 },
            [1, 1],
        )
        .unwrap();
        let gradient = DVec3::new(0.6, -0.3, 0.2).normalize();
        let off = |dims, spacing| {
            let grid = Grid::axis_aligned(dims, spacing).unwrap();
            (misplaced(&camera, &grid) * gradient).normalize().angle_between(gradient).to_degrees()
        };
        assert!(off([9, 5, 17], DVec3::new(1.0, 2.0, 0.5)) < 1e-6, "a cube of 8 mm");
        assert!(
            off([9, 9, 17], DVec3::ONE) > 5.0,
            "a box twice as high is wrong by {} degrees",
            off([9, 9, 17], DVec3::ONE)
        );
    }

    #[test]
    fn what_is_brighter_than_white_is_cut_off() {
        let definition = shading(vec![Light::Headlight { color: [9.0; 3] }]);
        assert_eq!(shaded(&definition, [0.0, 0.0, 1.0]), [0.5; 4]);
    }
}
