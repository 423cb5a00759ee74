#!/usr/bin/env python3
"""Errors of VTK and of pellucid against the oracle on every scene, and where VTK's come from, as RESULTS.md.

    results.py PELLUCID            needs the packages of requirements.txt

VTK's error is taken apart by switching pellucid's march to VTK's conventions one by one, from the definition on; what each
adds is the RMS difference between one picture and the next. What is left after the last is VTK's rounding.
"""

import json
import pathlib
import sys
import tempfile

from bridge import HERE, MAPPERS, Pellucid, render_vtk, scenes

STEP = "step_voxels: {step}"
# Each with the conventions of those before it.
LIGHT = [
    ("step", "rule: midpoint"),
    ("first sample", "rule: whole-steps"),
    ("table", "rule: whole-steps, table: {}"),
    ("faint", "rule: whole-steps, table: { uncorrected_opacity: 1e-4 }"),
    ("early end", "rule: whole-steps, table: { uncorrected_opacity: 1e-4 }, termination_transmittance: 1/255"),
    ("light", "compatibility: vtk"),
]
# Neither projections nor surfaces read the transfer function's table; VTK's of a projection holds the window.
PROJECTION = [("step", "rule: midpoint"), ("first sample", "compatibility: vtk")]
SURFACES = [("step", "bisections: 0"), ("first sample", "rule: whole-steps"), ("light", "compatibility: vtk")]
CAUSES = [name for name, _ in LIGHT] + ["rounding", "8 bits"]


def marches(exported):
    """The conventions that show in a scene, by VTK's blend mode."""
    return {"composite": LIGHT, "isosurface": SURFACES}.get(exported["blend"]["mode"], PROJECTION)


def step_of(scene):
    text = scene.path.read_text()
    return text.split("step_voxels: ")[1].split(" ")[0] if "step_voxels: " in text else "0.5"


def measure(pellucid, scene, folder):
    """Pictures of one scene, and their distances in steps of 8 bits."""
    exported = pellucid.export(scene, folder)
    step = STEP.format(step=step_of(scene))
    oracle = pellucid.render(scene, "reference", folder / "oracle.exr")
    exact = pellucid.render(scene, "{ exact: { tolerance: 1/255 } }", folder / "exact.exr")
    conventions = marches(exported)
    marched = [
        pellucid.render(scene, f"{{ march: {{ {step}, {settings} }} }}", folder / f"march{i}.exr")
        for i, (_, settings) in enumerate(conventions)
    ]
    live = {}
    for mapper in MAPPERS:
        picture = folder / f"{mapper}.npy"
        facts = render_vtk(folder, mapper, picture)
        if facts is not None:
            live[mapper] = picture
        if mapper == "gpu":
            measure.facts = facts
    live["gpu8"] = folder / "gpu8.npy"
    render_vtk(folder, "gpu", live["gpu8"], "--bits", "8")

    def apart(a, b):
        found = pellucid.compare(a, b)[0]
        return 255 * found["max_abs_all"], 255 * found["rms_all"]

    row = {"exact": apart(oracle, exact), "gpu": apart(oracle, live["gpu"]), "gpu8": apart(oracle, live["gpu8"])}
    row["cpu"] = apart(oracle, live["cpu"]) if "cpu" in live else None
    row["same"] = apart(live["gpu"], marched[-1])
    chain = [oracle, *marched, live["gpu"], live["gpu8"]]
    names = [name for name, _ in conventions] + ["rounding", "8 bits"]
    row["causes"] = {name: apart(a, b)[1] for name, a, b in zip(names, chain, chain[1:])}
    row["fixed point"] = apart(live["gpu"], live["cpu"])[1] if "cpu" in live else None
    return row


def pair(value):
    return "–" if value is None else f"{value[0]:.2f} / {value[1]:.3f}"


def text(rows, facts):
    lines = [
        "# Against VTK",
        "",
        f"VTK {facts['vtk']}, OpenGL by {facts['renderer']}; made by `tests/vtk/results.py`. All numbers in steps of 8 bits "
        "(1/255), linear and premultiplied, over all pixels and channels. Each scene is a file in `scenes/`; VTK has its step, "
        "its transfer function as a table of 4096 (x 1024) entries, and in 2D the opacities corrected and the gradient "
        "magnitude given, by the script of `pellucid export-vtk`.",
        "",
        "## Errors against the oracle, and pellucid's march with VTK's conventions against VTK",
        "",
        "Largest / RMS. `exact` is asked for 1/255 and has no step; the mappers draw into floats (GPU), 8 bits (GPU, 8 bits) and "
        "15 bits (CPU, which has no 2D transfer functions, and is held against no averages, sums and surfaces).",
        "",
        "| scene | pellucid exact | VTK GPU | VTK GPU, 8 bits | VTK CPU | pellucid as VTK, to VTK GPU |",
        "|---|---|---|---|---|---|",
    ]
    for name, row in rows.items():
        cells = [pair(row[key]) for key in ("exact", "gpu", "gpu8", "cpu", "same")]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    nearer = sum(all(row["exact"][i] < row["gpu"][i] for i in (0, 1)) for row in rows.values())
    lines += [
        "",
        f"`exact` is nearer to the oracle than VTK's GPU mapper on {nearer} of {len(rows)} scenes, by the largest error and by RMS. "
        "Where a scene is lit, part of VTK's distance is one of definitions: the scene's highlight is Blinn's, VTK's is Phong's; "
        "the column *light* below says how large that part is.",
        "",
        "## Where VTK's error comes from",
        "",
        "RMS of what each convention changes, added one after the other from the definition on: *step*, midpoint samples at the "
        "scene's step; *first sample*, at the ends of whole steps, the rest of the ray left out, surfaces at the first sample behind "
        "them, and clipping where VTK has it; *table*, 4096 entries looked up "
        "half an entry off; *faint*, opacities up to 1e-4 per mm not corrected; *early end* at an opacity of 254/255; *light*, "
        "Phong's highlight, differences n/(n - 1) voxels wide, no ambient light and misplaced normals under scene lights. *Rounding* "
        "is what is left: positions added up in f32. Then *8 bits* of the window, and in place of all that, *fixed point*: the "
        "CPU mapper against the GPU mapper, with its encoded normals where the scene is lit. A dash is a convention that a scene "
        "has no part in; *rounding* of a projection includes the window as a table.",
        "",
    ]
    lines += ["| scene | " + " | ".join(CAUSES) + " | fixed point |", "|" + "---|" * (len(CAUSES) + 2)]
    for name, row in rows.items():
        cells = [f"{row['causes'][cause]:.3f}" if cause in row["causes"] else "–" for cause in CAUSES]
        fixed = "–" if row["fixed point"] is None else f"{row['fixed point']:.3f}"
        lines.append(f"| {name} | " + " | ".join(cells) + f" | {fixed} |")
    return "\n".join(lines) + "\n"


def main():
    pellucid, rows = Pellucid(pathlib.Path(sys.argv[1])), {}
    for scene in scenes(sys.argv[2:]):
        with tempfile.TemporaryDirectory() as folder:
            rows[scene.name] = measure(pellucid, scene, pathlib.Path(folder))
        print(scene.name, json.dumps(rows[scene.name]), file=sys.stderr)
    table = text(rows, measure.facts)
    if sys.argv[2:]:
        print(table)
    else:
        (HERE / "RESULTS.md").write_text(table)


main()
