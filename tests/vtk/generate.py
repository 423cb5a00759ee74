#!/usr/bin/env python3
"""VTK's pictures of the scenes in `scenes/`, as references for `cargo test`, which needs neither Python nor VTK.

    generate.py PELLUCID            writes references/
    generate.py PELLUCID --check    renders them anew, and fails if VTK's pictures moved or pellucid's are not VTK's

A reference is a PNG of 16 bits, sRGB, straight alpha: it holds linear light to 2e-5, a two-hundredth of a step of 8 bits.
references/facts.json has versions, settings and the hash of each picture.
"""

import argparse
import hashlib
import json
import pathlib
import struct
import tempfile
import zlib

import numpy as np

from bridge import MAPPERS, REFERENCES, Pellucid, render_vtk, scenes

# How far a picture may move between machines with one version of VTK: its OpenGL is compiled for the processor.
MOVED = 0.1 / 255
# What pellucid's march with VTK's conventions is held to, against the GPU mapper.
UNLIT = ("--tolerance", "2/255", "--rms-tolerance", "0.5/255")
LIT = ("--tolerance", "4/255", "--share", "0.001", "--rms-tolerance", "1/255")
# Scenes that VTK's rounding moves further; conventions.py shows it ray by ray.
ROUNDED = {
    "head-thin-shells": ("--tolerance", "6/255", "--rms-tolerance", "0.5/255"),
    "head-fine": ("--tolerance", "3/255", "--rms-tolerance", "0.5/255"),
}


def levels(picture):
    """Linear premultiplied pixels as sRGB with straight alpha, 16 bits."""
    picture = picture.astype(np.float64)
    alpha = picture[..., 3:]
    linear = np.clip(np.divide(picture[..., :3], alpha, out=np.zeros_like(picture[..., :3]), where=alpha > 0), 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    return np.rint(np.concatenate([encoded, np.clip(alpha, 0, 1)], axis=-1) * 65535).astype(">u2")


def write_png(path, pixels):
    height, width, _ = pixels.shape

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    # Each row as the difference to the row above (filter 2), which compresses best here.
    rows = pixels.view(np.uint8).reshape(height, -1)
    above = np.vstack([np.zeros_like(rows[:1]), rows[:-1]])
    filtered = np.hstack([np.full((height, 1), 2, np.uint8), rows - above])
    header = struct.pack(">IIBBBBB", width, height, 16, 6, 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"sRGB", b"\0")
        + chunk(b"IDAT", zlib.compress(filtered.tobytes(), 9))
        + chunk(b"IEND", b"")
    )


def pictures(pellucid, names):
    """Per scene and mapper: scene, mapper, VTK's picture as .npy, and facts."""
    for scene in scenes(names):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            pellucid.export(scene, folder)
            for mapper in MAPPERS:
                live = folder / f"{mapper}.npy"
                facts = render_vtk(folder, mapper, live)
                if facts is not None:
                    yield scene, mapper, live, facts


def generate(pellucid, names):
    facts_path = REFERENCES / "facts.json"
    REFERENCES.mkdir(exist_ok=True)
    facts_of = json.loads(facts_path.read_text()) if names and facts_path.exists() else {}
    for scene, mapper, live, facts in pictures(pellucid, names):
        pixels = levels(np.load(live))
        name = f"{scene.name}.{mapper}"
        write_png(REFERENCES / f"{name}.png", pixels)
        facts_of[name] = facts | {"pixels_sha256": hashlib.sha256(pixels.tobytes()).hexdigest()}
        print(name)
    facts_path.write_text(json.dumps(facts_of, indent=1, sort_keys=True) + "\n")


def check(pellucid, names):
    failures, count = [], 0
    recorded = json.loads((REFERENCES / "facts.json").read_text())
    missing = {f"{scene.name}.{mapper}" for scene in scenes(names) for mapper in MAPPERS} & set(recorded)
    for scene, mapper, live, facts in pictures(pellucid, names):
        name = f"{scene.name}.{mapper}"
        count += 1
        if name not in recorded:
            failures.append(f"{name}: has no reference yet; generate.py makes it")
            continue
        missing.remove(name)
        if facts["vtk"] != recorded[name]["vtk"]:
            failures.append(f"{name}: VTK is {facts['vtk']}, the reference is of {recorded[name]['vtk']}")
        moved, same = pellucid.compare(REFERENCES / f"{name}.png", live, "--tolerance", MOVED)
        if not same:
            failures.append(f"{name}: VTK's picture moved by {moved['max_abs_all'] * 255:.3f}/255")
        if mapper == "gpu":
            limits = ROUNDED.get(scene.name, LIT if scene.lit else UNLIT)
            found, within = pellucid.compare(live, scene.path, *limits, overrides=scene.overrides)
            text = f"max {found['max_abs_all'] * 255:.4f}/255, RMS {found['rms_all'] * 255:.4f}/255"
            print(f"{name}: {text}")
            if not within:
                failures.append(f"{name}: pellucid is not as VTK: {text}")
    failures += [f"{name}: VTK no longer draws it" for name in sorted(missing)]
    for failure in failures:
        print("FAILED", failure)
    if failures or not count:
        raise SystemExit(f"{len(failures)} of {count} pictures failed")
    print(f"{count} pictures: VTK has not moved, and pellucid with its conventions is as the GPU mapper")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pellucid", type=pathlib.Path)
    parser.add_argument("names", nargs="*", help="scenes; all unless told")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_intermixed_args()
    (check if arguments.check else generate)(Pellucid(arguments.pellucid), arguments.names)


main()
