#!/usr/bin/env python3
"""What effects cost a scene that does not ask for them: nothing, to the bit and to the instruction.

    cost.py PELLUCID [--before OTHER_PELLUCID] [--only EFFECT …]

For each effect one row: whether a pipeline that names it with a strength of 0 gives the same pixels as one that does not
name it, whether one with some strength gives others (or the row would say nothing), and the instructions of the first
over those of the second, as callgrind counts them. With `--before`, a program built before the effects existed, a second
table has the instructions of pipelines without effects by this program over those by that one: both built alike, with
`cargo build --release`. Exits 1 if a row does not hold. Needs valgrind.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SIZE = 96
LIMIT = 0.01

# Name, what is written under `effects:` with a strength of 0, and with some; and what else a pipeline then needs.
EFFECTS = [
    ("shading", "shading: { ambient: 1, diffuse: 0, specular: 0 }", "shading: {}", ""),
    ("depth cue", "depth_cue: { constant: 1, per_mm: 0 }", "depth_cue: { per_mm: 0.002 }", "lit"),
    ("fog, linear", "fog: { linear: { start_mm: 9000, end_mm: 9001 } }", "fog: { linear: { start_mm: 400, end_mm: 800 }, color: white }", ""),
    ("fog, exp", "fog: { exp: { density_per_mm: 0 } }", "fog: { exp: { density_per_mm: 0.001 }, color: white }", ""),
    ("fog, exp2", "fog: { exp2: { density_per_mm: 0 } }", "fog: { exp2: { density_per_mm: 0.001 }, color: white }", ""),
    ("haze", "haze: { extinction_per_mm: 0 }", "haze: { extinction_per_mm: 0.001, color: white }", ""),
    ("shadows", "shadows: { strength: 0 }", "shadows: { strength: 1 }", "lit"),
    ("scattering", "scattering: { albedo: 0 }", "scattering: { albedo: 0.5 }", "lit"),
    ("clipping", "clip: { box: { voxels: [open, open, open] } }", "clip: { box: { trim_mm: { left: 60 } } }", ""),
    ("mask", "mask: { phantom: structures, labels: { skull: show } }", "mask: { phantom: structures, labels: { skull: hide } }", ""),
    ("absorption or emission alone", "light: both", "light: emission", ""),
    ("classification at voxels", "classify: samples", "classify: voxels", ""),
]

METHODS = [("exact", "exact"), ("march", "{ march: { step_voxels: 0.5 } }")]

# Pipelines without effects: name, transfer function, effects, method.
ONE_D = "[{ widgets: [{ trapezoid: { hu: [150, 300, 2500, 3000] }, opacity_per_mm: 0.5, color: white }] }]"
TWO_D = "[{ preset: bone }, { preset: skin }]"
PLAIN = [
    ("exact, 1D", ONE_D, "", "exact"),
    ("exact, 1D, shaded", ONE_D, "effects: { shading: {} }", "exact"),
    ("exact, 2D, shaded", TWO_D, "effects: { shading: {} }", "exact"),
    ("march, 1D", ONE_D, "", "{ march: { step_voxels: 0.5 } }"),
    ("march, 1D, shaded", ONE_D, "effects: { shading: {} }", "{ march: { step_voxels: 0.5 } }"),
    ("march, 2D, shaded", TWO_D, "effects: { shading: {} }", "{ march: { step_voxels: 0.5 } }"),
    ("MIP", "", "effects: { project: { show: maximum } }", "exact"),
    ("surfaces", "", "effects: { surfaces: [{ hu: 300 }], shading: {} }", "exact"),
]


def pipeline(folder, volume, function, effects, method):
    path = folder / "scene.yaml"
    function = f"transfer_function: {function}\n" if function else ""
    path.write_text(
        f"version: 1\nvolume: {volume}\n{function}{effects}\nintegrate: {method}\nimage: {{ size: [{SIZE}, {SIZE}], background: gray }}\n"
    )
    return path


def render(program, path):
    """The hash of the pixels and the instructions it took, on one thread."""
    picture, counts = path.with_suffix(".png"), path.with_suffix(".callgrind")
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}", program, "--threads", "1", "-q"]
    run = subprocess.run(command + ["render", str(path), "-o", str(picture)], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"{path.read_text()}\n{run.stderr}")
    sidecar = json.loads(pathlib.Path(f"{picture}.json").read_text())
    instructions = int(re.search(r"Collected : (\d+)", run.stderr).group(1))
    return sidecar["picture"]["pixels_sha256"], instructions


def effects_table(program, folder, only):
    print("| effect | method | strength 0 is the same picture | some strength is another | instructions, strength 0 over not named |")
    print("|---|---|---|---|---|")
    holds, volume = True, "{ phantom: { head: { size: 48 } } }"
    for name, none, some, needs in EFFECTS:
        if only is not None and name not in only:
            continue
        lit = "  shading: { lights: [{ directional: { towards: [1, -2, 1] } }] }\n" if needs == "lit" else ""
        for method, integrate in METHODS:
            def picture(effect):
                text = f"effects:\n{lit}  {effect}\n" if lit or effect else ""
                return render(program, pipeline(folder, volume, TWO_D, text, integrate))
            (off, base), (zero, count), (on, _) = picture(""), picture(none), picture(some)
            ratio = count / base
            row_holds = off == zero and on != off and abs(ratio - 1) < LIMIT
            holds &= row_holds
            yes = {True: "yes", False: "NO"}
            print(f"| {name} | {method} | {yes[off == zero]} | {yes[on != off]} | {ratio:.4f}{'' if row_holds else ' (does not hold)'} |", flush=True)
    return holds


def before_table(program, before, folder):
    print("\n| pipeline without effects | instructions now | before there were effects | ratio | same picture |")
    print("|---|---|---|---|---|")
    volume = "{ source: head.nrrd }"
    subprocess.run([program, "-q", "phantom", "head", "--size", "96", "--nrrd", str(folder / "head.nrrd")], check=True, capture_output=True)
    holds = True
    for name, function, effects, method in PLAIN:
        path = pipeline(folder, volume, function, effects, method)
        (now_hash, now), (then_hash, then) = render(program, path), render(before, path)
        row_holds = now / then < 1 + LIMIT
        holds &= row_holds
        print(f"| {name} | {now} | {then} | {now / then:.4f}{'' if row_holds else ' (does not hold)'} | {'yes' if now_hash == then_hash else 'NO'} |", flush=True)
    return holds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pellucid")
    parser.add_argument("--before")
    parser.add_argument("--only", nargs="*", help="names of effects; all by default")
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.pellucid).resolve())
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        holds = effects_table(program, folder, arguments.only)
        if arguments.before:
            holds &= before_table(program, str(pathlib.Path(arguments.before).resolve()), folder)
    sys.exit(0 if holds else 1)


main()
