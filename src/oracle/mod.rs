//! The truth in f64: slow, adaptive, and sharing nothing with the integrators but definitions.
//!
//! Inside a cell the value, the gradient magnitude and each component of the gradient are exactly cubics of the ray's
//! parameter, and between its knots the transfer function is bilinear. So each ray is cut at every face of the lattice,
//! at every critical point of its cubics and at every knot of the transfer function they cross, and what is left is
//! smooth:
//!
//! - **Method A**, without shading. On each piece σ and q are polynomials (degree 3, or 6 where the transfer function
//!   reads the gradient), so the optical depth is exact; the rest is 16-node Gauss-Legendre quadrature on panels so
//!   shallow that it is exact to rounding.
//! - **Method B**, for anything that can be evaluated. Adaptive Gauss collocation (5 nodes, order 10), each step held
//!   against its halves, with further cuts where shading or fog is bent, and with steps as short as the normal turns
//!   quickly. Stretches in which only haze is have a closed form.
//!
//! Where σ and q are given at the lattice points (RGBA volumes, classification there) they are cubics themselves, and
//! both methods apply without any further cut.
//!
//! Sums are compensated; both methods stop only where the optical depth exceeds 60. The two agree to 1e-12 and better,
//! and both with high-precision values computed independently (`tests/oracle`). The idea of integrating cell by cell to
//! machine precision is that of Novins and Arvo (1992).

mod bernstein;
mod cell;
mod collocation;
mod depth;
mod fields;
mod light;
mod lit_passage;
mod lit_piece;
mod masked;
mod models;
mod occlusion;
mod panel;
mod patches;
mod path;
mod quadrature;
mod roots;
mod shaded;
mod splits;
mod voxels;

use glam::DVec3;
use rayon::prelude::*;

pub use light::Segment;

use crate::scene::{Background, Haze, Model, Ray, Scene};
use crate::volume::Volume;
use collocation::{Collocation, Stretch};
use fields::Fields;
use light::Light;
use lit_passage::LitPassage;
use lit_piece::LitPiece;
use masked::Functions;
use occlusion::{Lights, Occlusion};
use panel::{Panel, PanelRule};
use patches::Patches;
use path::{Passage, Path};
use shaded::ShadedRay;
use splits::Splits;

/// The volume rendering integral of a scene, to rounding.
#[derive(Debug, Clone)]
pub struct Oracle<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    functions: Functions<'a>,
    cubic: PanelRule<4>,
    sextic: PanelRule<7>,
    collocation: Collocation,
    occlusion: Occlusion,
}

/// Agreement of a step with its halves where transmittances are traced from each point: they are bent wherever the light's
/// ray passes a face of the lattice or a knot.
const TRACED_AGREEMENT: f64 = 1e-7;

impl<'a> Oracle<'a> {
    /// The truth about `scene` in `volume`.
    pub fn new(volume: &'a Volume, scene: &'a Scene) -> Self {
        Oracle {
            volume,
            scene,
            functions: Functions::new(volume, scene),
            cubic: PanelRule::new(),
            sextic: PanelRule::new(),
            collocation: Collocation::new(),
            occlusion: Occlusion::Interpolated(Lights::new(scene.occluded_directions())),
        }
    }

    /// The same with the transmittance towards lights traced from every point, to about 1e-6, in place of its definition
    /// by interpolation between lattice points: what the model of shadows and scattering costs is the difference. Slow.
    #[must_use]
    pub fn with_traced_light(self) -> Self {
        Oracle { occlusion: Occlusion::Traced, collocation: Collocation::within(TRACED_AGREEMENT), ..self }
    }

    /// What the ray sees of the volume, without the background: premultiplied linear RGBA.
    pub fn radiance(&self, ray: &Ray) -> [f64; 4] {
        match &self.scene.model {
            Model::Light => self.segment(ray, 0.0, f64::INFINITY).rgba(),
            Model::Value(model) => models::number(self, model, ray).map_or([0.0; 4], |v| {
                let light = model.light(v);
                [light, light, light, 1.0]
            }),
            Model::Surfaces(surfaces) => models::surfaces(self, surfaces, ray),
        }
    }

    /// The pixel at a column and row from the top left, with the background: premultiplied linear RGBA.
    pub fn pixel(&self, column: usize, row: usize) -> [f64; 4] {
        let ray = self.scene.camera.pixel_ray(column, row);
        let [r, g, b, alpha] = self.radiance(&ray);
        match self.scene.background {
            Background::Transparent => [r, g, b, alpha],
            Background::Color([br, bg, bb]) => {
                let t = 1.0 - alpha;
                [r + t * br, g + t * bg, b + t * bb, 1.0]
            }
        }
    }

    /// All pixels, row by row from the top left, on all threads. `progress` is told, from any thread, of each finished
    /// row the number of its pixels.
    pub fn render(&self, progress: impl Fn(usize) + Sync) -> Vec<[f64; 4]> {
        let [width, height] = self.scene.camera.size();
        let mut pixels = vec![[0.0; 4]; width * height];
        pixels.par_chunks_mut(width).enumerate().for_each(|(row, line)| {
            for (column, pixel) in line.iter_mut().enumerate() {
                *pixel = self.pixel(column, row);
            }
            progress(width);
        });
        pixels
    }

    /// The part of the ray between two distances from its origin, mm; by method A, or B if the scene is shaded or has
    /// effects of light.
    pub fn segment(&self, ray: &Ray, from_mm: f64, to_mm: f64) -> Segment {
        let effects = &self.scene.effects;
        let lit = effects.fog.is_some() || effects.haze.is_some() || effects.scattering.is_some();
        if voxels::are_given(self.volume, self.scene) {
            self.walk_voxels(ray, from_mm, to_mm, |panel, light| self.cubic.integrate(panel, light))
        } else if self.scene.shading.is_some() || lit {
            self.segment_by_collocation(ray, from_mm, to_mm)
        } else {
            self.by_panels(self.path(ray, from_mm, to_mm))
        }
    }

    /// T of the volume along a ray, clipped and without haze.
    fn transmittance_of(&self, ray: &Ray) -> f64 {
        self.by_panels(self.path(ray, 0.0, f64::INFINITY)).transmittance()
    }

    /// The same from a lattice point.
    fn transmittance_from(&self, voxel: [usize; 3], direction: DVec3) -> f64 {
        let (grid, origin_mm) = (self.volume.grid(), self.volume.voxel_mm(voxel));
        let shown = self.scene.effects.clip.interval_mm(&Ray { origin_mm, direction });
        let mut index = DVec3::from_array(voxel.map(|i| i as f64));
        if let Some(slices) = self.volume.slices() {
            index.z = slices.positions()[voxel[2]];
        }
        let path = shown.and_then(|shown| Path::from_index(grid, index, direction, shown));
        self.by_panels(path.map(|path| path.through(self.volume.slices()))).transmittance()
    }

    /// The same as [`Oracle::segment`] by method B whatever the scene: to hold one method against the other.
    pub fn segment_by_collocation(&self, ray: &Ray, from_mm: f64, to_mm: f64) -> Segment {
        if voxels::are_given(self.volume, self.scene) {
            return self.walk_voxels(ray, from_mm, to_mm, |panel, light| {
                let stretch = Stretch { from: 0.0, width: 1.0, length_mm: panel.length_mm };
                self.collocation.integrate(panel, stretch, light);
            });
        }
        let haze = self.scene.effects.haze.as_ref();
        let shaded = self.scene.shading.as_ref().map(|shading| ShadedRay::new(shading, ray.direction));
        let mut light = Light::default();
        let mut here_mm = from_mm.max(0.0);
        let path = self.path(ray, from_mm, to_mm);
        self.walk(path, self.scene.shading.is_some(), &mut light, |passage, seen, splits, light| {
            add_haze(haze, passage.from_mm - here_mm, light);
            here_mm = passage.from_mm + passage.length_mm;
            let Some((fields, patches)) = seen else { return add_haze(haze, passage.length_mm, light) };
            let lit = LitPassage::new(self, ray, shaded.as_ref(), passage);
            fields.add_knots(patches, splits);
            lit.add_bends(splits);
            if let (Some(shaded), Some(gradient)) = (&shaded, &fields.gradient) {
                shaded.add_bends(gradient, splits);
            }
            for [from, to] in splits.pieces() {
                let length_mm = (to - from) * passage.length_mm;
                let Some(piece) = fields.piece(patches, [from, to]) else {
                    add_haze(haze, length_mm, light);
                    continue;
                };
                let integrand = LitPiece { fields, patches, piece, passage: &lit };
                self.collocation.integrate(&integrand, Stretch { from, width: to - from, length_mm }, light);
            }
        });
        let end_mm = haze.map_or(here_mm, |haze| haze.end_mm.min(to_mm));
        add_haze(haze, end_mm - here_mm, &mut light);
        light.segment()
    }

    fn by_panels(&self, path: Option<Path<'_>>) -> Segment {
        let mut light = Light::default();
        self.walk(path, false, &mut light, |passage, seen, splits, light| {
            let Some((fields, patches)) = seen else { return };
            fields.add_knots(patches, splits);
            for ends in splits.pieces() {
                let Some(piece) = fields.piece(patches, ends) else { continue };
                let length_mm = (piece.to - piece.from) * passage.length_mm;
                match fields.sextic_panel(patches, &piece, length_mm) {
                    Some(panel) => self.sextic.integrate(&panel, light),
                    None => self.cubic.integrate(&fields.cubic_panel(patches, &piece, length_mm), light),
                }
            }
        });
        light.segment()
    }

    /// Gathers light cell by cell where σ and q are given at the lattice points.
    fn walk_voxels(&self, ray: &Ray, from_mm: f64, to_mm: f64, gather: impl Fn(&Panel<4>, &mut Light)) -> Segment {
        let mut light = Light::default();
        let path = self.path(ray, from_mm, to_mm);
        for passage in path.iter().flat_map(Path::passages) {
            gather(&voxels::panel(self.volume, self.scene, &passage), &mut light);
            if light.is_opaque() {
                break;
            }
        }
        light.segment()
    }

    /// The part of the ray between two distances from its origin, mm, that is in the domain and not clipped away.
    fn path(&self, ray: &Ray, from_mm: f64, to_mm: f64) -> Option<Path<'a>> {
        let [first_mm, last_mm] = self.scene.effects.clip.interval_mm(ray)?;
        let path = Path::new(self.volume.grid(), ray, from_mm.max(first_mm), to_mm.min(last_mm))?;
        Some(path.through(self.volume.slices()))
    }

    /// Gathers light cell by cell, from the eye on; `gather` is given each passage with the fields along it and the transfer
    /// function there, or `None` where that shows nothing.
    fn walk(
        &self,
        path: Option<Path<'_>>,
        shaded: bool,
        light: &mut Light,
        mut gather: impl FnMut(&Passage, Option<(&Fields, &Patches)>, &mut Splits, &mut Light),
    ) {
        let mut splits = Splits::default();
        for passage in path.iter().flat_map(Path::passages) {
            for (passage, patches) in self.functions.along(passage) {
                splits.restart();
                let fields = patches.and_then(|p| Some((Fields::new(self.volume, p, shaded, &passage)?, p)));
                gather(&passage, fields.as_ref().map(|(fields, patches)| (fields, *patches)), &mut splits, light);
            }
            if light.is_opaque() {
                break;
            }
        }
    }
}

/// Adds a stretch in which haze is alone. Its length may be below 0 by rounding.
fn add_haze(haze: Option<&Haze>, length_mm: f64, light: &mut Light) {
    if let Some(haze) = haze {
        light.add(&Segment::of_haze(haze, length_mm.max(0.0)));
    }
}
