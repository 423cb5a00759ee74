#!/usr/bin/env python3
"""Bytes of memory that each kernel moves per ray, by cachegrind's model of the caches: numbers that no other load disturbs.

    python benches/traffic.py PELLUCID [--before OTHER_PELLUCID] [--only WORD ...]

A scan of 128 voxels from ear to ear, 16-bit samples in a file, is rendered on one thread at 256 x 256 pixels, and once more by a
camera that looks away, which loads and prepares the same and writes as large a picture. The difference in lines of 64 bytes that
a level of the caches misses, reading or writing, over the rays that meet the volume is what a ray moves: into a first
level of 32 KiB (8-way), which scratch and what neighbouring rays share may enter again and again, and from memory beyond a second
level of 1 MiB (16-way). The model prefetches nothing, evicts what was used longest ago and is the same on every machine.
With `--before` the same numbers of another program stand beside it, and the exit code is 1 if one of them is over 5 % more. Needs
valgrind, which runs AVX2 and no AVX-512.
"""

import re
import subprocess

import counted

SIZE = 256
LINE_BYTES = 64
WORSE = 1.05
CACHES = ["--I1=32768,8,64", "--D1=32768,8,64", "--LL=1048576,16,64"]
LOOKS_AWAY = "camera={ position_mm: [0, -10000, 0], target_mm: [0, -20000, 0] }"


def a_scan(program, folder):
    """Writes the scan; what a pipeline says to read it."""
    path = folder / "head.nrrd"
    subprocess.run([program, "phantom", "head", "--size", "128", "--nrrd", str(path), "-q"], check=True, stdout=subprocess.DEVNULL)
    return [f"volume={{ source: {path} }}"]


def missed(program, folder, changes):
    """Lines that each level misses, and the method by the sidecar."""
    tool = ["--tool=cachegrind", "--cache-sim=yes", *CACHES, f"--cachegrind-out-file={folder / 'counts'}"]
    said, method = counted.rendered(tool, program, folder, SIZE, changes)
    lines = [re.search(rf"{level}\s+misses:\s+([\d,]+)", said).group(1) for level in ("D1", "LLd")]
    return [int(count.replace(",", "")) for count in lines], method


def per_ray(program, folder, changes):
    """The kernel's name, and bytes per ray by level."""
    (with_rays, method), (without, _) = (missed(program, folder, [*changes, *more]) for more in ([], [LOOKS_AWAY]))
    lines = (many - few for many, few in zip(with_rays, without))
    return method["kernel"], [LINE_BYTES * count / method["rays"] for count in lines]


if __name__ == "__main__":
    columns = ["bytes per ray into 32 KiB", "from beyond 1 MiB"]
    counted.report(__doc__, columns, per_ray, WORSE, a_scan)
