"""What the scripts here share: scenes, pellucid's program, and VTK by way of the script that `pellucid export-vtk` writes.

Nothing of a pipeline is interpreted in Python: pellucid resolves it, and the exported script renders what it was given.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
REFERENCES = HERE / "references"
ROOT = HERE.parent.parent
MAPPERS = ("gpu", "cpu")
# What the exported script ends with where a mapper cannot draw a scene.
UNSUPPORTED = 3


class Scene:
    """A pipeline in `scenes/`, with its scan where that is on this machine."""

    def __init__(self, path):
        self.path = path
        self.name = path.stem
        text = path.read_text()
        self.about = text.splitlines()[0].lstrip("# ")
        self.lit = "shading:" in text
        scan = re.search(r"shared/data/([\w./-]+)", text)
        self.overrides, self.missing = [], False
        if scan:
            data = pathlib.Path(os.environ.get("PELLUCID_DATA") or ROOT.parent / "shared" / "data")
            source = data / scan[1]
            self.missing = not source.exists()
            self.overrides = ["--set", f"volume.source={source}"]


def scenes(names=()):
    """All scenes whose scans are here, or those of these names."""
    found = [Scene(path) for path in sorted((HERE / "scenes").glob("*.yaml"))]
    for scene in found:
        if scene.missing:
            print(f"skipped: {scene.name}: its scan is not on this machine", file=sys.stderr)
    return [scene for scene in found if not scene.missing and (not names or scene.name in names)]


class Pellucid:
    """The program."""

    def __init__(self, program):
        self.program = str(program)

    def run(self, *arguments, codes=(0,)):
        ran = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True)
        if ran.returncode not in codes:
            raise SystemExit(f"pellucid {' '.join(map(str, arguments))}\n{ran.stderr}")
        return ran

    def export(self, scene, folder, *overrides):
        self.run("export-vtk", scene.path, *scene.overrides, *overrides, "-o", folder)
        return json.loads((folder / "scene.json").read_text())

    def render(self, scene, integrate, output):
        override = ["--set", f"integrate={integrate}"] if integrate else []
        self.run("render", scene.path, *scene.overrides, *override, "-o", output, "-q")
        return output

    def compare(self, reference, test, *limits, overrides=()):
        """The comparison as JSON, and whether it is within the limits."""
        ran = self.run("compare", reference, test, *overrides, *limits, "--format", "json", codes=(0, 9))
        return json.loads(ran.stdout)["comparison"], ran.returncode == 0


def render_vtk(folder, mapper, output, *arguments, script="render.py"):
    """Runs the exported script in this Python; returns what it says of versions and settings, nothing if the mapper has no
    equal of the scene."""
    command = [sys.executable, folder / script, "--mapper", mapper, "--output", output, "--facts", *arguments]
    ran = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if ran.returncode == UNSUPPORTED:
        return None
    if ran.returncode != 0 or not output.exists():
        raise SystemExit(f"{folder.name}: VTK made no picture\n{ran.stderr}")
    return json.loads(ran.stdout.strip().splitlines()[-1])
