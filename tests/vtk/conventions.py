#!/usr/bin/env python3
"""What pellucid takes VTK's conventions to be, each by an experiment with live VTK: fails where VTK does otherwise.

    conventions.py [PELLUCID]        with the program, also the experiments on scenes

`march: { compatibility: vtk }` and the script of `pellucid export-vtk` are built on these.
"""

import json
import os
import pathlib
import sys
import tempfile

import numpy as np

from bridge import ROOT, Pellucid, render_vtk, scenes
from rays import Shader, exact_rays

SCRIPT = ROOT / "src/interchange/vtk/render.py"
# Voxels along an axis of the boxes below, of 1 mm.
N = 9
# Positions that are exact, and as VTK's shader has them.
KINDS = (np.float64, np.float32)
failures = []


def holds(what, found, expected, within):
    off = float(np.max(np.abs(np.asarray(found) - np.asarray(expected))))
    verdict = "" if off <= within else "FAILED "
    print(f"{verdict}{what}: found {np.round(found, 6)}, expected {np.round(expected, 6)} within {within:g}")
    if off > within:
        failures.append(what)


def box(extinction_per_mm, step_mm, values=None, gradient=None, colors=None, mapper="gpu", dims=(N, N, N), edits=(), **scene):
    """VTK's picture of a box seen along +x by parallel rays; its middle pixel's ray is 8 mm long. Of the script, each of
    the edits' first is replaced by its second."""
    z, y, x = np.meshgrid(*[np.arange(n, dtype=np.float32) for n in reversed(dims)], indexing="ij")
    values = {None: y, "x": x}.get(values, values) if isinstance(values, (str, type(None))) else values(x, y, z)
    extinction = np.atleast_2d(np.asarray(extinction_per_mm, np.float32))
    table = np.zeros((*extinction.shape, 4), np.float32)
    table[..., :3] = 1 if colors is None else colors
    table[..., 3] = extinction
    middle = [0.5 * (n - 1) for n in dims]
    camera = {
        "position_mm": [-1000 + middle[0], middle[1], middle[2]],
        "forward": [1, 0, 0],
        "up": [0, 0, 1],
        "projection": "parallel",
        "fov_degrees_or_height_mm": 2,
        "size": [5, 5],
    }
    described = {
        "spacing_mm": [1, 1, 1],
        "motion": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]],
        "step_mm": step_mm,
        "transfer_function": {"dimensions": 1 if gradient is None else 2},
        "camera": camera,
        "background": None,
        "blend": {"mode": "composite"},
        "crop_voxels": None,
        "clipping_planes": [],
        "shading": None,
        "notes": [],
    } | scene
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        np.save(folder / "volume.npy", values.astype(np.float32))
        np.save(folder / "transfer_function.npy", table)
        if gradient is not None:
            np.save(folder / "gradient_magnitude.npy", gradient(x, y, z).astype(np.float32))
        (folder / "scene.json").write_text(json.dumps(described))
        script = SCRIPT.read_text()
        for old, new in edits:
            assert old in script, f"the script has {old}"
            script = script.replace(old, new)
        (folder / "render.py").write_text(script)
        render_vtk(folder, mapper, folder / "picture.npy")
        return np.load(folder / "picture.npy")[2, 2].astype(np.float64)


def absorbed(extinction_per_mm, mm):
    return -np.expm1(-extinction_per_mm * mm)


def encoded(linear):
    """Linear light as sRGB."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def sampling():
    constant = [0.1, 0.1]
    for step, samples in ((3.0, 2), (0.75, 10), (9.5, 1)):
        found = box(constant, step)[3]
        holds(f"samples at whole steps only, the first a step in: {samples} of {step} mm", found, absorbed(0.1, samples * step), 2e-6)
    # A ramp along the ray: 2, 4, 6 and 8 mm are read, 0 mm is not.
    ramp = np.linspace(0, 0.08, 4097)
    at = np.array([2, 4, 6, 8]) / 8 * 4097 - 0.5
    read = np.interp(at, np.arange(4097), ramp)
    holds("the values at the ends of steps", box(ramp, 2.0, values="x")[3], absorbed(read.sum(), 2.0), 1e-5)


def opacity():
    # Not a divisor of 8 mm: whether a sample at the exit itself counts is a matter of rounding.
    for step in (3.0, 1.5, 0.3):
        length = int(8 / step) * step
        holds(f"1D opacities are corrected for a step of {step} mm", box([0.05, 0.05], step)[3], absorbed(0.05, length), 3e-6)
    faint, found = 9e-5, box([9e-5, 9e-5], 0.3)[3]
    holds("but not those of up to 1e-4 per mm: 26 steps of 0.3 mm count as 26 mm", found, absorbed(faint, 26), 1e-6)
    dense = box([1.0, 1.0], 1.0)[3]
    holds("a ray stops when its opacity is above 1 - 1/255: after 6 mm", dense, absorbed(1.0, 6), 2e-6)


def textures():
    # Four texels over the values 0 to 8: a value v is looked up at v/8 * 4 - 1/2, clamped.
    entries = np.array([0.0, 0.01, 0.03, 0.1])
    # Opacities of 1 mm are what is interpolated.
    of_step = absorbed(entries, 1.0)
    wide = np.interp(np.arange(1024) * 3 / 1023, np.arange(4), of_step)
    # Texels are 1024 at least: the script's table is resampled to that many.
    at = 4 / 8 * 1024 - 0.5
    alpha = np.interp(at, np.arange(1024), wide)
    holds("a 1D look-up is at u n - 1/2 of n = 1024 texels", box(entries, 1.0)[3], 1 - (1 - alpha) ** 8, 1e-6)


def gradients():
    magnitude = lambda x, y, z: 10 * z  # noqa: E731
    rows = np.linspace(0, 0.1, 1024)[:, None] * np.ones((1, 1024))
    at = 4 / 8 * 1024 - 0.5
    expected = absorbed(np.interp(at, np.arange(1024), rows[:, 0]), 8)
    holds("a second channel is the y axis of a 2D transfer function, over its own range", box(rows, 1.0, gradient=magnitude)[3], expected, 3e-5)
    apart = np.abs(two_d_on_the_cpu(0.0) - two_d_on_the_cpu(0.5)).max()
    holds("the CPU mapper does not read a 2D transfer function: transparent and opaque look alike", apart, 0.0, 0.0)
    holds("2D opacities are not corrected for the step: half the step, twice the depth", uncorrected_2d(), 2.0, 0.15)


def uncorrected_2d():
    """Optical depth at steps of 0.35 mm over that at 0.7 mm, of the opacities that the script corrects for 0.7 mm."""
    depth = [-np.log1p(-box(np.full((2, 2), 0.05), 0.7, gradient=lambda x, y, z: z, edits=[("SetSampleDistance(step_mm)", f"SetSampleDistance({step})")])[3]) for step in (0.7, 0.35)]
    return depth[1] / depth[0]


def two_d_on_the_cpu(opacity):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkVolume, vtkVolumeProperty
    from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper
    import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401

    data, texture = vtkImageData(), vtkImageData()
    data.SetDimensions(N, N, N)
    data.GetPointData().SetScalars(numpy_to_vtk(np.arange(N**3, dtype=np.float32), deep=True))
    texture.SetDimensions(1024, 1024, 1)
    rgba = np.full((1024 * 1024, 4), opacity, np.float32)
    texture.GetPointData().SetScalars(numpy_to_vtk(rgba, deep=True))
    mapper, appearance, volume = vtkFixedPointVolumeRayCastMapper(), vtkVolumeProperty(), vtkVolume()
    mapper.SetInputData(data)
    appearance.SetTransferFunctionModeTo2D()
    appearance.SetTransferFunction2D(texture)
    volume.SetMapper(mapper)
    volume.SetProperty(appearance)
    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.AddVolume(volume)
    window.SetOffScreenRendering(True)
    window.SetSize(32, 32)
    window.AddRenderer(renderer)
    window.Render()
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
    from vtkmodules.util.numpy_support import vtk_to_numpy

    pixels = vtkUnsignedCharArray()
    window.GetRGBACharPixelData(0, 0, 31, 31, 0, pixels)
    return vtk_to_numpy(pixels).astype(int)


def lights():
    """The normal under scene lights: `S Vt R g` in place of `R V g`, right for cubes along the axes only."""
    towards = np.array([-0.6, 0.48, 0.64])
    gradient = np.array([0.48, -0.6, 0.64])

    def lit(dims):
        shading = {
            "ambient": 0,
            "diffuse": 1,
            "specular": 0,
            "shininess": 1,
            "two_sided": True,
            "lights": [{"towards": towards.tolist(), "color": [1, 1, 1]}],
        }
        ramp = lambda x, y, z: gradient[0] * x + gradient[1] * y + gradient[2] * z  # noqa: E731
        # Steps of 3 mm keep the differences away from the border.
        red, _, _, alpha = box([0.05, 0.05], 3.0, values=ramp, dims=dims, shading=shading)
        return red / alpha

    holds("a cube is lit by the cosine", lit((N, N, N)), abs(towards @ gradient), 1e-4)
    sides = np.array([8, 8, 32])
    # Seen along +x with z up: right is -y, up is z, and the camera's third axis is -x.
    turn = np.array([[0, -1, 0], [0, 0, 1], [-1, 0, 0]])
    # Differences reach n/(n - 1) voxels to either side along an axis of n voxels.
    normal = sides * (turn @ (gradient * (1 + 1 / sides)))
    wrong = abs((turn @ towards) @ normal) / np.linalg.norm(normal)
    holds("a box that is no cube by another", lit((N, N, 33)), wrong, 1e-4)
    assert abs(wrong - abs(towards @ gradient)) > 0.1, "the experiment tells them apart"


def normals_beyond():
    """The 8 mm of ray have one sample of a longer step: its differences are taken around where it is, behind the box."""
    shading = {"ambient": 0, "diffuse": 1, "specular": 0, "shininess": 1, "two_sided": True, "lights": []}

    def facing(step, values):
        red, _, _, alpha = box([0.05, 0.05], step, values=values, shading=shading)
        return red / alpha

    reach = N / (N - 1)
    for step in (8.5, 9.0, 9.5):
        at_border, beyond = (np.array([8 - min(x - reach, 8), 2 * reach]) for x in (8.0, step))
        held, expected = (d[0] / np.linalg.norm(d) for d in (at_border, beyond))
        holds(f"differences of a sample {step - 8} mm behind the box are around it, each end clamped", facing(step, lambda x, y, z: x + y), expected, 1e-4)
        assert abs(held - expected) > 0.1, "the experiment tells it from differences at the border"
    magnitude, rows = (lambda x, y, z: x), np.linspace(0, 0.1, 1024)[:, None] * np.ones((1, 1024))
    on_the_border = absorbed(0.1, 9.5)
    holds("a second channel is read there as at the border", box(rows, 9.5, gradient=magnitude)[3], on_the_border, 1e-4)


def clipping():
    """Optical depth in steps: how many samples of the 8 mm along x are left."""

    def samples(step, x, side, **more):
        plane = {"point_mm": [x, 0, 0], "normal": [side, 0, 0]}
        alpha = box([0.05, 0.05], step, clipping_planes=[plane], **more)[3]
        return -np.log1p(-alpha) / (0.05 * step)

    holds("a plane that a ray enters by at 2.3: the first sample is a step behind, 3.3 to 7.3", samples(1.0, 2.3, 1), 5, 1e-4)
    holds("and none is taken where that is outside", samples(1.0, 7.5, 1), 0, 0)
    holds("a plane that it leaves by at 5.3: 1 to 6, one sample beyond", samples(1.0, 5.3, -1), 6, 1e-4)
    holds("at steps of 0.75 mm: 0.75 to 6", samples(0.75, 5.3, -1), 8, 1e-4)
    turned = {"motion": [[0, -1, 0, 8], [1, 0, 0, 0], [0, 0, 1, 0]]}
    holds("planes are in the patient, not in the volume", samples(1.0, 5.3, -1, **turned), 6, 1e-4)

    def left(low, high, voxels=N):
        crop = [[low, high], [-N, 2 * N], [-N, 2 * N]]
        return -np.log1p(-box([0.05, 0.05], 0.01, dims=(voxels, N, N), crop_voxels=crop)[3]) / 0.05

    for low, high, voxels in ((2, 6, N), (1, 7, N), (4, 14, 17)):
        cut = [p * voxels / (voxels - 1) - 0.5 for p in (low, high)]
        holds(f"voxels {low} to {high} of {voxels} are cropped at p n/(n - 1) - 1/2", left(low, high, voxels), cut[1] - cut[0], 0.02)


def blend_modes():
    ramp = np.linspace(0, 0.5, 4097)
    projection = {"opacity": 1.0, "window": [0.0, 8.0]}

    def grey(mode, extinction, step, **more):
        """The grey of the values' share of their range, and alpha."""
        linear, _, _, alpha = box(extinction, step, values="x", colors=np.linspace(0, 1, len(extinction))[:, None], blend=projection | {"mode": mode} | more)
        return linear, alpha

    opaque, decoded = np.ones(4097), lambda u: ((u + 0.055) / 1.055) ** 2.4
    holds("the maximum of whole steps of 3 mm is at 6 of 8 mm, by the table", grey("maximum", opaque, 3.0), [0.75, 1], 2e-4)
    holds("the minimum is at 3 mm", grey("minimum", opaque, 3.0), [0.375, 1], 2e-4)
    holds("their opacity is that of the value, whatever the step", grey("maximum", ramp, 3.0)[1], 0.375, 1e-4)
    holds("the average is over the samples, at 3 and 6 mm", grey("average", opaque, 3.0)[0], decoded(4.5 / 8), 1e-5)
    half = 0.5 * opaque
    holds("it is of opacity times value, not divided by opacity", grey("average", half, 3.0)[0], decoded(4.5 / 16), 1e-5)
    sum_ = grey("additive", opaque / 100, 3.0, opacity=1 / 100, window=[0.0, 40.0])[0]
    holds("the sum is corrected for the step: 3 (3 + 6) mm", sum_, decoded(27 / 40), 1e-5)
    cut_off = grey("additive", opaque, 3.0, opacity=1.0, window=[0.0, 40.0])[0]
    holds("and cut off at 1, which is 8 of the range, both ways up", cut_off, decoded(8 / 40), 1e-5)

    def surfaces(levels, step, alphas):
        return box(alphas, step, values="x", blend={"mode": "isosurface", "levels": levels})[3]

    steps = np.where(np.arange(4097) < 2048, 0.25, 0.5)
    holds("a surface has its level's opacity, whatever the step", surfaces([2.5], 0.3, steps), 0.25, 1e-6)
    holds("two levels between two samples follow one by one", surfaces([3.2, 4.4], 3.0, steps), 0.25, 1e-6)
    holds("both, where samples follow", surfaces([1.2, 5.4], 1.0, steps), 1 - 0.75 * 0.5, 1e-6)
    holds("the first sample crosses nothing", surfaces([2.5], 3.0, steps), 0.0, 0.0)


def fixed_point():
    found = box([0.05, 0.05], 1.0, mapper="cpu")[3]
    holds("the CPU mapper counts in 1/32767", found * 32767, round(found * 32767), 1e-3)
    holds("it takes no sample where the ray meets or leaves the box: 7 of 1 mm", found, absorbed(0.05, 7), 1e-3)
    # The script puts the near plane 8 mm in front of the box.
    for step in (0.7, 2.5, 3.9, 4.1, 7.9):
        inside = [k * step - 8 for k in range(30) if 0 < k * step - 8 < 8]
        ends = [box_of_values(mode, step, mapper="cpu")[0] for mode in ("minimum", "maximum")]
        found = [8 * end for end in ends]
        holds(f"its samples are whole steps of {step} mm from the near plane, not from the box", found, [inside[0], inside[-1]], 3e-3)
    holds("so a ray that is shorter than a step may have none", box([0.05, 0.05], 16.5, mapper="cpu")[3], 0, 0)
    # As if the script knew of nothing that the mapper cannot draw, nor of windows.
    anyway = [("    refuse()\n", ""), ('blend["mode"] == "average"', "False"), ('blend["mode"] == "additive"', "False")]
    composited = 1 - (1 - 0.1) ** 15
    sums = box(np.full(2, 0.1), 0.5, mapper="cpu", blend={"mode": "additive"}, edits=anyway)[3]
    holds("the CPU mapper has no sums: they are composited, by opacities not corrected for the step", sums, composited, 1e-3)
    nothing = ('picture.GetImage().split("_")[1]', '(picture.GetImage() or "_0").split("_")[1]')
    blank = ("from_address(address)", "from_address(address) if address else (ctypes.c_uint16 * (4 * memory[0] * memory[1]))()")
    for mode in ("average", "isosurface"):
        drawn = box(np.full(2, 0.5), 1.0, mapper="cpu", blend={"mode": mode, "levels": [4.5]}, values="x", edits=[*anyway, nothing, blank])
        holds(f"the CPU mapper draws nothing of blend mode {mode}", drawn, np.zeros(4), 0.0)
    gradient_opacity()
    normals_on_the_cpu()


def box_of_values(mode, step_mm, **more):
    """The least or largest value along x that samples met, as a share of 8 mm in sRGB, and alpha."""
    projection = {"mode": mode, "opacity": 1.0, "window": [0.0, 8.0]}
    colors = np.linspace(0, 1, 4097)[:, None]
    linear, _, _, alpha = box(np.ones(4097), step_mm, values="x", colors=colors, blend=projection, **more)
    return linear, alpha


def normals_on_the_cpu():
    """Where shading happens: the normal at the middle between two voxels, one lit and one at a right angle to the light."""
    lights = [{"towards": [0, 1, 0], "color": [1, 1, 1]}]
    shading = {"ambient": 0, "diffuse": 1, "specular": 0, "shininess": 1, "two_sided": True, "lights": lights}

    def lit(values, **more):
        red, _, _, alpha = box([0.05, 0.05], 1.0, values=values, mapper="cpu", shading=shading, **more)
        return red / alpha

    def bend(x, y, z):
        """Along z up to z = 4, along y from z = 5 on, at y = 4."""
        along_z = np.select([z <= 5, z == 6], [10 * (z - 3), 10], 10)
        return np.where(z <= 4, 0, 10) * (y - 4) + along_z

    holds("the CPU mapper shades at the voxels and interpolates that: between light 0 and 1", lit(bend, dims=(N, N, N + 1)), 0.5, 0.02)
    rng = np.random.default_rng(5)
    off = []
    for normal in rng.normal(size=(12, 3)):
        normal /= np.linalg.norm(normal)
        ramp = lambda x, y, z: normal[0] * x + normal[1] * y + normal[2] * z  # noqa: B023, E731
        # It lies on the viewer's side, who is at -x.
        off.append(abs(lit(ramp) - max(0.0, -np.sign(normal[0]) * normal[1])))
    holds("by encoded normals turned to the viewer, lit from one side: cosines of 12 directions", np.max(off), 0.0, 0.02)
    assert np.max(off) > 1e-4, "the experiment sees the encoding"


def gradient_opacity():
    """An opacity by the CPU mapper's own gradient magnitudes: where it steps from 0 to 1, a ramp of known slope tells."""

    def shown(slope, edge_per_mm, spacing_mm):
        # Values are of voxels, 1/spacing of them per mm; the range has to hold the slope four times.
        ramp = lambda x, y, z: slope * spacing_mm[1] * y + 1000 * ((x == 0) & (y == 0) & (z == 0))  # noqa: E731
        rows = np.where(np.linspace(0, 2 * edge_per_mm, 1024)[:, None] < edge_per_mm, 0.0, 0.1) * np.ones((1, 1024))
        # The range of the magnitudes given is the axis of the table.
        axis = lambda x, y, z: 2 * edge_per_mm * x / (N - 1)  # noqa: E731
        return box(rows, 1.0, values=ramp, gradient=axis, mapper="cpu", spacing_mm=spacing_mm)[3]

    for spacing_mm in ([1, 1, 1], [1, 1, 2.5]):
        # Seven samples of 0.1 each, or none, a tenth to either side of the edge.
        found = [shown(40, edge_per_mm, spacing_mm) for edge_per_mm in (36, 44)]
        what = f"the CPU mapper has opacities by gradient magnitude, times the mean of spacings of {spacing_mm} mm"
        holds(what, found, [absorbed(0.1, 7), 0], 1e-3)


def rounding(pellucid):
    """The scenes where pellucid's march is furthest from VTK, again in numpy: with positions that are added up in f32 as
    VTK's shader does, and with exact ones."""
    for scene in scenes(["head-thin-shells", "head-fine"]):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            described = pellucid.export(scene, folder)
            render_vtk(folder, "gpu", folder / "vtk.npy")
            vtk = np.load(folder / "vtk.npy")
            # Every fifth row and column.
            pixels = np.array([pixel for pixel in np.argwhere(vtk[..., 3] > 0) if not (pixel % 5).any()])
            off = [255 * np.abs(march(described, folder, pixels, kind) - vtk[*pixels.T]).max(-1) for kind in KINDS]
            pellucid.render(scene, None, folder / "pellucid.exr")
            worst = pellucid.compare(folder / "vtk.npy", folder / "pellucid.exr")[0]["worst"]
            column, row = worst["column"], worst["row"]
            exact, added = (255 * np.abs(march(described, folder, [[row, column]], kind)[0] - vtk[row, column]).max() for kind in KINDS)
            what = f"{scene.name}: pellucid's worst pixel, {255 * worst['difference']:.3f}/255 from VTK; this ray is"
            holds(f"{what} {exact:.3f} by exact positions, {added:.4f} by positions added up in f32", added / exact, 0.0, 0.1)
            exact, added = np.sqrt(np.mean(np.square(off), axis=-1))
            holds(f"{scene.name}: RMS from VTK in 1/255, {exact:.4f} by exact positions, {added:.4f} by positions added up in f32", added / exact, 0.0, 0.5)


def march(described, folder, pixels, kind):
    """VTK's shader for the rays of pixels, unlit and 1D, in numbers of a floating-point type."""
    table = np.load(folder / "transfer_function.npy")[0].astype(np.float64)
    shader = Shader(described, np.load(folder / "volume.npy"), absorbed(table[:, 3], 1.0), table[:, :3])
    return shader.march(exact_rays(described, shader.dims, pixels), kind)


def main():
    # Also for VTK in this process, whose window is not the script's.
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    for experiment in (sampling, opacity, textures, gradients, lights, normals_beyond, clipping, blend_modes, fixed_point):
        experiment()
    if len(sys.argv) > 1:
        rounding(Pellucid(sys.argv[1]))
    if failures:
        raise SystemExit(f"{len(failures)} conventions of VTK are not what pellucid takes them for")


main()
