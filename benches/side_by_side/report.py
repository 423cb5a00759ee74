"""Tables in Markdown, and whether what issue 6 asks for was seen to hold."""

import datetime
import math
import os
import platform

from .measure import FIRST, METHODS

MB = 1e6


def machine(facts):
    """What ran where and when."""
    model = platform.processor() or platform.machine()
    flags = ""
    try:
        with open("/proc/cpuinfo") as file:
            lines = dict(line.split(":", 1) for line in file.read().split("\n\n")[0].splitlines() if ":" in line)
        lines = {key.strip(): value.strip() for key, value in lines.items()}
        # The name of a rented processor may hide which one it is.
        model = f"{lines.get('model name', model)}, family {lines.get('cpu family', '?')} model {lines.get('model', '?')}"
        flags = ", ".join(name for name in ("avx2", "avx512f") if name in lines.get("flags", "").split())
    except OSError:
        pass
    load = ", ".join(f"{x:.1f}" for x in os.getloadavg())
    return (
        f"{datetime.date.today()} · {model}, {os.cpu_count()} cores ({flags or 'no AVX'}), {platform.system()} · "
        f"{facts['threads']} threads · {facts['pellucid']} · VTK {facts['vtk']}, fixed-point mapper · load of the machine at "
        f"the end (1, 5, 15 min): {load} · the run took {facts['minutes']:.0f} min"
    )


def table(head, rows, numbers=True):
    align = ["---"] + ["--:" if numbers else "---"] * (len(head) - 1)
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in (head, align, *rows))


def seconds(value):
    return f"{value:.3f}" if value < 1 else f"{value:.2f}"


def scenes_table(results):
    head = ["scene", "VTK ½ voxel, s", "exact 1/255, s", "VTK / exact", "march ½ voxel, s", "VTK / march",
            "exact: pixels over", "max error: exact", "march", "VTK", "VTK: pixels over"]
    rows = [
        [
            f"{r.name}{', lit' if r.lit else ''}", seconds(r.seconds["vtk"]), seconds(r.seconds["exact"]),
            f"{r.ratio['exact']:.2f}", seconds(r.seconds["march"]), f"{r.ratio['march']:.2f}",
            f"{r.over} of {r.certified}", *(f"{r.largest_error[name]:.4f}" for name in ("exact", "march", "vtk")),
            f"{100 * r.vtk_share_over:.0f} %",
        ]
        for r in results
    ]
    return table(head, rows)


def resources_table(results):
    head = ["scene", "raw volume, MB", "peak memory, MB: exact", "march", "VTK and Python", "set-up, s: exact", "march",
            "VTK", "ns per piece, exact", "ns per sample, march", "million rays/s: exact", "march",
            "million pieces/s, exact", "million samples/s, march"]
    rows = [
        [
            f"{r.name}{', lit' if r.lit else ''}", f"{r.raw_bytes / MB:.0f}",
            *(f"{r.peak_memory_bytes[name] / MB:.0f}" for name in ("exact", "march", "vtk")),
            *(seconds(r.setup_seconds[name]) for name in ("exact", "march", "vtk")),
            *(f"{r.ns_per_sample[name]:.0f}" for name in ("exact", "march")),
            *(f"{r.rays_per_second[name] / 1e6:.1f}" for name in ("exact", "march")),
            *(f"{r.samples_per_second[name] / 1e6:.0f}" for name in ("exact", "march")),
        ]
        for r in results
    ]
    return table(head, rows)


def by_number(what, measured):
    """Seconds of each method by a number, and of each pixel or edge."""
    numbers = list(next(iter(measured.values())))
    return table([what, *numbers], [[name, *(seconds(s) for s in by.values())] for name, by in measured.items()])


def exponent(by):
    """Slope in log-log between the first and the last number: 1 is growth in proportion."""
    (first, a), *_, (last, b) = by.items()
    return math.log(b / a) / math.log(last / first)


def targets(facts, results):
    """`(what, target, found, holds, stretch holds or None)` for each thing to be seen."""
    unlit, lit = [r for r in results if not r.lit], [r for r in results if r.lit]
    least = lambda rs, name: min((r.ratio[name] for r in rs), default=math.nan)
    over = lambda rs: sum(r.over for r in rs)
    rows = []
    for n, what, rs, need, stretch in ((1, "unshaded", unlit, 2, 4), (2, "shaded, bound estimated", lit, 1, 2)):
        pixels = sum(r.certified for r in rs)
        found = f"{over(rs)} of {pixels} pixels over; slowest scene {least(rs, 'exact'):.2f} ×"
        need_text = f"0 pixels over 1/255, VTK's time / ours ≥ {need} (stretch {stretch})"
        ok = over(rs) == 0
        rows.append((f"{n}. `exact` 1/255, {what}", need_text, found,
                     ok and least(rs, "exact") >= need, ok and least(rs, "exact") >= stretch))
    worse = [r.name + (", lit" if r.lit else "") for r in results if r.largest_error["march"] > r.largest_error["vtk"]]
    found = f"slowest scene {least(results, 'march'):.2f} ×; error larger than VTK's: {', '.join(worse) or 'none'}"
    rows.append(("3. `march` ½ voxel", "VTK's time / ours ≥ 3 (stretch 6), max error ≤ VTK's", found,
                 not worse and least(results, "march") >= 3, not worse and least(results, "march") >= 6))
    allowed = lambda r: 1.3 * r.raw_bytes + 64 * MB
    shares = [(r.peak_memory_bytes[m] / allowed(r), r.name, m) for r in results for m in ("exact", "march")]
    share, name, method = max(shares)
    rows.append(("4. Peak memory, 1D, all scenes", "≤ 1.3 × raw + 64 MB", f"at most {share:.2f} of that ({name}, {method})", share <= 1, None))
    if "memory_2d" in facts:
        ratios = {name: peak / facts["memory_2d_raw"] for name, peak in facts["memory_2d"].items()}
        found = ", ".join(f"{name} {ratio:.2f} ×" for name, ratio in ratios.items())
        rows.append(("4. Peak memory, 2D, lit", "≤ 2 × raw", found, max(ratios.values()) <= 2, None))
    for key, what, unit, need, holds in (
        ("speedup", "Two threads instead of one", "{:.2f} ×", "≥ 1.85 ×", lambda numbers: min(numbers) >= 1.85),
        ("edge_exponent", "Time by the volume's edge", "edge^{:.2f}", "≤ edge^1 from 128 to 512 voxels",
         lambda numbers: max(numbers) <= 1),
    ):
        for which, end in (("a frame", ""), ("first pictures, every voxel looked at", FIRST)):
            some = {name: facts[key][name + end] for name, _ in METHODS if key in facts}
            if some:
                found = ", ".join(f"{name} {unit.format(number)}" for name, number in some.items())
                rows.append((f"5. {what}: {which}", need, found, holds(some.values()), None))
    if "cold" in facts:
        found = f"{facts['cold'][0]:.2f} s"
        rows.append(("8. First frame from a cold start", "< 3 s", found, facts["cold"][0] < 3, None))
    return rows


def markdown(facts, results):
    """RESULTS.md."""
    yes = lambda holds: "—" if holds is None else ("yes" if holds else "**no**")
    parts = [
        "# Side by side with VTK", machine(facts),
        f"Written by `benches/peers.py`; [README.md](README.md) says how it measures. Frames of {facts['size']}² pixels in "
        f"{facts['rounds']} rounds in which the programs take turns; medians. Ratios are medians of each round's; those "
        "above 1 say that pellucid is quicker. Errors are of a channel, linear, over black.",
        "## What should hold",
        table(["", "asked for", "found", "holds", "stretch"],
              [[what, need, found, yes(ok), yes(stretch)] for what, need, found, ok, stretch in targets(facts, results)], numbers=False),
        "## Time and error", scenes_table(results), "## Memory and set-up", resources_table(results),
    ]
    if "speedup" in facts:
        parts += ["## Threads", "Skull phantom, bone. Time of one thread by that of two: "
                  + "; ".join(f"{name} {x:.2f}" for name, x in facts["speedup"].items()) + "."]
    if "sizes" in facts:
        parts += ["## Size of the picture", "Skull phantom, bone; seconds by width and height in pixels.",
                  by_number("pixels", facts["sizes"])]
    if "edges" in facts:
        parts += ["## Size of the volume", "Synthetic head, bone; seconds by voxels from ear to ear.",
                  by_number("voxels", facts["edges"])]
    if "cold" in facts:
        total, stages, emptied = facts["cold"]
        listed = ", ".join(f"{name} {seconds(s)} s" for name, s in stages.items())
        parts += ["## Cold start", f"140 DICOM files to a picture within 1/255, the whole process: {total:.2f} s "
                  f"({listed}); {emptied}."]
    return "\n\n".join(parts) + "\n"
