//! Where steps are longer than rays, the one sample of each lies behind the volume, and so do the ends of its normal's
//! differences: `vtk/conventions.py` shows it of VTK.

use pellucid::Image;

use super::{rendered, spec};

/// Opaque everywhere, and white where it is lit by diffuse light alone.
const OPAQUE: &str = "transfer_function=[{widgets: [\
     {trapezoid: {hu: [-3000, -2000, 4000, 5000]}, opacity_per_mm: 1, color: '#ffffff'}]}]";
const DIFFUSE: &str = "effects.shading={ambient: 0, diffuse: 1, specular: 0, shininess: 1, soft_gradient_hu_per_mm: 0}";

fn picture(more: &[&str]) -> Image {
    let spec = spec("head-lit", &[&[OPAQUE, DIFFUSE], more].concat()).expect("a phantom");
    rendered(&spec).unwrap_or_else(|error| panic!("{error}"))
}

/// Number of pixels in which something is, and in which it is lit.
fn shown_and_lit(image: &Image) -> [usize; 2] {
    let count = |is: fn(&[f32; 4]) -> bool| image.pixels().iter().filter(|pixel| is(pixel)).count();
    [count(|pixel| pixel[3] > 0.5), count(|pixel| pixel[0] > 0.0)]
}

#[test]
fn a_sample_far_behind_the_volume_has_no_normal() {
    let [shown, lit] = shown_and_lit(&picture(&["integrate.march.step_mm=5000"]));
    assert!(shown > 2000 && lit == 0, "of {shown} pixels shown {lit} are lit, expected none");
}

#[test]
fn with_differences_at_the_border_it_would_have_one() {
    let [shown, lit] =
        shown_and_lit(&picture(&["integrate.march.step_mm=5000", "integrate.march.reflection=blinn-phong"]));
    assert!(lit > shown / 2, "of {shown} pixels shown {lit} are lit, expected most");
}
