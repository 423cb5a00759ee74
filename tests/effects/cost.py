#!/usr/bin/env python3
"""What effects cost a scene that does not ask for them: nothing, to the bit and to the instruction.

    cost.py PELLUCID [--before OLDER] [--only EFFECT …] [--out FILE] [--jobs N]

The first table has one row for each effect: whether a pipeline that names it with a strength of 0 gives the same pixels as
one that does not name it, whether one with some strength gives others (or the row would say nothing), and the instructions
of the first over those of the second, as callgrind counts them. With `--before`, a program built before the effects existed,
a second table has the instructions of pipelines without effects by this program over those by that one. Both must be built
alike and whole, with `CARGO_INCREMENTAL=0 cargo build --release`: an incremental build inlines less.

Instructions are counted twice. *Rendering* is what a picture takes beyond one of a single pixel: rays, and what becomes of
each pixel. The *whole run* is that and what both have: starting, reading the scan and its hash, planning, and what a frame
sets up once (gradients at the voxels, blocks of cells). Both must be within the limit; less is welcome. A mask of labels that
are all shown is read to find that out, which counts as reading: there, rendering alone must be.

Prints Markdown, which `--out` writes to a file too. Exits 1 if a row does not hold. Needs valgrind.
"""

import argparse
import concurrent.futures
import functools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SIZE = 96
LIMIT = 0.01
# Voxels from ear to ear: small where there are many rows.
HEAD, SMALL_HEAD = 96, 48

# Name, what is written under `effects:` with a strength of 0, and with some; `lit` if a pipeline then needs a light, `reads`
# if it reads a file more.
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
    ("mask", "mask: { source: labels.seg.nrrd, labels: { skull: show } }", "mask: { source: labels.seg.nrrd, labels: { skull: hide } }", "reads"),
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



INTRODUCTION = f"""
Made by `tests/effects/cost.py PELLUCID --before OLDER --out tests/effects/RESULTS.md`: instructions as callgrind counts them, on
one thread, pictures of {SIZE} × {SIZE} pixels of the synthetic head, {SMALL_HEAD} voxels from ear to ear above and {HEAD} below. *Rendering* is
what a picture takes beyond one of a single pixel, the *whole run* that and what both have: starting, reading, planning, and what
is set up once. A row holds if pictures are the same to the bit and neither ratio is off by {LIMIT:.0%} (below: more by {LIMIT:.0%}). A mask
is read even if all its labels turn out to be shown, so that a wrong one is refused: its row's whole run has the label volume in
it, its rendering nothing. Most kernels have moved to registers since there were no effects; what that saves is in the second table,
too, but for values and surfaces, which are computed as they were; and it made other roundings, so that pictures are not always the
same to the bit.
""".strip().splitlines()


class Run:
    """Runs of one program in a folder of its own."""

    def __init__(self, program, folder):
        self.program, self.folder = str(pathlib.Path(program).resolve()), pathlib.Path(folder)

    def head(self, size, labels=False):
        """Makes `head.nrrd`, and `labels.seg.nrrd` where they are wanted."""
        made = [["--nrrd", "head.nrrd"]] + ([["--labels", "labels.seg.nrrd"]] if labels else [])
        for what in made:
            command = [self.program, "-q", "phantom", "head", "--size", str(size)] + what
            subprocess.run(command, check=True, capture_output=True, cwd=self.folder)

    @functools.cache
    def pixels(self, scene):
        """The hash of a picture's pixels."""
        return self._picture(scene, SIZE, counted=False)[0]

    @functools.cache
    def instructions(self, scene):
        """A picture's instructions on one thread: rendering, and the whole run."""
        whole, once = (self._picture(scene, size, counted=True)[1] for size in (SIZE, 1))
        return whole - once, whole

    def _picture(self, scene, size, counted):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml", dir=self.folder, delete=False) as file:
            file.write(f"{scene}image: {{ size: [{size}, {size}], background: gray }}\n")
        picture, counts = f"{file.name}.png", f"{file.name}.callgrind"
        valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}"] if counted else []
        command = valgrind + [self.program, "--threads", "1", "-q", "render", file.name, "-o", picture]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"{scene}\n{run.stderr}")
        sidecar = json.loads(pathlib.Path(f"{picture}.json").read_text())
        collected = int(re.search(r"Collected : (\d+)", run.stderr).group(1)) if counted else None
        return sidecar["picture"]["pixels_sha256"], collected


def scene(function, effects, method):
    function = f"transfer_function: {function}\n" if function else ""
    return f"version: 1\nvolume: {{ source: head.nrrd }}\n{function}{effects}\nintegrate: {method}\n"


def effect_row(run, name, none, some, needs, method, integrate):
    lit = "  shading: { lights: [{ directional: { towards: [1, -2, 1] } }] }\n" if needs == "lit" else ""

    def of(effect):
        return scene(TWO_D, f"effects:\n{lit}  {effect}\n" if lit or effect else "", integrate)

    unnamed, zero = of(""), of(none)
    same, other = run.pixels(zero) == run.pixels(unnamed), run.pixels(of(some)) != run.pixels(unnamed)
    rendering, whole = (now / then for now, then in zip(run.instructions(zero), run.instructions(unnamed)))
    costs_nothing = [within(rendering), needs == "reads" or within(whole)]
    cells = [name, method, word(same), word(other), number(rendering, costs_nothing[0]), number(whole, costs_nothing[1])]
    return cells, same and other and all(costs_nothing)


def before_row(run, before, name, function, effects, method):
    plain = scene(function, effects, method)
    same = run.pixels(plain) == before.pixels(plain)
    (now, now_whole), (then, then_whole) = run.instructions(plain), before.instructions(plain)
    rendering, whole = now / then, now_whole / then_whole
    # What takes less than it did is welcome.
    holds = [ratio < 1 + LIMIT for ratio in (rendering, whole)]
    counts = [f"{count / 1e6:.1f}" for count in (now, then)]
    picture = "to the bit" if same else "to rounding"
    return [name, picture, *counts, number(rendering, holds[0]), number(whole, holds[1])], all(holds)


def within(ratio):
    return abs(ratio - 1) < LIMIT


def word(holds):
    return "yes" if holds else "**no**"


def number(ratio, holds):
    return f"{ratio:.4f}" if holds else f"**{ratio:.4f}**"


def table(title, head, row, rows, jobs):
    """The lines of a table whose rows are made `jobs` at a time, and whether all of them hold."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        made = list(pool.map(lambda arguments: row(*arguments), rows))
    lines = [f"## {title}", "", *("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head)])]
    lines += ["| " + " | ".join(cells) + " |" for cells, _ in made]
    return lines, all(holds for _, holds in made)


def effects_table(run, only, jobs):
    run.head(SMALL_HEAD, labels=True)
    head = ["effect", "method", "strength 0 is the same picture", "some strength is another", "rendering", "whole run"]
    named = [effect for effect in EFFECTS if only is None or effect[0] in only]
    rows = [(run, *effect, *method) for effect in named for method in METHODS]
    return table("Strength 0 over not named", head, effect_row, rows, jobs)


def before_table(run, before, jobs):
    run.head(HEAD)
    # Both read the same scan, whatever the older one's phantom was.
    shutil.copy(run.folder / "head.nrrd", before.folder)
    head = ["pipeline without effects", "same picture", "rendering now, 10⁶", "before", "ratio", "whole run, ratio"]
    return table("Now over before there were effects", head, before_row, [(run, before, *plain) for plain in PLAIN], jobs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pellucid")
    parser.add_argument("--before", metavar="OLDER", help="a program from before the effects")
    parser.add_argument("--only", nargs="*", metavar="EFFECT", help="names of effects; all by default")
    parser.add_argument("--out", metavar="FILE", help="write the tables to a file too")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="pictures at once; all cores by default")
    arguments = parser.parse_args()
    lines = ["# What effects cost a scene that does not ask for them", "", *INTRODUCTION, ""]
    with tempfile.TemporaryDirectory() as small, tempfile.TemporaryDirectory() as now, tempfile.TemporaryDirectory() as then:
        of_effects, holds = effects_table(Run(arguments.pellucid, small), arguments.only, arguments.jobs)
        lines += of_effects
        if arguments.before:
            programs = Run(arguments.pellucid, now), Run(arguments.before, then)
            of_plain, plain_holds = before_table(*programs, arguments.jobs)
            lines += ["", *of_plain]
            holds &= plain_holds
    text = "\n".join([*lines, "", "Every row holds." if holds else "Rows with a **bold** entry do not hold."]) + "\n"
    print(text, end="")
    if arguments.out:
        pathlib.Path(arguments.out).write_text(text)
    sys.exit(0 if holds else 1)


main()
