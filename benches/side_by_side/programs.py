"""The two programs: pellucid, a process per picture, and VTK, a process that renders frame after frame."""

import json
import shutil
import subprocess
import sys
import time

import numpy as np


class Pellucid:
    """The program, a process per measurement."""

    def __init__(self, program, folder, threads, size):
        self.program, self.threads, self.size = str(program), threads, size
        self.folder = folder

    def run(self, *arguments, codes=(0,)):
        ran = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True)
        if ran.returncode not in codes:
            raise SystemExit(f"pellucid {' '.join(map(str, arguments))}\n{ran.stderr}")
        return ran

    def version(self):
        return self.run("--version").stdout.strip()

    def export(self, pipeline, folder, size=None):
        """The scene of a pipeline for VTK; gives what scene.json says."""
        shutil.rmtree(folder, ignore_errors=True)
        size = size or self.size
        self.run("export-vtk", pipeline, "--set", f"image.size=[{size},{size}]", "-o", folder)
        return json.loads((folder / "scene.json").read_text())

    def render(self, pipeline, integrate, output=None, size=None, threads=None, certify=0, sets=(), file=None):
        """Renders a picture; gives its sidecar, or that of `file`, with seconds by stage and those of the whole process."""
        output, size = output or self.folder / "picture.png", size or self.size
        arguments = [pipeline, "-q", "--threads", threads or self.threads, "--size", f"{size}x{size}", "-o", output]
        for key in (f"integrate={integrate}", *sets):
            arguments += ["--set", key]
        if certify:
            arguments += ["--certify", certify]
        begun = time.perf_counter()
        # A picture that is not within its tolerance is a result, too: exit code 9.
        self.run("render", *arguments, codes=(0, 9))
        seconds = time.perf_counter() - begun
        return read_sidecar(output.with_name(file or output.name)) | {"process_seconds": seconds}

    def seconds(self, *arguments, **options):
        """Seconds of the stage `integrate` of a process's only picture: macrocells and all else it needs beyond the voxels."""
        return self.render(*arguments, **options)["seconds"]["integrate"]

    def frames(self, pipeline, integrate, sets=(), threads=None):
        """The same view twice with one set-up, as VTK renders frame after frame. Gives the second's sidecar, with `seconds` of the
        frame, `first_seconds` of the first, and `setup_seconds` of all that a process does before it could render one."""
        sets = ("views={ cameras: [{}, {}] }", *sets)
        first = self.render(pipeline, integrate, self.folder / "frame.png", threads=threads, sets=sets, file="frame-1.png")
        second = read_sidecar(self.folder / "frame-2.png")
        frame = second["seconds"]["integrate"]
        once = first["seconds"]["integrate"] - frame + sum(
            seconds for stage, seconds in first["seconds"].items() if stage not in ("integrate", "encode")
        )
        times = {"frame_seconds": frame, "first_seconds": first["seconds"]["integrate"], "setup_seconds": once}
        return second | times

    def largest_difference(self, reference, test):
        """Largest difference of a channel, linear, and how many pixels are above 1/255."""
        ran = self.run("compare", reference, test, "--tolerance", "1/255", "--format", "json", codes=(0, 9))
        comparison = json.loads(ran.stdout)["comparison"]
        return comparison["max_abs_all"], comparison["pixels_over"] / comparison["pixels"]


def read_sidecar(picture):
    """The sidecar of a picture, with `seconds` by stage."""
    sidecar = json.loads((picture.parent / (picture.name + ".json")).read_text())
    return sidecar | {"seconds": {stage["stage"]: stage["seconds"] for stage in sidecar["stages"]}}


class VtkFrames:
    """VTK's fixed-point mapper on an exported scene, kept alive. Its first frame, with the normals, is set-up."""

    def __init__(self, folder, samples, threads):
        # The samples as the scanner wrote them: the exported floats would cost VTK memory and time.
        np.save(folder / "volume.npy", samples)
        command = [sys.executable, folder / "render.py", "--frames", "--mapper", "cpu", "--threads", threads]
        self.process = subprocess.Popen(
            list(map(str, command)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.facts = self.answer()

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"VTK stopped\n{self.process.stderr.read()}")
        facts = json.loads(line)
        self.peak_memory_bytes = facts["peak_memory_bytes"]
        return facts

    def seconds(self, step_mm, output=None):
        """Renders a frame, and writes it where told."""
        self.process.stdin.write(f"{step_mm}{f' {output}' if output else ''}\n")
        self.process.stdin.flush()
        return self.answer()["seconds"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.process.stderr.close()


def read_samples(path):
    """Samples of a NRRD file as `scenes.Volume` writes it, slices first."""
    raw = path.read_bytes()
    end = raw.index(b"\n\n")
    sizes = next(line for line in raw[:end].decode().splitlines() if line.startswith("sizes: "))
    dims = [int(n) for n in sizes.split()[1:]]
    return np.frombuffer(raw[end + 2 :], "<i2").reshape(dims[::-1])
