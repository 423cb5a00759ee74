//! Every scene, against VTK's GPU mapper.

use super::{Limits, against_vtk, folder, scenes};

#[test]
fn the_march_with_vtks_conventions_is_vtks_picture() {
    let names = scenes();
    assert!(names.len() >= 58, "{} scenes", names.len());
    let mut objections = Vec::new();
    for name in &names {
        let text = std::fs::read_to_string(folder("scenes").join(format!("{name}.yaml"))).expect("readable");
        let limits = Limits::of(name, text.contains("shading:"));
        let objection = against_vtk(name, &[]).and_then(|comparison| limits.objection(&comparison));
        objections.extend(objection.map(|why| format!("{name}: {why}")));
    }
    assert!(objections.is_empty(), "not as VTK's GPU mapper:\n{}", objections.join("\n"));
}

#[test]
fn without_each_convention_it_is_another_picture() {
    // The scene in which the convention shows, and the distance by which it does, in steps of 8 bits.
    for (name, override_, convention, least) in [
        ("head-coarse", "integrate.march.rule=midpoint", "samples at the ends of whole steps", 2.0),
        ("head-thin-shells", "integrate.march.table.values=65536", "a table of 4096 entries", 6.0),
        ("head-faint", "integrate.march.table.uncorrected_opacity=0", "faint opacities uncorrected", 0.4),
        ("head-opaque", "integrate.march.termination_transmittance=0", "rays that end at 254/255", 0.4),
        ("head-lit", "integrate.march.reflection=blinn-phong", "Phong's highlight", 2.0),
        ("head-surface", "integrate.march.reflection=blinn-phong", "Phong's highlight on a surface", 2.0),
        ("head-mip", "integrate.march.rule=midpoint", "maxima of whole steps", 1.0),
        ("head-plane", "integrate.march.rule=midpoint", "a first sample a step behind the plane", 2.0),
        (
            "head-cropped",
            "effects.clip.box.voxels=[[9.77, 40.2], [8.16, 30.05], [11.72, 56]]",
            "cropping half a voxel off",
            2.0,
        ),
    ] {
        let found = 255.0 * against_vtk(name, &[override_]).expect("a phantom").max_abs_all;
        assert!(found > least, "{name} without {convention}: {found:.2}/255 from VTK, expected above {least}");
    }
}
