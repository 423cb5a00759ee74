//! What VTK is asked to show along a ray: its blend mode, and the table that goes with it.
//!
//! | scene | blend mode | table | of VTK's picture |
//! |---|---|---|---|
//! | light | composite | colour and extinction | the picture |
//! | `maximum`, `minimum` | maximum, minimum intensity | the window's grey, opaque | the picture |
//! | `mean` | average intensity | opaque | its grey is the mean as a share of the volume's range |
//! | `sum` | additive, of the volume and of its mirror | a constant opacity | see below |
//! | surfaces | isosurface | each level's colour and opacity | the picture |
//!
//! VTK averages opacity times value, so the opacity is 1; the average has neither window nor colour, and the script applies
//! the window. It adds up opacity times value times step, the value as a share `u` of the range `[low, high]`, and cuts the
//! sum off at 1: so the opacity is one over the longest ray. For `∫ v ds` the length of the ray is needed, too: a second
//! picture, of the volume turned upside down, sums `1 − u`, and `∫ v ds = high Σ u + low Σ (1 − u)`.

use serde_json::{Value, json};

use crate::classify::Tabulated;
use crate::error::{Error, Fault, Result};
use crate::plan::Table;
use crate::scene::{Model, Scene, Surface, ValueModel, ValueOf};
use crate::volume::Volume;

/// A blend mode with its table.
pub(super) struct Blend {
    /// As the script reads it.
    pub(super) json: Value,
    /// Rows and columns of the table, and its entries: straight colour, and extinction per mm or opacity.
    pub(super) size: [usize; 2],
    pub(super) entries: Vec<[f64; 4]>,
}

impl Blend {
    /// The mode that shows what a scene shows. `gradients_per_mm` is the range of the volume's gradient magnitudes, for
    /// transfer functions that read them.
    ///
    /// # Errors
    /// `Fault::Unsupported` for what no mode shows.
    pub(super) fn new(
        scene: &Scene,
        volume: &Volume,
        table: Table,
        gradients_per_mm: Option<[f64; 2]>,
    ) -> Result<Self> {
        let range = volume.value_range();
        let row = |entry: &dyn Fn(f64) -> [f64; 4], json: Value| {
            let at = |i: usize| range[0] + (range[1] - range[0]) * i as f64 / (table.values - 1) as f64;
            Blend { json, size: [1, table.values], entries: (0..table.values).map(|i| entry(at(i))).collect() }
        };
        let named = |mode: &str| json!({ "mode": mode });
        Ok(match &scene.model {
            Model::Light => {
                let gradient = gradients_per_mm.map(|ends| (table.gradients, ends));
                let Tabulated { size, entries, .. } =
                    Tabulated::new(&scene.transfer_function, table.values, range, gradient)?;
                Blend { json: named("composite"), size: [size[1], size[0]], entries }
            }
            Model::Value(model) => {
                let (mode, opacity) = mode_and_opacity(model, volume)?;
                let shown = json!({ "mode": mode, "opacity": opacity, "window": model.window });
                let grey = |v: f64| {
                    let light = model.light(v);
                    [light, light, light, opacity]
                };
                row(&grey, shown)
            }
            Model::Surfaces(surfaces) => {
                let mut levels: Vec<Surface> = surfaces.clone();
                levels.retain(|s| (range[0]..=range[1]).contains(&s.value));
                levels.sort_by(|a, b| a.value.total_cmp(&b.value));
                let values: Vec<f64> = levels.iter().map(|s| s.value).collect();
                let nearest = |v: f64| {
                    let distance = |s: &&Surface| (s.value - v).abs();
                    levels.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or([0.0; 4], |s| {
                        let [r, g, b] = s.color;
                        [r, g, b, s.opacity]
                    })
                };
                row(&nearest, json!({ "mode": "isosurface", "levels": values }))
            }
        })
    }
}

fn mode_and_opacity(model: &ValueModel, volume: &Volume) -> Result<(&'static str, f64)> {
    Ok(match model.of {
        ValueOf::Maximum => ("maximum", 1.0),
        ValueOf::Minimum => ("minimum", 1.0),
        ValueOf::Mean => ("average", 1.0),
        ValueOf::Sum => {
            let corners = volume.grid().corners_mm();
            let longest_mm = (0..4).map(|c| corners[c].distance(corners[7 - c])).fold(0.0, f64::max);
            ("additive", 1.0 / longest_mm)
        }
        ValueOf::LocalMaximum { .. } | ValueOf::OpticalDepth => {
            return Err(Error::new(Fault::Unsupported, "VTK has no such projection")
                .element("effects.project.show")
                .found(model.of.name())
                .expected("maximum, minimum, mean or sum"));
        }
    })
}
