#!/usr/bin/env python3
"""Instructions per sample of each kernel, as callgrind counts them: numbers that other load on the machine does not disturb.

    python benches/instructions.py PELLUCID [--before OTHER_PELLUCID] [--only WORD ...]

A pipeline is rendered on one thread at two sizes of picture; the difference in instructions over the difference in samples is the
cost of a sample (of `march`) or of an integrated piece of a ray (of `exact`), without loading, macrocells or tables. With
`--before` the same numbers of another program stand beside it, and the exit code is 1 if a kernel takes over 2 % more. Needs
valgrind, which runs AVX2 and no AVX-512.
"""

import re

import counted

SIZES = (24, 48)
WORSE = 1.02


def instructions(program, folder, size, changes):
    """Instructions and samples of a picture."""
    tool = ["--tool=callgrind", f"--callgrind-out-file={folder / 'counts'}"]
    said, method = counted.rendered(tool, program, folder, size, ["volume.phantom.head.size=64", *changes])
    return int(re.search(r"Collected : (\d+)", said).group(1)), method["samples"], method["kernel"]


def per_sample(program, folder, changes):
    """The kernel's name, and instructions per sample."""
    (few, some, _), (many, more, kernel) = (instructions(program, folder, size, changes) for size in SIZES)
    return kernel, [(many - few) / (more - some)]


if __name__ == "__main__":
    counted.report(__doc__, ["instructions per sample"], per_sample, WORSE)
