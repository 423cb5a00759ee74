//! Presets of other programs: 3D Slicer's `.vp`, `.vp.json` and `presets.xml`, and ParaView's JSON colour maps.
//!
//! All of them hold VTK's functions of one variable, so all of them become a [`VolumeProperty`] first: opacity over the
//! value, colour over the value and, in Slicer's, opacity over the gradient magnitude. What those mean is VTK's:
//!
//! - `α(v)` is the opacity of one *unit distance* `u`, linear in between the points unless a point says otherwise
//!   ([`Function`]); colour is linear in sRGB numbers. Ours are extinction and premultiplied linear light, linear between
//!   points. So `σ(v) = -ln(1 - α(v)) / u` and `q(v) = σ(v) · linear(c(v))` are curves, not lines, and [`import`]
//!   inserts knots.
//! - **The measure.** A slab of one unit distance has an opacity `α` and sends light `α · linear(c)`, in each channel; one of `n`
//!   unit distances has the opacity `1 - (1 - α)ⁿ`. What is imported is within `max_deviation` of both for slabs of any length from
//!   1/64 to 1024 unit distances, so that what is faint and deep is as close as what is dense and thin; what is exported is so for one
//!   unit distance. The units are those in which a picture's `tolerance` is given. It is measured at 65 positions between
//!   neighbouring knots and held to nine tenths of the bound, for what lies between those.
//! - **Colours that mix.** VTK blends sRGB numbers as if they were light, so where translucent colours mix its picture is another than
//!   that of the light. [`ColorNumbers::Light`] imports the numbers as they are: linear numbers of a rendering are then VTK's own.
//! - **Gradient opacity.** VTK corrects `α(v)` for the length of the step and then multiplies it by `α_g(g)`, which it does
//!   not correct. With steps of length `d` that is an extinction `-ln(1 - α_g (1 - exp(-σ d))) / d`, and its limit for short
//!   steps is `σ(v) · α_g(g)`: exactly a weight by gradient magnitude. That limit is what is imported. At steps as long as
//!   the unit distance VTK's opacity is `α · α_g` instead; [`Imported::whole_step_difference`] is how far that is off.
//! - **Units of the gradient.** VTK's gradient magnitude is the derivative per mm times the mean of the three voxel
//!   spacings, so that a varying `α_g` means nothing without a spacing, and is refused without one.
//!
//! The other way, [`project`] makes a preset over value and gradient magnitude one over the value alone, and says what is lost.

mod function;
mod import;
mod knots;
mod numbers;
mod paraview;
mod presets_xml;
mod project;
mod read;
mod volume_property;
mod vp;
mod vp_json;
mod yaml;

pub use function::{Function, Node};
pub use import::{ColorNumbers, ImportSettings, Imported, import, preset_name};
pub use paraview::write as write_paraview;
pub use project::{Loss, ProjectSettings, Projection, project};
pub use read::read;
pub use volume_property::{Phong, VolumeProperty};
pub use vp::write as write_vp;
pub use vp_json::write as write_vp_json;
