"""What is measured. Programs take turns, so that whatever else the machine does falls on both; seconds are medians."""

import os
import pathlib
import statistics
import subprocess
from dataclasses import dataclass, field

from . import scenes
from .programs import VtkFrames, read_samples

EXACT = "{ exact: { tolerance: 1/255 } }"
# VTK's CPU mapper stops a ray where less than 255 of 32767 parts, 0.78 %, get through. A fourth of that costs no visible accuracy,
# and less than VTK gives away.
MARCH = "{ march: { step_voxels: 1/2, termination_transmittance: 1/512 } }"
METHODS = (("exact", EXACT), ("march", MARCH))
# Of what is measured beside frames.
FIRST = ", first picture"
# Width of the pictures whose every pixel is held against the oracle.
TRUTH_SIZE = 192
# VTK's highlight is Phong's, not Blinn's: lit, it is held against a fine march with its own formula.
VTK_LIT_TRUTH = "{ march: { step_voxels: 1/16, reflection: vtk-phong } }"


@dataclass
class SceneResult:
    """Medians and errors of one view, lit or not."""

    name: str
    lit: bool
    seconds: dict = field(default_factory=dict)
    # Median of the ratios of one round: VTK's time by pellucid's.
    ratio: dict = field(default_factory=dict)
    largest_error: dict = field(default_factory=dict)
    over: int = 0
    certified: int = 0
    peak_memory_bytes: dict = field(default_factory=dict)
    setup_seconds: dict = field(default_factory=dict)
    ns_per_sample: dict = field(default_factory=dict)
    rays_per_second: dict = field(default_factory=dict)
    # Pieces of cells, or samples.
    samples_per_second: dict = field(default_factory=dict)
    vtk_share_over: float = 0.0
    vtk_version: str = ""
    raw_bytes: int = 0


def scene(pellucid, view, volume, folder, lit, rounds, certify):
    """Frames in turns, and errors of both programs."""
    pipeline = scenes.pipeline(view, volume, folder, lit)
    step_mm = 0.5 * min(volume.spacing_mm)
    result = SceneResult(view.name, lit, raw_bytes=volume.raw_bytes)
    samples = read_samples(volume.path)
    pellucid.export(pipeline, folder / "vtk")
    seconds = {"exact": [], "march": [], "vtk": []}
    with VtkFrames(folder / "vtk", samples, pellucid.threads) as vtk:
        vtk.seconds(step_mm)
        for turn in range(rounds):
            work = {
                "vtk": lambda: vtk.seconds(step_mm),
                "exact": lambda: timed(pellucid, pipeline, EXACT, "exact", result),
                "march": lambda: timed(pellucid, pipeline, MARCH, "march", result),
            }
            order = list(work)
            for name in order[turn % 3 :] + order[: turn % 3]:
                seconds[name].append(work[name]())
        result.peak_memory_bytes["vtk"] = vtk.peak_memory_bytes
        result.vtk_version = vtk.facts["vtk"]
        result.setup_seconds["vtk"] = vtk.facts["load_seconds"] + vtk.facts["first_frame_seconds"]
    result.seconds = {name: statistics.median(s) for name, s in seconds.items()}
    for name in ("exact", "march"):
        result.ratio[name] = statistics.median(v / s for v, s in zip(seconds["vtk"], seconds[name]))
    certificate = pellucid.render(pipeline, EXACT, certify=certify)["certificate"]
    result.over, result.certified = certificate["above_tolerance"], certificate["pixels"]
    result.largest_error["exact"] = certificate["largest_error"]
    errors(pellucid, pipeline, folder, samples, step_mm, result)
    return result


def timed(pellucid, pipeline, integrate, name, result):
    sidecar = pellucid.frames(pipeline, integrate)
    result.peak_memory_bytes[name] = max(sidecar["peak_memory_bytes"], result.peak_memory_bytes.get(name, 0))
    result.setup_seconds[name] = sidecar["setup_seconds"]
    frame = sidecar["frame_seconds"]
    rays, samples = sidecar["method"]["rays"], sidecar["method"]["samples"]
    result.ns_per_sample.setdefault(name, 1e9 * frame * sidecar["threads"] / samples)
    result.rays_per_second.setdefault(name, rays / frame)
    result.samples_per_second.setdefault(name, samples / frame)
    return frame


def errors(pellucid, pipeline, folder, samples, step_mm, result):
    """Largest errors over all pixels of a smaller picture of the view, of which the oracle computes each."""
    truth, test, frame = folder / "truth.exr", folder / "march.exr", folder / "frame.npy"
    pellucid.render(pipeline, "reference", truth, size=TRUTH_SIZE)
    pellucid.render(pipeline, MARCH, test, size=TRUTH_SIZE)
    result.largest_error["march"], _ = pellucid.largest_difference(truth, test)
    pellucid.export(pipeline, folder / "vtk", size=TRUTH_SIZE)
    with VtkFrames(folder / "vtk", samples, pellucid.threads) as vtk:
        vtk.seconds(step_mm, frame)
    if result.lit:
        pellucid.render(pipeline, VTK_LIT_TRUTH, truth, size=TRUTH_SIZE)
    result.largest_error["vtk"], result.vtk_share_over = pellucid.largest_difference(truth, frame)


def two_dimensional_memory(pellucid, view, volume, folder):
    """Peak memory with a transfer function of value and gradient magnitude, lit, by method. Small pictures: memory is of the volume."""
    pipeline = scenes.pipeline(view, volume, folder, lit=True, two_d=True)
    return {name: pellucid.render(pipeline, integrate, size=128)["peak_memory_bytes"] for name, integrate in METHODS}


def threads(pellucid, pipeline, rounds):
    """Median over the rounds of one thread's time by that of two, for each method: of a frame, and of a process's first picture."""
    speedups = {}
    for name, integrate in METHODS:
        pairs = [[pellucid.frames(pipeline, integrate, threads=n) for n in (1, 2)] for _ in range(rounds)]
        for what, key in (("", "frame_seconds"), (FIRST, "first_seconds")):
            speedups[name + what] = statistics.median(one[key] / two[key] for one, two in pairs)
    return speedups


def picture_sizes(pellucid, pipeline, sizes, rounds):
    """Seconds by width of the picture."""
    return {name: by(sizes, rounds, lambda n, i=i: pellucid.seconds(pipeline, i, size=n)) for name, i in METHODS}


def fits_memory(edge):
    """Whether a synthetic head of so many voxels from ear to ear can be made and rendered: three times its samples."""
    return 3 * 2 * edge**3 < os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_AVPHYS_PAGES")


def volume_edges(pellucid, folder, edges, rounds):
    """Seconds of a frame of the synthetic head by its number of voxels from ear to ear, and of a process's first picture, for which
    every voxel is looked at."""
    pipeline = folder / "head.yaml"
    text = "version: 1\nvolume: { source: head.nrrd }\ntransfer_function:\n  - widgets:\n    - points:\n"
    text += scenes.points("bone")
    pipeline.write_text(text + "\ncamera: { view: anterior, azimuth: 30, elevation: 20 }\n")
    sources = {}
    for edge in edges:
        sources[edge] = folder / f"head-{edge}.nrrd"
        if not sources[edge].exists():
            pellucid.run("phantom", "head", "--size", edge, "--nrrd", sources[edge], "-q")

    found = {}
    for name, integrate in METHODS:
        frames, firsts = {n: [] for n in edges}, {n: [] for n in edges}
        for _ in range(rounds):
            for n in edges:
                sidecar = pellucid.frames(pipeline, integrate, sets=(f"volume.source={sources[n]}",))
                frames[n].append(sidecar["frame_seconds"])
                firsts[n].append(sidecar["first_seconds"])
        medians = lambda by: {n: statistics.median(seconds) for n, seconds in by.items()}
        found |= {name: medians(frames), name + FIRST: medians(firsts)}
    return found


def by(numbers, rounds, seconds):
    """Medians, by number; each round visits every number."""
    found = {n: [] for n in numbers}
    for _ in range(rounds):
        for n in numbers:
            found[n].append(seconds(n))
    return {n: statistics.median(s) for n, s in found.items()}


def cold_start(pellucid, view, volume, series, folder, rounds):
    """Seconds of the process from a folder of DICOM files that no cache holds to the picture, and how the cache was emptied."""
    pipeline = scenes.pipeline(view, volume, folder, lit=False)
    # The series lies elsewhere in space than the volume that was made of it.
    moved = (f"volume.source={series}", "camera={ view: anterior, azimuth: 35, elevation: 20, zoom: 1.3 }")
    files = [*pathlib.Path(series).iterdir(), pathlib.Path(pellucid.program)]
    seconds, stages, emptied = [], {}, ""
    for _ in range(rounds):
        emptied = empty_cache(files)
        sidecar = pellucid.render(pipeline, EXACT, sets=moved)
        seconds.append(sidecar["process_seconds"])
        stages = sidecar["seconds"]
    return statistics.median(seconds), stages, emptied


def empty_cache(files):
    """Empties the system's cache of files, or takes these files out of it."""
    subprocess.run(["sync"], check=False)
    try:
        pathlib.Path("/proc/sys/vm/drop_caches").write_text("3\n")
        return "the system's cache of files was emptied"
    except OSError:
        for path in files:
            with open(path, "rb") as file:
                os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
        return "the files of the series and the program were taken out of the cache of files (`posix_fadvise`)"
