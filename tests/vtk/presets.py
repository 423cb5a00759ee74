#!/usr/bin/env python3
"""Imported presets against VTK with the original functions: Slicer's 22 CT presets.

    presets.py PELLUCID [NAME…]             fails where a picture is not VTK's within 1/255
    presets.py PELLUCID --table PRESETS.md  writes the table that is checked in, too

VTK is given the points of opacity, colour and gradient opacity as they are published (original.py), and a unit distance of 1 mm;
pellucid imports the same file and marches at the same step by VTK's conventions. Both pictures are linear numbers in floats.

On the head the two differ in places, and every ray is followed: VTK's shader, once more in numpy (rays.py), has to give VTK's picture
where it computes in f32 along VTK's rays, and pellucid's where it computes in f64 along exact ones. What lies between the two
emulations is VTK's rounding; with that taken away, VTK's picture has to be pellucid's within a step.
"""

import argparse
import json
import pathlib
import re
import tempfile
import xml.etree.ElementTree

import numpy as np

from bridge import HERE, ROOT, Pellucid, render_vtk
from rays import Shader, exact_rays, vtk_rays

FILE = ROOT / "tests/interchange/slicer/presets.xml"
SCRIPT = ROOT / "src/interchange/vtk/render.py"
BOUND = 1 / 255
# Largest difference, RMS, and pixels off by more than a step, that a picture may have, in steps of 1/255.
ON_WAVES = (1, 0.25, 0)
# Here VTK's rounding is seen where opacity is steep; PRESETS.md says how.
ON_HEAD = (10, 0.15, 16)
# With that rounding taken away.
UNROUNDED = (1, 0.05, 0)
# How far the shader in numpy may be from VTK's picture and from pellucid's, in steps of 1/255. Rays stop at an opacity of 1 - 1/255,
# and where rounding decides whether it is met, pellucid's take one sample more or less than in f64, which is worth up to a step.
EMULATED = (0.25, 1)
# Entries of both programs' tables, so that neither shows: the widest texture of OpenGL by llvmpipe.
ENTRIES = 16384
# Voxels along an axis of the waves.
N = 64


class Preset:
    """A published preset, as a pipeline and as what original.py reads."""

    def __init__(self, element):
        self.name = element.get("name")
        self.file = self.name.lower()
        self.published = {key: numbers(element.get(key)) for key in ("scalarOpacity", "gradientOpacity", "colorTransfer")}
        self.lit = element.get("shade") == "1"
        keys = {"ambient": "ambient", "diffuse": "diffuse", "specular": "specular", "specularPower": "shininess"}
        self.phong = {ours: float(element.get(theirs)) for theirs, ours in keys.items()}

    def table(self, value_range):
        """Opacities of 1 mm and colours of VTK's entries."""
        at = np.linspace(*value_range, ENTRIES)
        opacity = np.reshape(self.published["scalarOpacity"], (-1, 2)).T
        points, *colors = np.reshape(self.published["colorTransfer"], (-1, 4)).T
        return np.interp(at, *opacity), np.stack([np.interp(at, points, channel) for channel in colors], axis=-1)

    def pipeline(self, volume, zoom):
        pipeline = {
            "version": 1,
            "volume": volume,
            "transfer_function": [{"preset": f"./{self.file}.yaml"}],
            "camera": {"view": "anterior", "azimuth": 30, "elevation": 20, "zoom": zoom},
            "integrate": {"march": {"compatibility": "vtk", "table": {"values": ENTRIES}}},
            "image": {"size": [96, 96], "background": "transparent"},
        }
        if self.lit:
            pipeline["effects"] = {"shading": self.phong | {"soft_gradient_hu_per_mm": 0}}
        return json.dumps(pipeline)


def numbers(text):
    """A list of Slicer's: how many numbers, and these."""
    count, *values = map(float, text.split())
    assert len(values) == count, text
    return values


def waves(path):
    """Values from -1010 to 3050 HU that rise from front to back, nowhere flat and nowhere steep: what VTK's rounding of positions
    moves is little."""
    z, y, x = np.meshgrid(*[np.linspace(0, 1, N)] * 3, indexing="ij")
    values = -810 + 3660 * y + 200 * np.sin(7 * x + 2 * z)
    fields = f"type: float\ndimension: 3\nspace: LPS\nsizes: {N} {N} {N}\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
    header = f"NRRD0004\n{fields}kinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: (0,0,0)\n\n"
    path.write_bytes(header.encode() + values.astype("<f4").tobytes())
    return {"source": str(path), "values": "hu"}


class Comparison:
    """A preset on a volume: pellucid's picture of the import against VTK's of the original, in steps of 1/255."""

    def __init__(self, pellucid, folder, preset, volume, zoom):
        self.pellucid, self.preset = pellucid, preset
        # Beside the imports, by whose names the pipeline finds them.
        self.scene = folder / f"{preset.file}.pipeline.yaml"
        self.scene.write_text(preset.pipeline(volume, zoom))
        self.exported = folder / f"{preset.file}.vtk"
        pellucid.run("export-vtk", self.scene, "-o", self.exported)
        script, given = SCRIPT.read_text(), "    transfer_function(appearance, value_range, step_mm)\n"
        assert script.count(given) == 1, "where the script gives VTK its functions"
        replaced = script.replace(given, "    __import__('original').give(appearance, value_range)\n")
        (self.exported / "render.py").write_text(replaced)
        (self.exported / "original.py").write_text((HERE / "original.py").read_text())

    def run(self, entries=ENTRIES):
        """Largest and RMS difference, and how many pixels are off by more than one step. VTK's tables are at least so many entries
        wide."""
        (self.exported / "original.json").write_text(json.dumps(self.preset.published | {"entries": entries}))
        output = self.exported / f"{entries}.npy"
        render_vtk(self.exported, "gpu", output)
        return self.from_pellucid(output)

    def from_pellucid(self, picture):
        """Largest and RMS difference of a picture from pellucid's, and how many pixels are off by more than one step."""
        found, _ = self.pellucid.compare(picture, self.scene, "--tolerance", BOUND)
        return 255 * found["max_abs_all"], 255 * found["rms_all"], found["pixels_over"]

    def rays(self):
        """Pixels in which there are rays, and these, exactly and as VTK has them: the same for all presets on a volume."""
        pixels, rays = vtk_rays(self.exported)
        described, values = self.scene_and_values()
        return pixels, exact_rays(described, np.array(values.shape[::-1]), pixels), rays

    def followed(self, pixels, exact_rays, rays):
        """Where both pictures come from, by VTK's shader in numpy for every ray: how far it is at most from VTK's picture and from
        pellucid's, how many pixels rounding moves by more than one step, and how VTK's picture without what rounding does differs
        from pellucid's, as `run` tells it."""
        described, values = self.scene_and_values()
        shader = Shader(described, values, *self.preset.table((values.min(), values.max())))
        as_vtk, exact = shader.march(rays, np.float32), shader.march(exact_rays, np.float64)
        vtk = np.load(self.exported / f"{ENTRIES}.npy")
        from_vtk = 255 * np.abs(placed(as_vtk, pixels, vtk.shape) - vtk).max()
        pictures = placed(exact, pixels, vtk.shape), vtk - placed(as_vtk - exact, pixels, vtk.shape)
        emulated, unrounded = map(self.against, ("emulated", "unrounded"), pictures)
        return from_vtk, emulated[0], over(as_vtk, exact), unrounded

    def against(self, name, picture):
        """A picture, kept by a name, against pellucid's: see `from_pellucid`."""
        np.save(self.exported / f"{name}.npy", picture)
        return self.from_pellucid(self.exported / f"{name}.npy")

    def scene_and_values(self):
        return json.loads((self.exported / "scene.json").read_text()), np.load(self.exported / "volume.npy")


def placed(colors, pixels, shape):
    """A picture of these pixels and nothing else, f32."""
    picture = np.zeros(shape, np.float32)
    picture[*pixels.T] = colors
    return picture


def over(a, b):
    """How many pixels differ by more than a step."""
    return int((np.abs(a.astype(np.float64) - b).max(-1) > BOUND).sum())


class Rows:
    """One line per preset, for the terminal and for the table."""

    def __init__(self, pellucid, folder):
        self.pellucid, self.folder, self.points = pellucid, folder, {}
        listed = pellucid.run("presets", "import", FILE, "--colors", "light", "--max-deviation", "0.0001", "-o", folder).stderr
        for name, count in re.findall(r"^(\S+): (\d+) points", listed, re.M):
            self.points[name] = int(count)
        self.rays_of_head = None
        # So near that no ray grazes an edge of the waves.
        self.waves = (waves(folder / "waves.nrrd"), 2.2)
        self.head = ({"phantom": {"head": {"size": 56}}}, 1)

    def of(self, preset):
        on_waves = Comparison(self.pellucid, self.folder, preset, *self.waves).run()
        comparison = Comparison(self.pellucid, self.folder, preset, *self.head)
        on_head = comparison.run()
        self.rays_of_head = self.rays_of_head or comparison.rays()
        return on_waves, on_head, comparison.followed(*self.rays_of_head)


def row(preset, points, on_waves, on_head, followed):
    lit = "yes" if preset.lit else "no"
    cells = [preset.name, lit, points, f"{on_waves[0]:.2f} / {on_waves[1]:.3f}", f"{on_head[0]:.2f} / {on_head[1]:.3f}", on_head[2]]
    from_vtk, from_pellucid, rounded, unrounded = followed
    cells += [rounded, f"{unrounded[0]:.2f} / {unrounded[1]:.3f}", f"{from_vtk:.3f}", f"{from_pellucid:.3f}"]
    return "| " + " | ".join(map(str, cells)) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pellucid", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--table", type=pathlib.Path)
    arguments = parser.parse_intermixed_args()
    lines, failures = [], []
    with tempfile.TemporaryDirectory() as folder:
        rows = Rows(Pellucid(arguments.pellucid), pathlib.Path(folder))
        for preset in map(Preset, xml.etree.ElementTree.parse(FILE).getroot()):
            if arguments.names and preset.name not in arguments.names:
                continue
            found = rows.of(preset)
            lines.append(row(preset, rows.points[preset.file], *found))
            print(lines[-1], flush=True)
            pictures = zip(("waves", "head", "head without VTK's rounding"), (ON_WAVES, ON_HEAD, UNROUNDED), (*found[:2], found[2][3]))
            for where, limits, (largest, rms, over) in pictures:
                if not (largest <= limits[0] and rms <= limits[1] and over <= limits[2]):
                    failures.append(f"{preset.name} on the {where}: {largest:.3f}/255, RMS {rms:.3f}/255, {over} pixels over 1/255")
            for whose, off, limit in zip(("VTK's", "pellucid's"), found[2], EMULATED):
                if not off <= limit:
                    failures.append(f"{preset.name} on the head: {whose} picture is {off:.3f}/255 from its shader in numpy")
    if arguments.table:
        arguments.table.write_text((HERE / "presets-head.md").read_text() + "\n".join(lines) + "\n")
    for failure in failures:
        print("FAILED", failure)
    if failures or not lines:
        raise SystemExit(f"{len(failures)} pictures of {len(lines)} presets are not VTK's")
    print(f"{len(lines)} presets: pictures of the imports are VTK's of the originals")


main()
