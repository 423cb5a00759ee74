#!/usr/bin/env python3
"""Time, error and memory of pellucid and of VTK's fixed-point mapper, side by side in one run; writes RESULTS.md.

    python benches/peers.py             everything: about eight minutes on two cores
    python benches/peers.py --quick     two scenes, two rounds, no scaling; writes nothing unless told where

Needs a Python with `tests/vtk/requirements.txt` and the public scans (`--data`, PELLUCID_DATA or ../shared/data).
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from side_by_side import measure, report, scenes
from side_by_side.programs import Pellucid

ROOT = pathlib.Path(__file__).resolve().parent.parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="two scenes, two rounds, no scaling")
    parser.add_argument("--scenes", default="", metavar="WORD", help="only scenes whose name holds this, such as engine")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--size", type=int, default=512, help="pixels of the pictures' sides")
    parser.add_argument("--certify", type=int, default=20_000, help="pixels of each picture that the oracle recomputes")
    parser.add_argument("--edges", default="64,128,256,384,512,1024",
                        help="voxels of the synthetic head from ear to ear; those that fit into memory")
    parser.add_argument("--sizes", default="256,512,1024,2048", help="pixels of the picture's sides")
    parser.add_argument("--program", type=pathlib.Path, help="pellucid; built from this repository unless told")
    parser.add_argument("--data", type=pathlib.Path, help="the folder of public scans")
    parser.add_argument("--work", type=pathlib.Path, help="a folder for volumes and pictures that is kept")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="the report; benches/RESULTS.md unless --quick")
    return parser.parse_args()


def built():
    """The program, built as it is released."""
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target")
    subprocess.run(["cargo", "build", "--release", "--quiet"], cwd=ROOT, check=True)
    return target / "release" / "pellucid"


def say(what):
    print(what, file=sys.stderr, flush=True)


def run(options, work):
    """All measurements; gives facts about the run and one result per scene, lit and not."""
    begun = time.perf_counter()
    data = options.data or pathlib.Path(os.environ.get("PELLUCID_DATA") or ROOT.parent / "shared" / "data")
    pellucid = Pellucid(options.program or built(), work, options.threads, options.size)
    views = [scenes.VIEWS[0], scenes.VIEWS[3]] if options.quick else scenes.VIEWS
    views = [view for view in views if options.scenes in view.name]
    rounds = min(2, options.rounds) if options.quick else options.rounds
    sources = scenes.sources(data, work)
    volumes = {}
    head = scenes.VIEWS[0]
    for scan in {view.scan: None for view in [head, *views]}:
        say(f"{scan}: reading")
        volumes[scan] = scenes.Volume(pellucid, scan, sources[scan], work)
    results = []
    for lit in (False, True):
        for view in views:
            say(f"{view.name}{', lit' if lit else ''}: {rounds} rounds")
            results.append(measure.scene(pellucid, view, volumes[view.scan], work, lit, rounds, options.certify))
    facts = {
        "threads": options.threads, "rounds": rounds, "size": options.size,
        "pellucid": pellucid.version(), "vtk": results[0].vtk_version,
    }
    say("memory with a 2D transfer function")
    facts["memory_2d"] = measure.two_dimensional_memory(pellucid, head, volumes[head.scan], work)
    facts["memory_2d_raw"] = volumes[head.scan].raw_bytes
    say("cold start")
    series = sources["skull phantom"]
    facts["cold"] = measure.cold_start(pellucid, head, volumes[head.scan], series, work, rounds=3)
    if not options.quick:
        pipeline = scenes.pipeline(head, volumes[head.scan], work, lit=False)
        say("threads")
        facts["speedup"] = measure.threads(pellucid, pipeline, rounds)
        say("sizes of the picture")
        facts["sizes"] = measure.picture_sizes(pellucid, pipeline, numbers(options.sizes), 2)
        say("sizes of the volume")
        edges = [edge for edge in numbers(options.edges) if measure.fits_memory(edge)]
        facts["edges"] = measure.volume_edges(pellucid, work, edges, 2)
        # What growth is asked of.
        asked = [edge for edge in edges if 128 <= edge <= 512]
        if len(asked) > 1:
            facts["edge_exponent"] = {
                name: report.exponent({edge: by[edge] for edge in asked}) for name, by in facts["edges"].items()
            }
    facts["minutes"] = (time.perf_counter() - begun) / 60
    return facts, results


def numbers(text):
    return [int(number) for number in text.split(",")]


def main():
    options = arguments()
    with tempfile.TemporaryDirectory(prefix="pellucid-peers-") as temporary:
        work = options.work or pathlib.Path(temporary)
        work.mkdir(parents=True, exist_ok=True)
        text = report.markdown(*run(options, work.resolve()))
    print(text)
    output = options.output or (None if options.quick else ROOT / "benches" / "RESULTS.md")
    if output:
        output.write_text(text)
        say(f"written: {output}")


if __name__ == "__main__":
    main()
