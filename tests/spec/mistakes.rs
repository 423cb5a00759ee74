//! Mistakes of authors. Each row: the text, with «» around what the error must point at, and the whole message after the
//! file's name.

use pellucid::spec::BUILT_IN_PRESETS;

use super::{SHORT, mistake};

/// Checks the message and that the place is the marked one.
pub(super) fn check(marked: &str, message: &str) {
    let text = marked.replace(['«', '»'], "");
    let error = mistake(&text);
    let found = error.to_string();
    let place = error.text_place().unwrap_or_else(|| panic!("no place: {found}"));
    let before = marked.split('«').next().expect("a mark");
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
    assert_eq!((place.line, place.column), (line, column), "place of: {found}\nin\n{marked}");
    assert_eq!(found, format!("scene.yaml:{line}:{column}: {message}"), "in\n{marked}");
    if let (Some((at, length)), Some(end)) = (place.span, marked.split('«').nth(1).and_then(|m| m.find('»'))) {
        let written = &marked.split('«').nth(1).expect("a mark")[..end];
        if length > 0 && !written.contains(['{', '[', '\n']) {
            assert_eq!(&text[at..at + length], written, "span of: {found}");
        }
    }
}

/// The same for keys after the shortest pipeline.
pub(super) fn check_after(marked: &str, message: &str) {
    check(&format!("{SHORT}{marked}"), message);
}

#[test]
fn unknown_keys_and_choices_come_with_a_suggestion() {
    check_after(
        "effects: { shading: { «ambint»: 0.2 } }\n",
        "there is no such key (effects.shading.ambint): found ambint, expected one of ambient, diffuse, specular, \
         shininess, two_sided, soft_gradient_hu_per_mm, lights\n  remedy: did you mean ambient?",
    );
    check_after(
        "camera: { view: «anterio» }\n",
        "there is no such choice (camera.view): found anterio, expected one of anterior, posterior, left, right, \
         superior, inferior\n  remedy: did you mean anterior?",
    );
    check_after(
        "integrate: { «marsh»: { step_mm: 1 } }\n",
        "there is no such choice (integrate): found marsh, expected one of exact, march, reference, \
         auto\n  \
         remedy: did you mean march?",
    );
    check_after(
        "effects: { shading: { lights: [headlight, { directional: { «toward»: [0, 0, 1] } }] } }\n",
        "there is no such key (effects.shading.lights.1.directional.toward): found toward, expected one of towards, \
         color\n  remedy: did you mean towards?",
    );
    let known: Vec<&str> = BUILT_IN_PRESETS.iter().map(|(name, _)| *name).collect();
    check(
        &SHORT.replace("bone", "«bonee»"),
        &format!(
            "there is no such preset (transfer_function.0.preset): found bonee, expected one of {}, or a path to a .yaml \
             file\n  remedy: did you mean bone?",
            known.join(", ")
        ),
    );
}

#[test]
fn values_of_the_wrong_kind_are_named() {
    check_after(
        "camera: { azimuth: «east» }\n",
        "a value is of the wrong kind (camera.azimuth): found \"east\", expected a number, or a fraction such as 1/255",
    );
    check_after(
        "camera: { azimuth: «true» }\n",
        "a value is of the wrong kind (camera.azimuth): found true, expected a number",
    );
    check_after(
        "effects: { shading: { two_sided: «yes» } }\n",
        "a value is of the wrong kind (effects.shading.two_sided): found \"yes\", expected true or false",
    );
    check_after(
        "image: { size: «[512]» }\n",
        "a value is of the wrong kind (image.size): found a list of 1, expected a list of 2",
    );
    check_after(
        "image: { size: [512, «-3»] }\n",
        "a value cannot be used (image.size.1): found -3, expected a whole number of at least 0",
    );
    check_after("image: { bits: «12» }\n", "bits per channel are 8 or 16, not 12 (image.bits)");
    check_after(
        "camera: «[1, 2]»\n",
        "a value is of the wrong kind (camera): found a list of 2, expected a mapping with keys such as view",
    );
    check_after(
        "integrate: { march: «5» }\n",
        "a value is of the wrong kind (integrate.march): found 5, expected a mapping with keys such as step_mm",
    );
    check_after(
        "integrate: «{ march: {}, exact: {} }»\n",
        "a value is of the wrong kind (integrate): found a mapping with the keys march and 1 more, expected one of \
         exact, march, reference, auto",
    );
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for (written, found) in [(".nan", "NaN"), (".inf", "inf"), ("-.inf", "-inf"), ("1e999", "inf")] {
        check_after(
            &format!("camera: {{ azimuth: «{written}» }}\n"),
            &format!("a value is of the wrong kind (camera.azimuth): found {found}, expected a finite number"),
        );
    }
    check_after(
        "integrate: { exact: { tolerance: «1/0» } }\n",
        "a value is of the wrong kind (integrate.exact.tolerance): found \"1/0\", expected a number, or a fraction such \
         as 1/255",
    );
}

#[test]
fn colors_are_checked_and_one_lost_to_a_comment_is_found() {
    check_after(
        "image: { background: «\"#12345\"» }\n",
        "a value cannot be used (image.background): found \"#12345\", expected \"transparent\" or a colour: \"#rgb\" or \
         \"#rrggbb\" in quotes, [r, g, b], or one of black, white, gray, red, green, blue, yellow, cyan, magenta, orange",
    );
    check_after(
        "image: { background: [0, 0, «2»] }\n",
        "a value cannot be used (image.background.2): found 2, expected linear red, green and blue from 0 to 1",
    );
    let lost = SHORT.to_owned() + "    color: #f2e6d0\n";
    let error = mistake(&lost);
    assert_eq!(error.element_name(), Some("transfer_function.0.color"), "{error}");
    assert!(error.to_string().contains("# starts a comment"), "{error}");
}

#[test]
fn missing_keys_and_empty_lists_are_found() {
    check("«version: 1»\ntransfer_function: []\n", "a key is missing: expected the key volume");
    check(
        &SHORT.replace("\n  - preset: bone", " «[]»"),
        "a value is out of range (transfer_function): found a list of 0, expected at least one layer",
    );
    check_after(
        "effects: { shading: { lights: «[]» } }\n",
        "a value is out of range (effects.shading.lights): found a list of 0, expected at least one light; without the \
         key it is a headlight",
    );
    check(&SHORT.replace("version: 1", "version: «2»"), "a value is out of range (version): found 2, expected 1");
}

#[test]
fn numbers_out_of_range_are_found() {
    check_after(
        "camera: { fov_degrees: «180» }\n",
        "a value is out of range (camera.fov_degrees): found 180, expected an angle above 0 and below 180 degrees",
    );
    check_after(
        "integrate: { auto: { budget_ms: «0» } }\n",
        "a value is out of range (integrate.auto.budget_ms): found 0, expected a number above 0",
    );
    check_after(
        "integrate: { exact: { tolerance: «0» } }\n",
        "a value is out of range (integrate.exact.tolerance): found 0, expected a number above 0 and below 1, such as \
         1/255",
    );
    check_after(
        "normalise: { hu: «[100, 100]» }\n",
        "a value is out of range (normalise.hu): found a list of 2, expected [lowest, highest], the lower first",
    );
    check_after(
        "certify: «0»\n",
        "a value is out of range (certify): found 0, expected a number of pixels of at least 1",
    );
    check_after(
        "output: «scene.jpg»\n",
        "a value is out of range (output): found \"scene.jpg\", expected a file name that ends in .png or .exr",
    );
}

#[test]
fn keys_that_exclude_each_other_are_found() {
    check(
        &SHORT.replace("phantom: head", "phantom: «head», source: scan.nrrd"),
        "two keys exclude each other (volume.phantom): found source and phantom, expected exactly one of source, phantom, \
         analytic",
    );
    check_after(
        "integrate: { march: { step_mm: 1, step_voxels: «0.5» } }\n",
        "two keys exclude each other (integrate.march.step_voxels): found step_mm and step_voxels, expected exactly one \
         of step_mm, step_voxels",
    );
    check_after(
        "camera: «{ position_mm: [0, -500, 0] }»\n",
        "a key is missing (camera.target_mm): expected target_mm, which position_mm needs",
    );
}

#[test]
fn keys_that_nothing_reads_are_found() {
    check_after(
        "camera: { height_mm: «200» }\n",
        "nothing would read this key: the height of a perspective picture follows from fov_degrees; it goes with \
         projection: parallel (camera.height_mm)\n  remedy: remove the key",
    );
    check_after(
        "camera: { projection: parallel, fov_degrees: «20» }\n",
        "nothing would read this key: parallel rays have no field of view (camera.fov_degrees)\n  \
         remedy: remove the key",
    );
    check_after(
        "camera: { position_mm: [0, -500, 0], target_mm: [0, 0, 0], azimuth: «20» }\n",
        "nothing would read this key: the camera is placed by position_mm and target_mm (camera.azimuth)\n  \
         remedy: remove the key",
    );
    check_after(
        "integrate: { march: { order: back-to-front, termination_transmittance: «0.01» } }\n",
        "nothing would read this key: only front-to-back rays can stop early \
         (integrate.march.termination_transmittance)\n  remedy: remove the key",
    );
    check_after(
        "image: { bits: «16» }\noutput: scene.exr\n",
        "nothing would read this key: an OpenEXR picture has 32-bit floats (image.bits)\n  remedy: remove the key",
    );
}

#[test]
fn widgets_are_checked() {
    let at = "transfer_function.0.widgets.0";
    let rows = [
        (
            "«{ opacity_per_mm: 1, color: red }»",
            "a key is missing (AT): expected exactly one of rectangle, trapezoid, triangle, contour, ellipse, gaussian, points",
        ),
        (
            "«{ rectangle: { hu: [0, 1] }, opacity_per_mm: 1 }»",
            "a key is missing (AT.color): expected color, which what absorbs needs",
        ),
        (
            "«{ rectangle: { hu: [0, 1] } }»",
            "a key is missing (AT.opacity_per_mm): expected opacity_per_mm, extinction_per_mm or emission_per_mm",
        ),
        (
            "{ rectangle: { hu: [0, 1] }, color: red, opacity_per_mm: 1, extinction_per_mm: «1» }",
            "two keys exclude each other (AT.extinction_per_mm): found opacity_per_mm and extinction_per_mm, expected exactly one of opacity_per_mm, extinction_per_mm",
        ),
        (
            "{ rectangle: { hu: «[1, 0]» }, color: red, opacity_per_mm: 1 }",
            "a value is out of range (AT.rectangle.hu): found a list of 2, expected numbers in ascending order, not all equal",
        ),
        (
            "{ rectangle: { hu: [0, 1] }, color: red, opacity_per_mm: «1.5» }",
            "a value is out of range (AT.opacity_per_mm): found 1.5, expected 0 to 1, the opacity of 1 mm",
        ),
        (
            "{ contour: { hu: 0, thickness_mm: 1, gradient_hu_per_mm: «[0, 9]» }, color: red, opacity_per_mm: 1 }",
            "a value is out of range (AT.contour.gradient_hu_per_mm): found a list of 2, expected [lowest, highest], the lowest above 0: there the shape is a point",
        ),
        (
            "{ gaussian: «{ hu: 0, hu_sigma: 9, gradient_hu_per_mm: 3 }», color: red, opacity_per_mm: 1 }",
            "a key is missing (AT.gaussian.gradient_sigma_hu_per_mm): expected gradient_sigma_hu_per_mm, which goes with the mean",
        ),
        (
            "{ ellipse: { hu: 0, hu_radius: «-1», gradient_hu_per_mm: 3, gradient_radius_hu_per_mm: 4 }, color: red, opacity_per_mm: 1 }",
            "a value is out of range (AT.ellipse.hu_radius): found -1, expected a number above 0",
        ),
        (
            "{ points: [{ hu: 0, opacity_per_mm: 0 }], color: «red» }",
            "nothing would read this key: points have their own (AT.color)\n  remedy: remove the key",
        ),
        (
            "{ points: [«{ hu: 0, opacity_per_mm: 0.1 }»] }",
            "a key is missing (AT.points.0.color): expected color, which what absorbs needs",
        ),
        (
            "{ points: «[{ hu: 9, opacity_per_mm: 0 }, { hu: 0, opacity_per_mm: 0 }]» }",
            "a value is out of range (AT.points): found a list of 2, expected points in ascending order of hu",
        ),
        (
            "{ rectangle: { hu: [0, 1] }, color: red, opacity_per_mm: 1, gradient_weight: «[[0, 1]]» }",
            "nothing would read this key: it goes with points; this shape has its own (AT.gradient_weight)\n  remedy: remove the key",
        ),
    ];
    for (widget, message) in rows {
        let marked =
            format!("version: 1\nvolume: {{ phantom: head }}\ntransfer_function:\n  - widgets:\n      - {widget}\n");
        check(&marked, &message.replace("AT", at));
    }
}

#[test]
fn yaml_itself_is_checked() {
    let error = mistake("version: 1\nvolume: { phantom: head\n");
    assert!(error.to_string().contains("this is not valid YAML"), "{error}");
    assert!(error.text_place().is_some(), "{error}");
    let error = mistake(&format!("{SHORT}version: 1\n"));
    assert!(error.to_string().contains("duplicate"), "{error}");
    assert_eq!(error.text_place().map(|p| p.line), Some(5), "{error}");
    let error = mistake("# nothing\n");
    assert!(error.to_string().contains("the file is empty"), "{error}");
    let bomb = "a: &a [x,x,x,x,x,x,x,x,x]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b]\n\
                d: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c]\ne: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d]\nf: [*e,*e,*e,*e,*e,*e,*e,*e,*e]\n";
    let error = mistake(bomb);
    assert!(error.to_string().contains("not valid YAML"), "a bomb of aliases: {error}");
}
