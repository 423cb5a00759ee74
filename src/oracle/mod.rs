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
//!   against its halves, with further cuts where shading is bent, and with steps as short as the normal turns quickly.
//!
//! Sums are compensated; both methods stop only where the optical depth exceeds 60. The two agree to 1e-12 and better,
//! and both with high-precision values computed independently (`tests/oracle`). The idea of integrating cell by cell to
//! machine precision is that of Novins and Arvo (1992).

mod bernstein;
mod cell;
mod collocation;
mod fields;
mod light;
mod lit_piece;
mod models;
mod panel;
mod patches;
mod path;
mod quadrature;
mod roots;
mod shaded;
mod splits;

use rayon::prelude::*;

pub use light::Segment;

use crate::scene::{Background, Model, Ray, Scene};
use crate::volume::Volume;
use collocation::{Collocation, Stretch};
use fields::Fields;
use light::Light;
use lit_piece::LitPiece;
use panel::PanelRule;
use patches::Patches;
use path::Path;
use shaded::ShadedRay;
use splits::Splits;

/// The volume rendering integral of a scene, to rounding.
#[derive(Debug, Clone)]
pub struct Oracle<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    patches: Patches,
    cubic: PanelRule<4>,
    sextic: PanelRule<7>,
    collocation: Collocation,
}

impl<'a> Oracle<'a> {
    /// The truth about `scene` in `volume`.
    pub fn new(volume: &'a Volume, scene: &'a Scene) -> Self {
        Oracle {
            volume,
            scene,
            patches: Patches::new(&scene.transfer_function),
            cubic: PanelRule::new(),
            sextic: PanelRule::new(),
            collocation: Collocation::new(),
        }
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

    /// The part of the ray between two distances from its origin, mm; by method A, or B if the scene is shaded.
    pub fn segment(&self, ray: &Ray, from_mm: f64, to_mm: f64) -> Segment {
        match self.scene.shading {
            None => self.by_panels(ray, from_mm, to_mm),
            Some(_) => self.segment_by_collocation(ray, from_mm, to_mm),
        }
    }

    /// The same as [`Oracle::segment`] by method B whatever the scene: to hold one method against the other.
    pub fn segment_by_collocation(&self, ray: &Ray, from_mm: f64, to_mm: f64) -> Segment {
        let shaded = self.scene.shading.as_ref().map(|shading| ShadedRay::new(shading, ray.direction));
        self.walk(ray, from_mm, to_mm, |fields, length_mm, splits, light| {
            fields.add_knots(&self.patches, splits);
            if let (Some(shaded), Some(gradient)) = (&shaded, &fields.gradient) {
                shaded.add_bends(gradient, splits);
            }
            for ends in splits.pieces() {
                let Some(piece) = fields.piece(&self.patches, ends) else { continue };
                let lit = LitPiece { fields, patches: &self.patches, piece, shaded: shaded.as_ref() };
                let width = piece.to - piece.from;
                let stretch = Stretch { from: piece.from, width, length_mm: width * length_mm };
                self.collocation.integrate(&lit, stretch, light);
            }
        })
    }

    fn by_panels(&self, ray: &Ray, from_mm: f64, to_mm: f64) -> Segment {
        self.walk(ray, from_mm, to_mm, |fields, length_mm, splits, light| {
            fields.add_knots(&self.patches, splits);
            for ends in splits.pieces() {
                let Some(piece) = fields.piece(&self.patches, ends) else { continue };
                let length_mm = (piece.to - piece.from) * length_mm;
                match fields.sextic_panel(&self.patches, &piece, length_mm) {
                    Some(panel) => self.sextic.integrate(&panel, light),
                    None => self.cubic.integrate(&fields.cubic_panel(&self.patches, &piece, length_mm), light),
                }
            }
        })
    }

    /// Gathers light cell by cell, from the eye on; `gather` is given the fields along a passage and its length in mm.
    fn walk(
        &self,
        ray: &Ray,
        from_mm: f64,
        to_mm: f64,
        gather: impl Fn(&Fields, f64, &mut Splits, &mut Light),
    ) -> Segment {
        let mut light = Light::default();
        let mut splits = Splits::default();
        let path = Path::new(self.volume.grid(), ray, from_mm, to_mm);
        let path = path.map(|path| path.through(self.volume.slices()));
        for passage in path.iter().flat_map(Path::passages) {
            let shaded = self.scene.shading.is_some();
            if let Some(fields) = Fields::new(self.volume, &self.patches, shaded, &passage) {
                splits.restart();
                gather(&fields, passage.length_mm, &mut splits, &mut light);
            }
            if light.is_opaque() {
                break;
            }
        }
        light.segment()
    }
}
