//! Transfer functions of the table, and the scenes they are used in.

use glam::DVec3;
use pellucid::scene::{Background, Camera, Effects, Light, Model, Projection, Scene, Shading};
use pellucid::transfer::shapes::{Shape, extinction_per_mm};
use pellucid::transfer::{Optics, TransferFunction};
use pellucid::volume::Quantity;
use pellucid::{Result, Volume};

/// A widget: corners of its trapezoid along the value (HU) and along the gradient magnitude (HU/mm), the opacity of 1 mm,
/// and the colour.
struct Widget {
    value: [f64; 4],
    gradient_per_mm: Option<[f64; 4]>,
    opacity: f64,
    color: [f64; 3],
}

/// A transfer function in HU.
pub(crate) struct Function {
    pub(crate) name: &'static str,
    widgets: &'static [Widget],
}

const BONE: [f64; 3] = [1.0, 0.93, 0.78];
const SKIN: [f64; 3] = [0.85, 0.55, 0.4];
const RED: [f64; 3] = [0.8, 0.15, 0.1];

/// Bone by value and by value with gradient, skin by ramps of 20 HU, several widgets at once, and one that is smooth.
pub(crate) const FUNCTIONS: [Function; 5] = [
    Function {
        name: "bone 1D",
        widgets: &[Widget { value: [150.0, 350.0, 2500.0, 3071.0], gradient_per_mm: None, opacity: 0.5, color: BONE }],
    },
    Function {
        name: "bone 2D",
        widgets: &[Widget {
            value: [150.0, 350.0, 2500.0, 3071.0],
            gradient_per_mm: Some([30.0, 120.0, 900.0, 1500.0]),
            opacity: 0.6,
            color: BONE,
        }],
    },
    Function {
        name: "steep skin",
        widgets: &[Widget {
            value: [-220.0, -200.0, -180.0, -160.0],
            gradient_per_mm: None,
            opacity: 0.9,
            color: SKIN,
        }],
    },
    Function {
        name: "mixed 2D",
        widgets: &[
            Widget {
                value: [-300.0, -200.0, -100.0, -20.0],
                gradient_per_mm: Some([20.0, 80.0, 500.0, 900.0]),
                opacity: 0.05,
                color: SKIN,
            },
            Widget {
                value: [-20.0, 30.0, 80.0, 160.0],
                gradient_per_mm: Some([0.0, 5.0, 60.0, 150.0]),
                opacity: 0.02,
                color: RED,
            },
            Widget {
                value: [120.0, 260.0, 400.0, 700.0],
                gradient_per_mm: None,
                opacity: 0.12,
                color: [0.3, 0.5, 0.9],
            },
            Widget {
                value: [250.0, 600.0, 2500.0, 3071.0],
                gradient_per_mm: Some([30.0, 100.0, 900.0, 1500.0]),
                opacity: 0.7,
                color: BONE,
            },
        ],
    },
    Function {
        name: "smooth 1D",
        widgets: &[
            Widget { value: [-700.0, 200.0, 300.0, 1500.0], gradient_per_mm: None, opacity: 0.01, color: SKIN },
            Widget { value: [0.0, 1800.0, 2500.0, 3071.0], gradient_per_mm: None, opacity: 0.2, color: BONE },
        ],
    },
];

/// How values of a scan follow from HU: `factor · (HU + 1000)`, with the air of a scan of 8 bits at 0 and its densest
/// matter at the 2000 HU of dense bone; unchanged for a scan in HU.
#[derive(Debug, Clone, Copy)]
struct Scale {
    factor: f64,
    offset: f64,
}

impl Scale {
    fn of(volume: &Volume) -> Self {
        match volume.quantity() {
            Quantity::Hu => Scale { factor: 1.0, offset: 0.0 },
            Quantity::Arbitrary => {
                let [low, high] = volume.value_range();
                let factor = (high - low) / 3000.0;
                Scale { factor, offset: low + 1000.0 * factor }
            }
        }
    }

    fn value(self, hu: f64) -> f64 {
        self.factor * hu + self.offset
    }
}

/// The whole scan in perspective, from its front and left, a little from above.
pub(crate) fn scene(volume: &Volume, function: &Function, shaded: bool, size: usize) -> Result<Scene> {
    let scale = Scale::of(volume);
    let mut terms = Vec::new();
    for widget in function.widgets {
        let shape = Shape::Trapezoid {
            value: widget.value.map(|hu| scale.value(hu)),
            gradient_per_mm: widget.gradient_per_mm.map(|g| g.map(|g| g * scale.factor)),
        };
        let optics = Optics::colored(extinction_per_mm(widget.opacity, 1.0), widget.color);
        terms.extend(shape.expand(optics, 0.0)?.terms);
    }
    let window = [-1024.0, 3071.0].map(|hu| scale.value(hu));
    let transfer_function = TransferFunction::new(window, 1500.0 * scale.factor, terms)?;
    let shading = shaded.then(|| shading(20.0 * scale.factor));
    let center = volume.grid().center_mm();
    let radius = volume.grid().corners_mm()[0].distance(center);
    let towards = DVec3::new(-0.35, 0.9, -0.25).normalize();
    let eye = center - 4.0 * radius * towards;
    let projection = Projection::Perspective { fov_degrees: 26.0 };
    let camera = Camera::look_at(eye, center, DVec3::Z, projection, [size; 2])?;
    Ok(Scene {
        model: Model::Light,
        transfer_function,
        shading,
        camera,
        background: Background::Transparent,
        effects: Effects::default(),
    })
}

fn shading(soft_gradient_per_mm: f64) -> Shading {
    let towards = DVec3::new(1.0, -1.5, 2.0).normalize();
    Shading {
        ambient: 0.2,
        diffuse: 0.6,
        specular: 0.2,
        shininess: 30.0,
        two_sided: true,
        soft_gradient_per_mm,
        lights: vec![Light::Headlight { color: [0.7; 3] }, Light::Directional { towards, color: [0.4, 0.4, 0.35] }],
    }
}
