//! Stacks of pictures as written, and which form a file has.

use std::path::{Path, PathBuf};

use pellucid::image::over::Association;
use pellucid::plan::{Format, StackPlan};
use pellucid::scene::Background;
use pellucid::spec::StackSpec;

fn stack(text: &str) -> pellucid::Result<StackSpec> {
    StackSpec::from_text(text, Path::new("pictures/stack.yaml"), &[])
}

#[test]
fn what_is_left_out_has_defaults_and_paths_are_relative_to_the_file() {
    let spec = stack("version: 1\nlayers: [front.png, /back.png]\n").unwrap();
    let plan = StackPlan::new(&spec, None).unwrap();
    assert_eq!(plan.layers, [PathBuf::from("pictures/front.png"), PathBuf::from("/back.png")]);
    assert_eq!((plan.association, plan.background), (Association::Straight, Background::Color([0.0; 3])));
    assert_eq!((plan.output.path, plan.output.format), (PathBuf::from("pictures/stack.png"), Format::Png8));
    let text = "version: 1\nlayers: [a.png]\nalpha: associated\nimage: { background: transparent }\noutput: b.exr\n";
    let plan = StackPlan::new(&stack(text).unwrap(), Some(Path::new("c.exr"))).unwrap();
    assert_eq!((plan.association, plan.background), (Association::Associated, Background::Transparent));
    assert_eq!((plan.output.path, plan.output.format), (PathBuf::from("c.exr"), Format::Exr));
}

#[test]
fn mistakes_are_named_with_their_place() {
    for (text, message) in [
        (
            "version: 1\nlayers: []\n",
            "2:9: a value is out of range (layers): found a list of 0, expected at least one picture",
        ),
        ("version: 2\nlayers: [a.png]\n", "1:10: a value is out of range (version): found 2, expected 1"),
        (
            "version: 1\nlayers: [a.png, b.jpg]\n",
            "2:17: a value is out of range (layers.1): found \"b.jpg\", expected a .png file",
        ),
        (
            "version: 1\nlayers: [a.png]\nvolume: { phantom: head }\n",
            "3:1: there is no such key (volume): found volume, expected one of version, layers, alpha, image, output",
        ),
        (
            "version: 1\nlayers: [a.png]\nalpha: linear\n",
            "3:8: there is no such choice (alpha): found linear, expected one of straight, associated",
        ),
        (
            "version: 1\nlayers: [a.png]\nimage: { bits: 16 }\noutput: a.exr\n",
            "3:16: nothing would read this key: an OpenEXR picture has 32-bit floats (image.bits)\n  remedy: remove the key",
        ),
    ] {
        let found = stack(text).expect_err(text).to_string();
        assert_eq!(found, format!("pictures/stack.yaml:{message}"), "for {text}");
    }
}
