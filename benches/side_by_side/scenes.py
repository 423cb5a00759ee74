"""Five views of public scans, as pipelines that pellucid reads and from which it writes the same scenes for VTK.

A transfer function is extinction per mm and linear colour at points, linear in between (colour weighted by extinction). VTK is given
that same function, tabulated at 4096 values by `pellucid export-vtk`, as opacities of 1 mm: both programs are asked for one
integral, and a dense table costs VTK nothing per frame.
"""

import math
import pathlib
import tarfile
from dataclasses import dataclass

import numpy as np

# Light of the lit scenes, from the eye.
SHADING = "{ ambient: 0.1, diffuse: 0.7, specular: 0.2, shininess: 10, soft_gradient_hu_per_mm: 0 }"

# value, linear red, green, blue, opacity of 1 mm
FUNCTIONS = {
    "bone": [(-1024, 0.9, 0.75, 0.6, 0), (200, 0.9, 0.75, 0.6, 0), (300, 0.92, 0.8, 0.65, 0.08),
             (500, 0.95, 0.88, 0.75, 0.5), (1000, 1, 0.97, 0.9, 0.85), (3000, 1, 1, 1, 0.9)],
    "skin": [(-1024, 0.8, 0.5, 0.4, 0), (-600, 0.85, 0.55, 0.42, 0), (-300, 0.87, 0.6, 0.48, 0.06),
             (-50, 0.85, 0.5, 0.4, 0.05), (20, 0.8, 0.3, 0.25, 0.006), (150, 0.9, 0.6, 0.5, 0.01),
             (250, 0.95, 0.85, 0.7, 0.08), (500, 1, 0.95, 0.85, 0.6), (1000, 1, 1, 0.95, 0.85), (3000, 1, 1, 1, 0.9)],
    "muscle": [(-1200, 0.6, 0.1, 0.1, 0), (-20, 0.6, 0.15, 0.1, 0), (30, 0.7, 0.2, 0.15, 0.04),
               (80, 0.9, 0.35, 0.25, 0.2), (140, 0.95, 0.5, 0.35, 0.12), (220, 0.95, 0.85, 0.7, 0.25),
               (500, 1, 0.95, 0.85, 0.7), (3400, 1, 1, 1, 0.9)],
    "engine": [(0, 0, 0, 0, 0), (60, 0.3, 0.4, 0.7, 0), (90, 0.5, 0.6, 0.8, 0.02), (140, 0.7, 0.7, 0.75, 0.03),
               (170, 0.9, 0.8, 0.4, 0.08), (220, 1, 0.5, 0.2, 0.6), (255, 1, 0.4, 0.1, 0.8)],
    "bonsai": [(0, 0, 0, 0, 0), (25, 0.2, 0.4, 0.1, 0), (40, 0.25, 0.6, 0.2, 0.06), (60, 0.3, 0.7, 0.2, 0.1),
               (90, 0.5, 0.6, 0.3, 0.05), (130, 0.6, 0.35, 0.15, 0.3), (180, 0.7, 0.45, 0.25, 0.5),
               (255, 0.95, 0.9, 0.8, 0.8)],
}


@dataclass(frozen=True)
class View:
    """A scan, how it is classified, and from where it is seen."""

    scan: str
    function: str
    towards_eye: tuple
    up: tuple
    # How far the corners of the volume may stand out of the picture; 1 shows all of it.
    overfill: float

    @property
    def name(self):
        return f"{self.scan}, {self.function}" if self.scan != self.function else self.scan

    @property
    def stem(self):
        return f"{self.scan}-{self.function}"


VIEWS = [
    View("skull phantom", "bone", (-0.55, -0.80, 0.30), (0, 0, 1), 1.65),
    View("skull phantom", "skin", (-0.55, -0.80, 0.30), (0, 0, 1), 1.65),
    View("abdomen", "muscle", (-0.50, -0.80, 0.35), (0, 0, 1), 1.35),
    View("engine", "engine", (-0.60, -0.50, 0.65), (0, 0, 1), 1.45),
    View("bonsai", "bonsai", (-0.60, -0.75, -0.35), (0, 0, -1), 1.3),
]

ARBITRARY = {"engine", "bonsai"}


def skull_folder(data, work):
    """The DICOM series of the skull phantom, unpacked once."""
    folder = work / "S2020"
    if not folder.exists():
        with tarfile.open(data / "skull-phantom-dicom.tar.xz") as archive:
            archive.extractall(work, filter="data")
    return folder


def sources(data, work):
    """Where each scan lies."""
    files = {"abdomen": "abdomen/ct.nrrd", "engine": "engine.nrrd", "bonsai": "bonsai.nrrd"}
    return {"skull phantom": skull_folder(data, work), **{name: data / file for name, file in files.items()}}


class Volume:
    """A scan as 16-bit samples along the patient's axes, first voxel at the origin: a file that costs no decoding."""

    def __init__(self, pellucid, scan, source, work):
        self.path = work / f"{scan.replace(' ', '-')}.nrrd"
        exported = work / "export"
        arbitrary = ", values: arbitrary" if scan in ARBITRARY else ""
        pipeline = work / "scan.yaml"
        text = f"version: 1\nvolume: {{ source: {source}{arbitrary} }}\ntransfer_function: [{{ widgets: [{{ points: "
        text += "[{ hu: 0, opacity_per_mm: 0, color: white }, { hu: 9, opacity_per_mm: 0, color: white }] }] }]\n"
        pipeline.write_text(text)
        scene = pellucid.export(pipeline, exported)
        values = np.load(exported / "volume.npy")
        samples = values.astype(np.int16)
        assert (samples == values).all(), f"{scan}: samples are not 16-bit integers"
        motion = np.array(scene["motion"])[:, :3]
        assert np.array_equal(np.abs(motion).round(6), np.eye(3)), f"{scan}: turned against the patient's axes"
        mirrored = [slice(None, None, -1 if motion[axis, axis] < 0 else 1) for axis in (2, 1, 0)]
        self.write(np.ascontiguousarray(samples[tuple(mirrored)]), scene["spacing_mm"])

    def write(self, samples, spacing_mm):
        self.dims, self.spacing_mm = samples.shape[::-1], spacing_mm
        self.range = (int(samples.min()), int(samples.max()))
        self.raw_bytes = samples.nbytes
        directions = " ".join(
            "(" + ",".join(repr(float(s)) if i == j else "0" for j in range(3)) + ")" for i, s in enumerate(spacing_mm)
        )
        header = (
            "NRRD0005\ntype: int16\ndimension: 3\nspace: left-posterior-superior\n"
            f"sizes: {' '.join(map(str, self.dims))}\nspace directions: {directions}\nspace origin: (0,0,0)\n"
            "kinds: domain domain domain\nendian: little\nencoding: raw\n\n"
        )
        with open(self.path, "wb") as file:
            file.write(header.encode())
            file.write(samples.tobytes())


def camera(view, volume, fov_degrees=30.0):
    """Eye and target so that the corners stand out of the picture by no more than the view allows."""
    extent = np.array([(n - 1) * s for n, s in zip(volume.dims, volume.spacing_mm)])
    backward = np.array(view.towards_eye) / np.linalg.norm(view.towards_eye)
    right = np.cross(view.up, backward)
    right /= np.linalg.norm(right)
    upward = np.cross(backward, right)
    slope = math.tan(math.radians(fov_degrees) / 2) * view.overfill
    corners = [extent * (x, y, z) - extent / 2 for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    distance = max(max(abs(p @ right), abs(p @ upward)) / slope + p @ backward for p in corners)
    eye = extent / 2 + backward * distance
    return [round(float(x), 6) for x in eye], [round(float(x), 6) for x in extent / 2], fov_degrees


def points(function):
    """The transfer function in YAML."""
    rows = []
    for value, red, green, blue, opacity in FUNCTIONS[function]:
        extinction = -math.log1p(-opacity)
        rows.append(f"{{ hu: {value}, extinction_per_mm: {extinction:.9g}, color: [{red}, {green}, {blue}] }}")
    return "\n".join(f"        - {row}" for row in rows)


def pipeline(view, volume, folder, lit, two_d=False):
    """Writes the pipeline of a view, and returns its path."""
    eye, target, fov_degrees = camera(view, volume)
    weight = "\n      gradient_weight: [[0, 0], [300, 1]]" if two_d else ""
    shading = f"effects: {{ shading: {SHADING} }}\n" if lit else ""
    arbitrary = ", values: arbitrary" if view.scan in ARBITRARY else ""
    window = "normalise: { hu: [0, 255] }\n" if view.scan in ARBITRARY else ""
    path = folder / f"{view.stem.replace(' ', '-')}{'-lit' if lit else ''}{'-2d' if two_d else ''}.yaml"
    path.write_text(
        f"# {view.name}\nversion: 1\nvolume: {{ source: {volume.path.name}{arbitrary} }}\n{window}"
        f"transfer_function:\n  - widgets:\n    - points:\n{points(view.function)}{weight}\n{shading}"
        f"camera: {{ position_mm: {eye}, target_mm: {target}, up: {list(view.up)}, fov_degrees: {fov_degrees} }}\n"
        "image: { size: [512, 512], background: black }\n"
    )
    return path
