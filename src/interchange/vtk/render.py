#!/usr/bin/env python3
"""Renders the scene beside this script with VTK. Written by `pellucid export-vtk`; needs vtk and numpy.

    python render.py                       a picture.png beside the script, sRGB, as VTK displays it
    python render.py --output picture.npy  linear premultiplied RGBA in f32, top row first, free of 8-bit rounding
    python render.py --mapper cpu          by the fixed-point mapper (no averages, sums and surfaces, and of 2D transfer
                                           functions those that are a product)
    python render.py --frames              one frame for each line `STEP_MM [FILE.npy]` on stdin, with its seconds on stdout
    python render.py --show                in a window

scene.json has the camera, the lights, the grid, the step, the blend mode and what is clipped; the arrays have the values
(of any type that VTK knows), the transfer function (straight linear colour, and extinction per mm when compositing, else opacity) and, for 2D transfer
functions, the gradient magnitude.
"""

import argparse
import ctypes
import json
import os
import pathlib
import resource
import sys
import time
from types import SimpleNamespace

import numpy as np

arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
arguments.add_argument("--output", type=pathlib.Path)
arguments.add_argument("--mapper", choices=("gpu", "cpu"), default="gpu")
arguments.add_argument("--step-mm", type=float, help="distance between samples in place of the scene's")
arguments.add_argument("--bits", type=int, choices=(8, 32), default=32, help="of the buffer that VTK draws into")
arguments.add_argument("--threads", type=int, help="of the fixed-point mapper; as many as there are cores unless told")
arguments.add_argument("--frames", action="store_true", help="render frame after frame, and say how long each took")
arguments.add_argument("--show", action="store_true", help="open a window")
arguments.add_argument("--facts", action="store_true", help="print versions and settings as JSON")
arguments = arguments.parse_args()

if not arguments.show:
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

import vtkmodules.vtkInteractionStyle  # noqa: E402,F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: E402,F401
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: E402,F401
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402
from vtkmodules.vtkCommonCore import VTK_FLOAT, vtkUnsignedCharArray, vtkVersion  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction, vtkPlane  # noqa: E402
from vtkmodules.vtkCommonMath import vtkMatrix4x4  # noqa: E402
from vtkmodules.vtkRenderingCore import (  # noqa: E402
    vtkColorTransferFunction,
    vtkLight,
    vtkRenderer,
    vtkRenderWindow,
    vtkRenderWindowInteractor,
    vtkVolume,
    vtkVolumeProperty,
)
from vtkmodules.vtkRenderingOpenGL2 import vtkTextureObject  # noqa: E402
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper  # noqa: E402
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkOpenGLGPUVolumeRayCastMapper  # noqa: E402

# Lengths along a ray in which the table's opacities are given.
UNIT_MM = 1.0
# VTK reads numpy's own memory, which must outlive it.
KEPT = []

# How far the opacities of a step may be from a product, and still be given to the fixed-point mapper as one.
NEARLY_A_PRODUCT = 0.02

# What this script exits with where a mapper cannot draw the scene.
UNSUPPORTED = 3

here = pathlib.Path(__file__).resolve().parent
scene = json.loads((here / "scene.json").read_text())
step_mm = arguments.step_mm or scene["step_mm"]
two_d = scene["transfer_function"]["dimensions"] == 2
blend = scene["blend"]
width, height = scene["camera"]["size"]


def load(name):
    return np.load(here / f"{name}.npy")


def image(upside_down):
    """The values on their lattice, with the gradient magnitude as a second array where it is read."""
    values = load("volume")
    if upside_down:
        values = values.min() + (values.max() - values)
    data = vtkImageData()
    data.SetDimensions(values.shape[::-1])
    data.SetSpacing(scene["spacing_mm"])
    arrays = [("values", values)] + ([("gradient_magnitude", load("gradient_magnitude"))] if two_d else [])
    for name, array in arrays:
        flat = np.ascontiguousarray(array).ravel()
        KEPT.append(flat)
        array = numpy_to_vtk(flat, deep=False)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    data.GetPointData().SetActiveScalars("values")
    return data, (float(values.min()), float(values.max()))


def transfer_function(appearance, value_range, step_mm):
    table = load("transfer_function").astype(np.float64)
    color, extinction = table[..., :3], table[..., 3]
    if two_d:
        # VTK does not correct the opacities of a 2D transfer function for the step.
        of_step = -np.expm1(-extinction * step_mm)
        if arguments.mapper == "cpu":
            by_value_and_gradient(appearance, value_range, color, of_step)
            return
        rgba = np.concatenate([color, of_step[..., None]], axis=-1)
        texture = vtkImageData()
        texture.SetDimensions(table.shape[1], table.shape[0], 1)
        texture.GetPointData().SetScalars(numpy_to_vtk(rgba.astype(np.float32).reshape(-1, 4), deep=True))
        appearance.SetTransferFunctionModeTo2D()
        appearance.SetTransferFunction2D(texture)
        return
    low, high = value_range
    opacity, colors = vtkPiecewiseFunction(), vtkColorTransferFunction()
    count = table.shape[1]
    # Of the other blend modes the fourth column is opacity as it is.
    opacities = -np.expm1(-extinction[0] * UNIT_MM) if blend["mode"] == "composite" else extinction[0]
    opacity.BuildFunctionFromTable(low, high, count, opacities.copy())
    colors.BuildFunctionFromTable(low, high, count, color[0].ravel().copy())
    appearance.SetScalarOpacity(opacity)
    appearance.SetColor(colors)
    appearance.SetScalarOpacityUnitDistance(UNIT_MM)


def factors(color, of_step):
    """Opacities as a function of the gradient magnitude times one of the value, and the colours by value; nothing if they
    are no such product."""
    row, column = np.unravel_index(of_step.argmax(), of_step.shape)
    by_value, by_gradient = of_step[row], of_step[:, column] / max(of_step[row, column], 1e-30)
    off = np.abs(by_gradient[:, None] * by_value - of_step).max()
    off = max(off, (np.abs(color - color[row]) * of_step[..., None]).max())
    return (by_value, by_gradient, color[row]) if off <= NEARLY_A_PRODUCT else None


def by_value_and_gradient(appearance, value_range, color, of_step):
    """A product as the fixed-point mapper reads it: an opacity by value, and one by its own gradient magnitude.

    Its gradient magnitudes are differences over the mean of the three spacings, in 256 levels up to a quarter of the
    range of values."""
    by_value, by_gradient, colors_by_value = factors(color, of_step)
    opacity, colors, edges = vtkPiecewiseFunction(), vtkColorTransferFunction(), vtkPiecewiseFunction()
    opacity.BuildFunctionFromTable(*value_range, len(by_value), by_value.copy())
    colors.BuildFunctionFromTable(*value_range, len(by_value), colors_by_value.ravel().copy())
    magnitudes = load("gradient_magnitude")
    mean_mm = float(np.mean(scene["spacing_mm"]))
    ends = float(magnitudes.min()) * mean_mm, float(magnitudes.max()) * mean_mm
    edges.BuildFunctionFromTable(*ends, len(by_gradient), by_gradient.copy())
    appearance.SetScalarOpacity(opacity)
    appearance.SetColor(colors)
    appearance.SetGradientOpacity(edges)
    # The opacities are of a step already.
    appearance.SetScalarOpacityUnitDistance(step_mm)


def lights(renderer):
    """A headlight alone is VTK's default; others are placed in the patient."""
    written = scene["shading"]["lights"] if scene["shading"] else []
    if not written:
        return
    renderer.SetTwoSidedLighting(scene["shading"]["two_sided"])
    renderer.AutomaticLightCreationOff()
    renderer.RemoveAllLights()
    for entry in written:
        light = vtkLight()
        light.PositionalOff()
        light.SetColor(entry["color"])
        if entry["towards"] is None:
            light.SetLightTypeToHeadlight()
        else:
            light.SetLightTypeToSceneLight()
            light.SetFocalPoint(0, 0, 0)
            light.SetPosition(entry["towards"])
        renderer.AddLight(light)


def aim(camera, bounds):
    given = scene["camera"]
    position, forward = np.array(given["position_mm"]), np.array(given["forward"])
    corners = np.array([[bounds[i], bounds[2 + j], bounds[4 + k]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    depths = (corners - position) @ forward
    camera.SetPosition(position)
    camera.SetFocalPoint(position + forward * max(depths.mean(), 1.0))
    camera.SetViewUp(given["up"])
    if given["projection"] == "parallel":
        camera.ParallelProjectionOn()
        camera.SetParallelScale(0.5 * given["fov_degrees_or_height_mm"])
    else:
        camera.SetViewAngle(given["fov_degrees_or_height_mm"])
    # A near plane that touches the volume would move the samples.
    around = np.ptp(depths)
    camera.SetClippingRange(max(depths.min() - around, 0.01 * max(depths.max(), 1.0)), depths.max() + around)


def show_by_blend_mode(ray_cast, appearance):
    modes = {
        "composite": ray_cast.SetBlendModeToComposite,
        "maximum": ray_cast.SetBlendModeToMaximumIntensity,
        "minimum": ray_cast.SetBlendModeToMinimumIntensity,
        "average": ray_cast.SetBlendModeToAverageIntensity,
        "additive": ray_cast.SetBlendModeToAdditive,
        "isosurface": ray_cast.SetBlendModeToIsoSurface,
    }
    modes[blend["mode"]]()
    for n, level in enumerate(blend.get("levels", [])):
        appearance.GetIsoSurfaceValues().SetValue(n, level)


def clip(ray_cast):
    """What the planes leave of the patient, in mm, and the box that is left of the volume, in its own frame."""
    for given in scene["clipping_planes"]:
        plane = vtkPlane()
        plane.SetOrigin(given["point_mm"])
        plane.SetNormal(given["normal"])
        ray_cast.AddClippingPlane(plane)
    if scene["crop_voxels"] is not None:
        spacing = np.array(scene["spacing_mm"])[:, None]
        ray_cast.CroppingOn()
        ray_cast.SetCroppingRegionPlanes((np.array(scene["crop_voxels"]) * spacing).ravel())
        ray_cast.SetCroppingRegionFlagsToSubVolume()


def mapper(data):
    ray_cast = vtkOpenGLGPUVolumeRayCastMapper() if arguments.mapper == "gpu" else vtkFixedPointVolumeRayCastMapper()
    ray_cast.SetInputData(data)
    ray_cast.AutoAdjustSampleDistancesOff()
    ray_cast.SetImageSampleDistance(1.0)
    ray_cast.LockSampleDistanceToInputSpacingOff()
    ray_cast.SetSampleDistance(step_mm)
    if arguments.mapper == "gpu":
        ray_cast.UseJitteringOff()
        ray_cast.SetMaxMemoryInBytes(1 << 36)
        if two_d:
            ray_cast.SetTransfer2DYAxisArray("gradient_magnitude")
    else:
        ray_cast.SetInteractiveSampleDistance(step_mm)
        if arguments.threads:
            ray_cast.SetNumberOfThreads(arguments.threads)
    return ray_cast


def float_buffer(window):
    """Gives the window's buffer 32-bit floats: 8 bits would hide every error below 2e-3."""
    texture = vtkTextureObject()
    texture.SetContext(window)
    texture.Allocate2D(width, height, 4, VTK_FLOAT)
    buffer = window.GetRenderFramebuffer()
    window.MakeCurrent()
    buffer.SaveCurrentBindingsAndBuffers()
    buffer.Bind()
    buffer.AddColorAttachment(0, texture)
    buffer.ActivateBuffer(0)
    buffer.RestorePreviousBindingsAndBuffers()
    return texture


def fixed_point_pixels(ray_cast):
    """The 15-bit picture of the fixed-point mapper: the one that it displays is magnified by a pixel and blurred."""
    picture = ray_cast.GetRayCastImage()
    memory, used, origin = picture.GetImageMemorySize(), picture.GetImageInUseSize(), picture.GetImageOrigin()
    address = int(picture.GetImage().split("_")[1], 16)
    raw = (ctypes.c_uint16 * (4 * memory[0] * memory[1])).from_address(address)
    raw = np.frombuffer(raw, np.uint16).reshape(memory[1], memory[0], 4)
    pixels = np.zeros((height, width, 4), np.float32)
    rows, columns = min(used[1], height - origin[1]), min(used[0], width - origin[0])
    pixels[origin[1] : origin[1] + rows, origin[0] : origin[0] + columns] = raw[:rows, :columns] / 32767.0
    return pixels


def pixels_of(window, ray_cast, texture):
    if arguments.mapper == "cpu":
        return fixed_point_pixels(ray_cast)
    if texture is None:
        bytes_ = vtkUnsignedCharArray()
        window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, bytes_)
        return (vtk_to_numpy(bytes_).reshape(height, width, 4) / 255.0).astype(np.float32)
    pixels = np.zeros((height, width, 4), np.float32)
    texture.Download().Download2D(VTK_FLOAT, pixels, (width, height), 4, (0, 0))
    return pixels


def srgb_bytes(pixels):
    """What a display shows: straight alpha, sRGB."""
    alpha = pixels[..., 3:]
    linear = np.clip(np.divide(pixels[..., :3], alpha, out=np.zeros_like(pixels[..., :3]), where=alpha > 0), 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    return (np.concatenate([encoded, np.clip(alpha, 0, 1)], axis=-1) * 255 + 0.5).astype(np.uint8)


def write(path, pixels):
    if path.suffix == ".npy":
        np.save(path, np.ascontiguousarray(pixels))
        return
    from vtkmodules.vtkIOImage import vtkPNGWriter

    picture = vtkImageData()
    picture.SetDimensions(width, height, 1)
    picture.GetPointData().SetScalars(numpy_to_vtk(srgb_bytes(pixels)[::-1].reshape(-1, 4).copy(), deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(picture)
    writer.Write()


def windowed(numbers, met):
    """Numbers as a grey that a display shows linearly, where a ray met the volume."""
    low, high = blend["window"]
    grey = np.clip((numbers - low) / (high - low), 0, 1)
    light = np.where(grey <= 0.04045, grey / 12.92, ((grey + 0.055) / 1.055) ** 2.4)
    return np.where(met[..., None], np.stack([light, light, light, np.ones_like(light)], axis=-1), 0)


def picture():
    """Linear premultiplied RGBA, top row first."""
    pixels, (low, high), ray_cast, window = rendered()
    share, met = pixels[..., 0], pixels[..., 3] > 0
    if blend["mode"] == "average":
        pixels = windowed(low + (high - low) * share, met)
    if blend["mode"] == "additive":
        # Of the volume upside down it is the rest of each sample's opacity, so that both say how long the ray is.
        upside_down = rendered(upside_down=True)[0][..., 0]
        pixels = windowed((high * share + low * upside_down) / blend["opacity"], met)
    return pixels, ray_cast, window


def refuse():
    """Ends the script where the fixed-point mapper has no equal of the scene: it would draw nothing, or something else."""
    if arguments.mapper == "gpu":
        return
    objection = None
    if blend["mode"] not in ("composite", "maximum", "minimum"):
        objection = f"VTK's fixed-point mapper has no equal of the blend mode {blend['mode']}"
    if two_d:
        table = load("transfer_function").astype(np.float64)
        if factors(table[..., :3], -np.expm1(-table[..., 3] * step_mm)) is None:
            objection = "VTK's fixed-point mapper has no 2D transfer functions, and this one is no product of two of 1D"
    if objection:
        print(objection, file=sys.stderr)
        raise SystemExit(UNSUPPORTED)


def view(upside_down=False):
    """Everything that is set up before the first frame."""
    data, value_range = image(upside_down)
    appearance = vtkVolumeProperty()
    appearance.SetInterpolationTypeToLinear()
    transfer_function(appearance, value_range, step_mm)
    shading = scene["shading"]
    appearance.SetShade(shading is not None)
    if shading:
        appearance.SetAmbient(shading["ambient"])
        appearance.SetDiffuse(shading["diffuse"])
        appearance.SetSpecular(shading["specular"])
        appearance.SetSpecularPower(shading["shininess"])

    ray_cast = mapper(data)
    show_by_blend_mode(ray_cast, appearance)
    clip(ray_cast)
    volume = vtkVolume()
    volume.SetMapper(ray_cast)
    volume.SetProperty(appearance)
    motion = vtkMatrix4x4()
    for row in range(3):
        for column in range(4):
            motion.SetElement(row, column, scene["motion"][row][column])
    volume.SetUserMatrix(motion)

    renderer = vtkRenderer()
    renderer.SetBackground(0, 0, 0)
    renderer.AddVolume(volume)
    lights(renderer)
    window = vtkRenderWindow()
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    window.SetOffScreenRendering(not arguments.show)
    window.AddRenderer(renderer)
    aim(renderer.GetActiveCamera(), volume.GetBounds())
    # The window itself is made without the volume, so that the first frame is the volume's.
    volume.VisibilityOff()
    window.Render()
    volume.VisibilityOn()
    texture = None
    if arguments.bits == 32 and arguments.mapper == "gpu" and not arguments.show:
        texture = float_buffer(window)
    return SimpleNamespace(
        value_range=value_range, appearance=appearance, ray_cast=ray_cast, window=window, texture=texture
    )


def rendered(upside_down=False):
    """VTK's pixels, the range of the values, and what made them."""
    shown = view(upside_down)
    shown.window.Render()
    if arguments.show:
        interactor = vtkRenderWindowInteractor()
        interactor.SetRenderWindow(shown.window)
        interactor.Start()
        raise SystemExit
    return pixels(shown), shown.value_range, shown.ray_cast, shown.window


def pixels(shown):
    return pixels_of(shown.window, shown.ray_cast, shown.texture)[::-1].astype(np.float64)


def over_background(pixels):
    if scene["background"] is not None:
        pixels[..., :3] += (1 - pixels[..., 3:]) * np.array(scene["background"])
        pixels[..., 3] = 1
    return pixels.astype(np.float32)


def seconds_of(work):
    begun = time.perf_counter()
    result = work()
    return time.perf_counter() - begun, result


def say(**facts):
    peak_memory_bytes = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(json.dumps({**facts, "peak_memory_bytes": peak_memory_bytes}), flush=True)


def frames():
    """Frames on demand. The first one, in which VTK prepares what it keeps, is rendered at once and not among them."""
    load_seconds, shown = seconds_of(view)

    def frame():
        shown.window.Render()
        shown.window.WaitForCompletion()

    first_seconds, _ = seconds_of(frame)
    say(vtk=vtkVersion.GetVTKVersion(), load_seconds=load_seconds, first_frame_seconds=first_seconds)
    for line in sys.stdin:
        step, *output = line.rstrip("\n").split(" ", 1)
        shown.ray_cast.SetSampleDistance(float(step))
        if two_d:
            transfer_function(shown.appearance, shown.value_range, float(step))
        if arguments.mapper == "cpu":
            shown.ray_cast.SetInteractiveSampleDistance(float(step))
        seconds, _ = seconds_of(frame)
        if output:
            write(pathlib.Path(output[0]), over_background(pixels(shown)))
        say(seconds=seconds)


def main():
    refuse()
    if arguments.frames:
        frames()
        return
    pixels, ray_cast, window = picture()
    path = arguments.output or here / "picture.png"
    write(path, over_background(pixels))
    if arguments.facts:
        lines = [line.split(": ", 1) for line in window.ReportCapabilities().split("\n") if "OpenGL" in line]
        capabilities = {line[0].strip(): line[1].strip() for line in lines if len(line) == 2}
        print(
            json.dumps(
                {
                    "vtk": vtkVersion.GetVTKVersion(),
                    "renderer": capabilities.get("OpenGL renderer string", "unknown"),
                    "mapper": ray_cast.GetClassName(),
                    "step_mm": step_mm,
                    "bits": arguments.bits if arguments.mapper == "gpu" else 15,
                }
            )
        )
    else:
        print(path)
        for note in scene["notes"]:
            print("note:", note)


main()
