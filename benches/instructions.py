#!/usr/bin/env python3
"""Instructions per sample of each kernel, as callgrind counts them: numbers that other load on the machine does not disturb.

    python benches/instructions.py PELLUCID [--before OTHER_PELLUCID] [--only WORD ...]

A pipeline is rendered on one thread at two sizes of picture; the difference in instructions over the difference in samples is the
cost of a sample (of `march`) or of an integrated piece of a ray (of `exact`), without loading, macrocells or tables. With
`--before` the same numbers of another program stand beside it, and the exit code is 1 if a kernel takes over 2 % more. Needs
valgrind, which runs AVX2 and no AVX-512.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SIZES = (24, 48)
WORSE = 1.02

METHODS = [("exact", "{ exact: { tolerance: 1/255 } }"), ("march", "{ march: { step_voxels: 1/2 } }")]
TWO_D = "transfer_function.0.widgets.0.gradient_weight=[[0, 0], [300, 1]]"
LIT = "effects.shading={}"
SCENES = [("1D, unlit", []), ("1D, lit", [LIT]), ("2D, unlit", [TWO_D]), ("2D, lit", [TWO_D, LIT])]


def counted(program, folder, size, changes):
    """Instructions and samples of a picture."""
    picture = folder / "picture.png"
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder / 'counts'}", program, "render"]
    command += [str(HERE / "head.yaml"), "--threads", "1", "-q", "-o", str(picture), "--size", f"{size}x{size}"]
    for change in ["volume.phantom.head.size=64", *changes]:
        command += ["--set", change]
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode != 0:
        raise SystemExit(ran.stderr)
    method = json.loads(pathlib.Path(f"{picture}.json").read_text())["method"]
    return int(re.search(r"Collected : (\d+)", ran.stderr).group(1)), method["samples"], method["kernel"]


def per_sample(program, folder, changes):
    """Instructions per sample, and the kernel's name."""
    (few, some, _), (many, more, kernel) = (counted(program, folder, size, changes) for size in SIZES)
    return (many - few) / (more - some), kernel


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="PELLUCID")
    parser.add_argument("--before", metavar="OTHER_PELLUCID")
    parser.add_argument("--only", nargs="*", default=[], metavar="WORD", help="rows that hold each of these, such as exact lit")
    options = parser.parse_args()
    print("| kernel | scene | instructions per sample |" + (" before | ratio |" if options.before else ""))
    print("|---|---|--:|" + ("--:|--:|" if options.before else ""))
    worse = False
    with tempfile.TemporaryDirectory() as folder:
        for method, integrate in METHODS:
            for scene, changes in SCENES:
                if not all(word in f"{method} {scene}".replace(",", "").split() for word in options.only):
                    continue
                changes = [f"integrate={integrate}", *changes]
                now, kernel = per_sample(options.program, pathlib.Path(folder), changes)
                row = f"| `{kernel}` | {method}, {scene} | {now:.0f} |"
                if options.before:
                    before, _ = per_sample(options.before, pathlib.Path(folder), changes)
                    worse |= now > WORSE * before
                    row += f" {before:.0f} | {now / before:.3f} |"
                print(row, flush=True)
    sys.exit(1 if worse else 0)


if __name__ == "__main__":
    main()
