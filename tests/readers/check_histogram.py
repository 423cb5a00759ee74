#!/usr/bin/env python3
"""Checks pellucid's joint histograms, bin by bin, against numpy.

    pip install numpy pynrrd
    tests/readers/check_histogram.py target/release/pellucid ../shared/data

For each scan below, pynrrd reads the values, and numpy takes central differences (one-sided on the border), transforms them
by the inverse transpose of the file's affine, and counts value and gradient magnitude. Both count half-open bins, the last
closed. pellucid's gradient magnitudes are rounded to 24 bits, numpy's are not: a voxel whose magnitude lies within 1e-5 of an
edge, as a share of the magnitude, may be counted on either side of it, and no other voxel may. One line per scan; exit code 1
if a bin differs by more. Then a voxel is moved by one bin, and the comparison must find it.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import nrrd
import numpy as np

# Scan, ends of the values, ends of the gradient magnitudes, bins; ends that are beyond all voxels and ends that are not.
CASES = (
    ("abdomen/ct.nrrd", (-1300.0, 3400.0), (0.0, 1700.0), 235),
    ("abdomen/ct.nrrd", (-300.0, 900.0), (7.3, 311.7), 97),
    ("tooth.nrrd", (0.0, 255.0), (0.0, 113.7), 255),
)
ROUNDING = 1e-5


def differences(data, axis):
    """Central differences per index step, one-sided on the border."""
    n = data.shape[axis]
    index = np.arange(n)
    before, after = np.maximum(index - 1, 0), np.minimum(index + 1, n - 1)
    steps = (after - before).reshape([-1 if a == axis else 1 for a in range(3)])
    return (np.take(data, after, axis) - np.take(data, before, axis)) / steps


def value_and_gradient(path):
    data, header = nrrd.read(str(path), index_order="F")
    data = data.astype(np.float64)
    if "space directions" in header:
        to_mm = np.asarray(header["space directions"], dtype=np.float64).T
    else:
        to_mm = np.diag(np.asarray(header["spacings"], dtype=np.float64))
    per_index = np.stack([differences(data, axis) for axis in range(3)], axis=-1)
    per_mm = per_index @ np.linalg.inv(to_mm)
    return data.ravel(), np.sqrt((per_mm**2).sum(axis=-1)).ravel()


def by_pellucid(binary, path, value, gradient, bins):
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "counts.json"
        ends = [f"--hu={value[0]}:{value[1]}", f"--gradient={gradient[0]}:{gradient[1]}", "--bins", str(bins)]
        subprocess.run([binary, "histogram", str(path), *ends, "-o", str(output)], check=True, capture_output=True)
        return json.loads(output.read_text())


def edges(axis):
    return np.linspace(axis["low"], axis["high"], axis["bins"] + 1)


def bounds(values, gradients, x, y):
    """Fewest and most voxels of each bin, and numpy's own counts."""
    near = np.abs(gradients[:, None] - y[np.clip(np.searchsorted(y, gradients)[:, None] - [1, 0], 0, len(y) - 1)])
    # A magnitude of 0 is exact.
    unsure = (near.min(axis=1) <= ROUNDING * gradients) & (gradients > 0)
    count = lambda which, gradients: np.histogram2d(values[which], gradients[which], bins=(x, y))[0].astype(np.int64)
    fewest = count(~unsure, gradients)
    either = np.maximum(
        count(unsure, gradients * (1 - 2 * ROUNDING)) + count(unsure, gradients * (1 + 2 * ROUNDING)),
        count(unsure, gradients),
    )
    return fewest, fewest + either, count(np.ones_like(unsure), gradients), int(unsure.sum())


def wrong(found, fewest, most):
    return int(((found < fewest) | (found > most)).sum())


def check(binary, path, value, gradient, bins):
    """Whether all is well, and what was found."""
    values, gradients = value_and_gradient(path)
    counted = by_pellucid(binary, path, value, gradient, bins)
    found = np.asarray(counted["counts"], dtype=np.int64)
    fewest, most, exact, unsure = bounds(values, gradients, edges(counted["x"]), edges(counted["y"]))
    if found.shape != exact.shape or counted["voxels"] != values.size or counted["counted"] != found.sum():
        return False, f"shape {found.shape}, {counted['voxels']} voxels, {counted['counted']} counted: does not add up"
    beyond = wrong(found, fewest, most)
    same = int((found == exact).sum())
    i, j = np.unravel_index(np.argmax(np.where(fewest == most, most, -1)), most.shape)
    planted = found.copy()
    planted[i, j] -= 1
    if wrong(planted, fewest, most) != beyond + 1:
        return False, "a voxel that is missing was not noticed"
    text = f"{same} of {found.size} bins equal, {unsure} voxels of {values.size} on an edge, {beyond} bins beyond them"
    return beyond == 0 and found.sum() > 0, text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary", help="the pellucid binary")
    parser.add_argument("folder", type=pathlib.Path, help="the folder of scans")
    arguments = parser.parse_args()
    failed = 0
    for name, value, gradient, bins in CASES:
        try:
            well, text = check(arguments.binary, arguments.folder / name, value, gradient, bins)
        except subprocess.CalledProcessError as error:
            well, text = False, f"pellucid: {error.stderr.decode().strip()}"
        failed += not well
        print(f"{name}, {bins} bins: {'ok' if well else 'DIFFERS'}, {text}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
