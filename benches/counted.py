"""Scenes rendered under valgrind on one thread, and tables of what it counts: what both `instructions.py` and `traffic.py` do."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

PIPELINE = pathlib.Path(__file__).resolve().parent / "head.yaml"

METHODS = [("exact", "{ exact: { tolerance: 1/255 } }"), ("march", "{ march: { step_voxels: 1/2 } }")]
TWO_D = "transfer_function.0.widgets.0.gradient_weight=[[0, 0], [300, 1]]"
LIT = "effects.shading={}"
SCENES = [("1D, unlit", []), ("1D, lit", [LIT]), ("2D, unlit", [TWO_D]), ("2D, lit", [TWO_D, LIT])]


def rendered(tool, program, folder, size, changes):
    """What valgrind reports of a picture, and how the sidecar says that it was made."""
    picture = folder / "picture.png"
    command = ["valgrind", *tool, program, "render", str(PIPELINE), "--threads", "1", "-q"]
    command += ["-o", str(picture), "--size", f"{size}x{size}"]
    for change in changes:
        command += ["--set", change]
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode != 0:
        raise SystemExit(ran.stderr)
    return ran.stderr, json.loads(pathlib.Path(f"{picture}.json").read_text())["method"]


def report(description, columns, measure, worse_above, prepare=lambda program, folder: []):
    """Prints a table: `measure(program, folder, changes)` gives the kernel's name and a number per column. Exits with 1 if one of
    them is over `worse_above` times that of the program `--before`. `prepare` makes what is rendered, and says how the
    pipeline names it."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="PELLUCID")
    parser.add_argument("--before", metavar="OTHER_PELLUCID")
    parser.add_argument("--only", nargs="*", default=[], metavar="WORD", help="rows that hold each of these, such as exact lit")
    options = parser.parse_args()
    heads = ["kernel", "scene"]
    for column in columns:
        heads += [column, "before", "ratio"] if options.before else [column]
    print("| " + " | ".join(heads) + " |")
    print("|---|---|" + "--:|" * (len(heads) - 2))
    worse = False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        always = prepare(options.program, folder)
        for method, integrate in METHODS:
            for scene, own in SCENES:
                if not all(word in f"{method} {scene}".replace(",", "").split() for word in options.only):
                    continue
                changes = [*always, f"integrate={integrate}", *own]
                kernel, found = measure(options.program, folder, changes)
                before = measure(options.before, folder, changes)[1] if options.before else found
                cells = [f"`{kernel}`", f"{method}, {scene}"]
                for now, then in zip(found, before):
                    cells.append(f"{now:.0f}")
                    if options.before:
                        worse |= now > worse_above * then
                        cells += [f"{then:.0f}", f"{now / then:.3f}"]
                print("| " + " | ".join(cells) + " |", flush=True)
    sys.exit(1 if worse else 0)
