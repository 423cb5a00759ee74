"""Gives VTK the functions of a preset point by point, as original.json beside this file has them; presets.py puts it there."""

import json
import pathlib

from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction


def piecewise(points):
    function = vtkPiecewiseFunction()
    for x, y in zip(points[::2], points[1::2]):
        function.AddPoint(x, y)
    return function


def widen(function, value_range, entries):
    """Puts a point on a line of the function, so near to another that VTK's table has to have so many entries."""
    low, high = value_range
    apart = (high - low) / (entries - 0.5)
    at = max(high, function.GetRange()[1]) + 1
    for x in (at, at + apart):
        if isinstance(function, vtkPiecewiseFunction):
            function.AddPoint(x, function.GetValue(x))
        else:
            function.AddRGBPoint(x, *function.GetColor(x))
    assert function.EstimateMinNumberOfSamples(low, high) == entries, function.EstimateMinNumberOfSamples(low, high)


def give(appearance, value_range):
    original = json.loads((pathlib.Path(__file__).resolve().parent / "original.json").read_text())
    opacity, color = piecewise(original["scalarOpacity"]), vtkColorTransferFunction()
    points = original["colorTransfer"]
    for i in range(0, len(points), 4):
        color.AddRGBPoint(*points[i : i + 4])
    if original["entries"]:
        widen(opacity, value_range, original["entries"])
        widen(color, value_range, original["entries"])
    appearance.SetScalarOpacity(opacity)
    appearance.SetColor(color)
    appearance.SetGradientOpacity(piecewise(original["gradientOpacity"]))
    appearance.SetScalarOpacityUnitDistance(1.0)
