"""Compares what pellucid reads of DICOM folders with SimpleITK and pydicom, voxel for voxel.

    python check_dicom.py PELLUCID FOLDER...

PELLUCID is the binary. For each folder, `pellucid info FOLDER --format json` gives dimensions, affine and the SHA-256 of all
values; SimpleITK (GDCM) and pydicom (OpenJPEG, libjpeg) read the same files on their own. Then the phantom is written as DICOM
and as NRRD by `pellucid phantom head`, and must be the same volume to all readers. One line per scan; exit code 1 if any
differs. Needs numpy, SimpleITK, pydicom, pylibjpeg, pylibjpeg-openjpeg, pylibjpeg-libjpeg.
"""

import collections
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pydicom
import SimpleITK as sitk

AFFINE_TOLERANCE_MM = 1e-4  # Over the whole volume; positions are written with few decimals.

Scan = collections.namedtuple("Scan", "dims affine sha256")


def sha256(values_zyx):
    return hashlib.sha256(np.ascontiguousarray(values_zyx, dtype="<f4").tobytes()).hexdigest()


def by_pellucid(binary, path):
    run = subprocess.run([binary, "info", str(path), "--format", "json"], capture_output=True, text=True)
    if run.returncode != 0:
        raise RuntimeError(f"pellucid info failed: {run.stderr.strip()}")
    info = json.loads(run.stdout)
    affine = np.array(info["index_to_lps_mm"], dtype=float).reshape(3, 4)
    return Scan(tuple(info["dims"]), affine, info["values_sha256"])


def of_itk(image):
    spacing, direction = np.array(image.GetSpacing()), np.array(image.GetDirection()).reshape(3, 3)
    affine = np.column_stack([direction * spacing, image.GetOrigin()])
    return Scan(image.GetSize(), affine, sha256(sitk.GetArrayFromImage(image)))


def largest_series(folder):
    reader = sitk.ImageSeriesReader
    names = [reader.GetGDCMSeriesFileNames(str(folder), uid) for uid in reader.GetGDCMSeriesIDs(str(folder))]
    return max(names, key=len)


def by_itk(folder):
    return of_itk(sitk.ReadImage(largest_series(folder)))


def by_pydicom(folder):
    """PS3.3 C.7.6.2.1.1 by the letter, with pydicom's pixels; slices sorted along the normal."""
    slices = [pydicom.dcmread(name) for name in largest_series(folder)]
    row, column = (np.array(slices[0].ImageOrientationPatient[n:n + 3], dtype=float) for n in (0, 3))
    normal = np.cross(row, column)
    slices.sort(key=lambda s: np.dot(np.array(s.ImagePositionPatient, dtype=float), normal))
    first, last = (np.array(s.ImagePositionPatient, dtype=float) for s in (slices[0], slices[-1]))
    row_spacing, column_spacing = (float(mm) for mm in slices[0].PixelSpacing)
    step = (last - first) / (len(slices) - 1)
    affine = np.column_stack([row * column_spacing, column * row_spacing, step, first])
    values = [s.pixel_array * float(s.RescaleSlope) + float(s.RescaleIntercept) for s in slices]
    return Scan((slices[0].Columns, slices[0].Rows, len(slices)), affine, sha256(np.stack(values)))


def corner_distance(a, b):
    """Largest distance in mm between the corners of two lattices of the same dimensions."""
    corners = np.array([[i, j, k, 1] for i in (0, a.dims[0] - 1) for j in (0, a.dims[1] - 1) for k in (0, a.dims[2] - 1)])
    return np.abs(corners @ (a.affine - b.affine).T).max()


def differences(scans):
    """What differs between `scans` (a dict by reader) and the first of them, and how far apart their corners are in mm."""
    (first, reference), *others = scans.items()
    found, farthest = [], 0.0
    for reader, scan in others:
        if tuple(scan.dims) != tuple(reference.dims):
            found.append(f"dims {first} {reference.dims} {reader} {scan.dims}")
            continue
        distance = corner_distance(reference, scan)
        farthest = max(farthest, distance)
        if not distance <= AFFINE_TOLERANCE_MM:
            found.append(f"affine {reader} is {distance:.6f} mm off")
        if scan.sha256 != reference.sha256:
            found.append(f"values {first} {reference.sha256[:12]} {reader} {scan.sha256[:12]}")
    return found, farthest


def compare(name, scans):
    """Prints a line; true if all of `scans` are the same."""
    found, farthest = differences(scans)
    dims = " x ".join(str(n) for n in next(iter(scans.values())).dims)
    print(f"{'DIFFERS' if found else 'same'}  {name}: {dims}, {', '.join(scans)}, corners within {farthest:.2e} mm"
          + "".join(f"; {difference}" for difference in found))
    return not found


def check_the_check():
    """A comparison that cannot fail is none: dims, affine and values must each be noticed."""
    scan = Scan((2, 3, 4), np.eye(3, 4), sha256(np.zeros(24)))
    mirrored = np.array([[-1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0]], dtype=float)  # The same box, left and right changed.
    nan = np.full((3, 4), np.nan)
    wrong = [scan._replace(dims=(3, 2, 4)), scan._replace(affine=mirrored), scan._replace(affine=nan),
             scan._replace(sha256=sha256(np.ones(24)))]
    assert not differences({"a": scan, "b": scan})[0], "equal scans differ"
    for other in wrong:
        assert differences({"a": scan, "b": other})[0], f"not noticed: {other}"


def check_folder(binary, folder):
    return compare(folder, {"pellucid": by_pellucid(binary, folder), "SimpleITK": by_itk(folder),
                            "pydicom": by_pydicom(folder)})


def check_phantom(binary):
    with tempfile.TemporaryDirectory() as scratch:
        dicom, nrrd = pathlib.Path(scratch, "dicom"), pathlib.Path(scratch, "phantom.nrrd")
        subprocess.run([binary, "phantom", "head", "--dicom", str(dicom)], check=True, capture_output=True)
        subprocess.run([binary, "phantom", "head", "--nrrd", str(nrrd)], check=True, capture_output=True)
        return compare("phantom", {
            "pellucid of DICOM": by_pellucid(binary, dicom), "pellucid of NRRD": by_pellucid(binary, nrrd),
            "SimpleITK of DICOM": by_itk(dicom), "SimpleITK of NRRD": of_itk(sitk.ReadImage(str(nrrd))),
            "pydicom": by_pydicom(dicom)})


def check(name, function, *arguments):
    try:
        return function(*arguments)
    except Exception as error:  # A reader that fails is a difference too, and the other scans are still checked.
        print(f"DIFFERS  {name}: {type(error).__name__}: {error}")
        return False


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    binary, folders = sys.argv[1], sys.argv[2:]
    check_the_check()
    same = [check(folder, check_folder, binary, folder) for folder in folders]
    same.append(check("phantom", check_phantom, binary))
    sys.exit(0 if all(same) else 1)


if __name__ == "__main__":
    main()
