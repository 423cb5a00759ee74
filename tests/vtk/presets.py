#!/usr/bin/env python3
"""Imported presets against VTK with the original functions: Slicer's 22 CT presets, each on the head phantom.

    presets.py PELLUCID                     fails where a picture is not VTK's within 1/255
    presets.py PELLUCID --table PRESETS.md  writes the table that is checked in, too

VTK is given the points of opacity, colour and gradient opacity as they are published (original.py), and the unit distance 1 mm;
pellucid imports the same file and marches at the same step by VTK's conventions. Both pictures are linear numbers in floats.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import numpy as np

from bridge import ROOT, Pellucid, render_vtk

FILE = ROOT / "tests/interchange/slicer/presets.xml"
HERE = pathlib.Path(__file__).resolve().parent
# What each picture is held to, largest difference of any channel of any pixel.
BOUND = 1 / 255
# Entries of both programs' tables, so that neither shows: the widest texture of OpenGL by llvmpipe.
ENTRIES = 16384
# Values of a volume, and how steep they are: the phantom, and one in which a voxel's rounding is no part of a jump.
STEP_VOXELS = 0.5


class Preset:
    """A published preset, as a pipeline and as what original.py reads."""

    def __init__(self, element):
        self.name = element.get("name")
        self.file = self.name.lower()
        self.published = {key: numbers(element.get(key)) for key in ("scalarOpacity", "gradientOpacity", "colorTransfer")}
        self.lit = element.get("shade") == "1"
        self.phong = {key: float(element.get(key)) for key in ("ambient", "diffuse", "specular", "specularPower")}

    def pipeline(self, source):
        pipeline = {
            "version": 1,
            "volume": source,
            "transfer_function": [{"preset": f"./{self.file}.yaml"}],
            "camera": {"view": "anterior", "azimuth": 30, "elevation": 20},
            "integrate": {"march": {"compatibility": "vtk", "step_voxels": STEP_VOXELS, "table": {"values": ENTRIES}}},
            "image": {"size": [96, 96], "background": "transparent"},
        }
        if self.lit:
            phong = dict(zip(("ambient", "diffuse", "specular", "shininess"), self.phong.values()))
            pipeline["effects"] = {"shading": phong | {"soft_gradient_hu_per_mm": 0}}
        return json.dumps(pipeline)


def numbers(text):
    """A list of Slicer's: its length, then so many numbers."""
    count, *values = map(float, text.split())
    assert len(values) == count, text
    return values


def presets():
    return [Preset(element) for element in xml.etree.ElementTree.parse(FILE).getroot()]


class Comparison:
    """One preset on one volume: pellucid's picture of the import, and VTK's of the original."""

    def __init__(self, pellucid, preset, folder, source):
        self.pellucid, self.preset, self.folder = pellucid, preset, folder
        self.scene = folder / f"{preset.file}.pipeline.yaml"
        self.scene.write_text(preset.pipeline(source))
        self.exported = folder / f"{preset.file}.vtk"
        pellucid.run("export-vtk", self.scene, "-o", self.exported)

    def vtk(self, entries):
        """VTK's picture with the published functions, its tables at least so many entries wide."""
        script = (HERE.parent.parent / "src/interchange/vtk/render.py").read_text()
        given = "    transfer_function(appearance, value_range)\n"
        assert script.count(given) == 1, "where the script gives VTK its functions"
        (self.exported / "render.py").write_text(script.replace(given, "    __import__('original').give(appearance, value_range)\n"))
        (self.exported / "original.py").write_text((HERE / "original.py").read_text())
        (self.exported / "original.json").write_text(json.dumps(self.preset.published | {"entries": entries}))
        output = self.exported / f"{entries}.npy"
        render_vtk(self.exported, "gpu", output)
        return self.pellucid.compare(output, self.scene, "--tolerance", BOUND)


def largest(a, b):
    return 255 * float(np.abs(a.astype(np.float64) - b.astype(np.float64)).max())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pellucid", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--table", type=pathlib.Path)
    arguments = parser.parse_intermixed_args()
    pellucid = Pellucid(arguments.pellucid)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        pellucid.run("presets", "import", FILE, "--colors", "light", "-o", folder)
        for preset in presets():
            if arguments.names and preset.name not in arguments.names:
                continue
            comparison = Comparison(pellucid, preset, folder, {"phantom": {"head": {"size": 56}}})
            print(preset.name, *comparison.vtk(ENTRIES), comparison.vtk(0)[0]["max_abs_all"]*255)


main()
