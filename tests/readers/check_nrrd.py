#!/usr/bin/env python3
"""Checks pellucid's NRRD reader, voxel for voxel, against pynrrd and SimpleITK.

    pip install numpy pynrrd SimpleITK
    tests/readers/check_nrrd.py target/release/pellucid ../shared/data

For every .nrrd and .nhdr below the folder, the three programs must agree on the dimensions, on every value (SHA-256
over all values, x fastest, as little-endian f32) and on spacing and affine in LPS mm. Of volumes of kind RGBA-color all
components count, red first; SimpleITK knows no such kind and is not asked. One line per file; exit code 1 if any differs.
"""

import argparse
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

import nrrd
import numpy as np
import SimpleITK as sitk

# Sign of each world axis in LPS. The frames that do not name the patient's axes are missing: there is no truth to
# compare with beyond the spacing.
TO_LPS = {
    "left-posterior-superior": (1, 1, 1),
    "right-anterior-superior": (-1, -1, 1),
    "left-anterior-superior": (1, -1, 1),
    "LPS": (1, 1, 1),
    "RAS": (-1, -1, 1),
    "LAS": (1, -1, 1),
}
RELATIVE_TOLERANCE = 1e-6


def sha256(array):
    """Hash of an array in the order (x, y, z)."""
    values = array.astype(np.float64)
    finite = np.isfinite(values)
    if not finite.all():
        values[~finite] = values[finite].min()
    # Adding 0 makes one zero of the two.
    values = values.astype("<f4") + np.float32(0)
    return hashlib.sha256(values.tobytes(order="F")).hexdigest()


def scan(dims, digest, affine):
    """What a program says about a file; affine 3 x 4, or its column lengths alone where space is not the patient's."""
    return {"dims": list(dims), "values_sha256": digest, "affine": np.asarray(affine, dtype=float)}


def by_pellucid(binary, path):
    command = [binary, "info", str(path), "--format", "json"]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found = json.loads(output)
    affine = np.asarray(found["index_to_lps_mm"], dtype=float).reshape(3, 4)
    return scan(found["dims"], found["values_sha256"], affine)


def by_pynrrd(path, signs):
    data, header = nrrd.read(str(path), index_order="F")
    if signs is None:
        return scan(data.shape, sha256(data), header["spacings"])
    spatial = [kind in ("domain", "space") for kind in header.get("kinds", ["domain"] * 3)]
    directions = np.asarray(header["space directions"], dtype=float)[spatial]
    world = np.column_stack([directions.T, header["space origin"]])
    # Components first, so that they are what is fastest in memory.
    data = np.moveaxis(data, spatial.index(False), 0) if not all(spatial) else data
    return scan(data.shape[-3:], sha256(data), np.diag(signs) @ world)


def by_simpleitk(path, signs):
    image = sitk.ReadImage(str(path))
    data = sitk.GetArrayViewFromImage(image).transpose(2, 1, 0)
    spacing = np.asarray(image.GetSpacing())
    if signs is None:
        return scan(image.GetSize(), sha256(data), spacing)
    # SimpleITK has converted to LPS itself.
    direction = np.asarray(image.GetDirection()).reshape(3, 3)
    affine = np.column_stack([direction * spacing, image.GetOrigin()])
    return scan(image.GetSize(), sha256(data), affine)


def plainer(path, folder):
    """The same without what pynrrd and SimpleITK do not know: numbered raw files, and a space without directions."""
    copy = pathlib.Path(folder) / path.name
    lines = path.read_text().splitlines()
    oriented = any(line.startswith("space directions:") for line in lines)
    kept = []
    for line in lines:
        name, _, value = line.partition(": ")
        words = value.split()
        if name == "data file" and "%" in words[0]:
            first, last, step = map(int, words[1:4])
            numbers = range(first, last + (1 if step > 0 else -1), step)
            data = b"".join((path.parent / (words[0] % number)).read_bytes() for number in numbers)
            copy.with_suffix(".raw").write_bytes(data)
            kept.append(f"data file: {copy.stem}.raw")
        elif oriented or name != "space":
            kept.append(line)
    copy.write_text("\n".join(kept) + "\n")
    return copy


def differences(found, expected):
    for key in ("dims", "values_sha256"):
        if found[key] != expected[key]:
            yield f"{key}: found {found[key]}, expected {expected[key]}"
    affine, other = found["affine"], expected["affine"]
    if other.ndim == 1:
        affine = np.linalg.norm(affine[:, :3], axis=0)
    scale = np.abs(other).max()
    if not np.allclose(affine, other, rtol=0, atol=RELATIVE_TOLERANCE * scale):
        yield f"affine: found {affine.tolist()}, expected {other.tolist()}"


def check(binary, path):
    """What is wrong with the reading of one file, and what it was compared with."""
    header = nrrd.read_header(str(path))
    colors = header["dimension"] == 4 and "RGBA-color" in header.get("kinds", [])
    if header["dimension"] != 3 and not colors:
        return [], "skipped: neither one volume of scalars nor one of colours with an opacity"
    signs = TO_LPS.get(header.get("space")) if "space directions" in header else None
    found = by_pellucid(binary, path)
    wrong, agreed, refused = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for name, read in (("pynrrd", by_pynrrd), ("SimpleITK", by_simpleitk))[: 1 if colors else 2]:
            try:
                expected = read(plainer(path, folder) if path.suffix == ".nhdr" and signs is None else path, signs)
            except (RuntimeError, OSError, nrrd.NRRDError) as error:
                refused.append(f"{name} cannot read it: {str(error).splitlines()[-1].strip()}")
                continue
            wrong += [f"{name}: {text}" for text in differences(found, expected)]
            agreed.append(name)
    if not agreed:
        wrong.append("no other program reads it: " + "; ".join(refused))
    geometry = "values and affine" if signs else "values and spacing"
    return wrong, "; ".join([f"{geometry} as {' and '.join(agreed)}", *refused])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary", help="the pellucid binary")
    parser.add_argument("folder", type=pathlib.Path, help="the folder of scans")
    arguments = parser.parse_args()
    paths = sorted(p for p in arguments.folder.rglob("*") if p.suffix in (".nrrd", ".nhdr"))
    if not paths:
        sys.exit(f"no NRRD files below {arguments.folder}")
    failed = 0
    for path in paths:
        name = path.relative_to(arguments.folder)
        try:
            wrong, compared = check(arguments.binary, path)
        except subprocess.CalledProcessError as error:
            wrong, compared = [f"pellucid: {error.stderr.strip()}"], ""
        failed += bool(wrong)
        print(f"{name}: " + (f"ok, {compared}" if not wrong else "DIFFERS: " + "; ".join(wrong)), flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
