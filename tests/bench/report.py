"""Runs the benchmarks and prints tables: report.py FOLDER-OF-PROGRAMS [PARTS …]

Programs that are compared are measured alternately, and the median of the ratios is reported, because the speed of a
shared machine changes from minute to minute.
"""

import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import drawing
import peers
from programs import BIN, load, pictures, point_on_page

PARTS = ("targets", "parts", "growth", "polytopes", "whole", "fields", "export", "drawing", "load",
         "pointing")
PAGE = Path(__file__).resolve().parents[2] / "web_client/dist"
AT_FRAMES = "pointing at frames, "  # rows of bench_load that begin so are about pointing
REGULAR = ("5-cell", "8-cell", "120-cell", "600-cell")
GROWING = ("5-cell", "8-cell", "24-cell", "omnitruncated 5-cell", "120-cell", "600-cell", "omnitruncated 24-cell",
           "truncated 120-cell", "cantitruncated 120-cell", "omnitruncated 120-cell")
WHOLE = ("8-cell", "24-cell", "120-cell", "600-cell")
WHOLE_VARIANTS = {"slices alone": {}, "with the projection": {"projection": "perspective"},
                  "with a highlighted cell": {"highlight": "cell:1"},
                  "with both": {"projection": "perspective", "highlight": "cell:1"}}
PAGE_FRAME = 16.7  # milliseconds between two pictures on a display
STARS = ("small stellated 120-cell", "great stellated 120-cell", "great grand stellated 120-cell")
TURNS = 5         # how often frames are measured
QUICK_TURNS = 11  # how often operations of less than a millisecond are measured


def number(value):
    """Formats a number with three significant digits, numbers from 100 on as integers, and None as a dash."""
    if value is None:
        return "—"
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:.3g}"


def table(head, rows):
    """Prints a table; all columns but the first are right-aligned."""
    print(f"\n| {' | '.join(head)} |\n| --- |{' --: |' * (len(head) - 1)}")
    for row in rows:
        print(f"| {' | '.join(cell if isinstance(cell, str) else number(cell) for cell in row)} |")
    sys.stdout.flush()


def exponent(points):
    """Returns the slope of the least-squares line through the points (log size, log time)."""
    xs, ys = [math.log(size) for size, _ in points], [math.log(ms) for _, ms in points]
    x0, y0 = statistics.mean(xs), statistics.mean(ys)
    return sum((x - x0) * (y - y0) for x, y in zip(xs, ys)) / sum((x - x0) ** 2 for x in xs)


class Turns:
    """Alternate measurements of oval4d and of the other programs: lists with one entry per turn."""

    def __init__(self):
        self.quick, self.js, self.frames, self.vtk = [], [], [], []
        for _ in range(QUICK_TURNS):
            self.js.append({} if peers.why_no_js() else peers.js())
            self.quick.append({name: pictures(name, frames=0) for name in REGULAR})
        with_vtk = not peers.why_no_vtk()
        for _ in range(TURNS):
            ours, theirs = {}, {}
            for name in REGULAR:  # by turns, because the machine's speed changes
                ours[name] = pictures(name)
                theirs.update({(name, way): peers.vtk(name, way) for way in peers.VTK if with_vtk})
            self.frames.append(ours)
            self.vtk.append(theirs)

    @staticmethod
    def compare(ours, theirs):
        """Returns the medians of `ours`, of `theirs`, and of the ratio theirs ÷ ours in each turn. The last two are
        None if `theirs` were not measured."""
        if None in theirs:
            return statistics.median(ours), None, None
        return (statistics.median(ours), statistics.median(theirs),
                statistics.median(their / our for our, their in zip(ours, theirs, strict=True)))

    def _ours(self, kind, name, what):
        turns = self.quick if what in self.quick[0][name][kind] else self.frames
        return [turn[name][kind][what] for turn in turns]

    def ms(self, name, step):
        return self._ours("ms", name, step)

    def bytes(self, name, what):
        return self._ours("bytes", name, what)

    def js_of(self, name, what):
        return [turn.get(name, {}).get(what) for turn in self.js]

    def vtk_of(self, name, way):
        return [turn.get((name, way)) for turn in self.vtk]


def targets(turns, loaded, wholes, pointed):
    """Prints each performance target with oval4d's figure, the other program's, and the ratio."""
    rows = []

    def row(what, target, figures, reached, unit=" ms"):
        figure, peer, ratio = figures
        rows.append([what, target, number(figure) + unit, "—" if peer is None else number(peer) + unit,
                     number(ratio), "?" if reached is None else "yes" if reached else "**no**"])

    def at_least(what, least, figures, unit=" ms"):
        row(what, f"≥ {least} ×", figures, None if figures[2] is None else figures[2] >= least, unit)

    def at_most(what, most, figure, unit, beside=""):
        rows.append([what, f"≤ {most}{unit}", number(figure) + unit + beside, "—", "—",
                     "yes" if figure <= most else "**no**"])

    for name in REGULAR:
        for way, least in (("peeling", 10), ("fastest", 5)):
            at_least(f"whole frame, {name}, against VTK {way}", least,
                     turns.compare(turns.ms(name, "frame"), turns.vtk_of(name, way)))
    for name, least in (("5-cell", 18), ("600-cell", 11)):
        at_least(f"PNG, {name}, against libpng level 1", least,
                 turns.compare(turns.ms(name, "encode"), turns.ms(name, "libpng")))
        figure, peer, ratio = turns.compare(turns.bytes(name, "frame"), turns.bytes(name, "libpng"))
        row(f"PNG, {name}, size", "≤ 1.05 of libpng's", (figure, peer, 1 / ratio), 1 / ratio <= 1.05, " B")
    for name in REGULAR:
        at_least(f"slicing, {name}, against JavaScript", 10,
                 turns.compare(turns.ms(name, "slice"), turns.js_of(name, "slice_ms")))
    rate = statistics.median(sum(turn["600-cell"]["cut"]) / turn["600-cell"]["ms"]["slice"] / 1e3
                             for turn in turns.quick)
    row("slicing, 600-cell, elements a second", "≥ 50 million", (rate, None, None), rate >= 50, " million")
    for name in REGULAR:
        at_least(f"slices as JSON, {name}, against JSON.stringify", 10,
                 turns.compare(turns.ms(name, "json"), turns.js_of(name, "json_ms")))
        at_least(f"slices as CBOR, {name}, against our JSON", 3,
                 turns.compare(turns.ms(name, "cbor"), turns.ms(name, "json")))
        figure, peer, ratio = turns.compare(turns.bytes(name, "cbor"), turns.bytes(name, "json"))
        row(f"slices as CBOR, {name}, size", "≤ 0.5 of JSON's", (figure, peer, 1 / ratio), 1 / ratio <= 0.5, " B")
    key = loaded["key to frame, 5-cell"]
    at_most("key to frame over a socket, 5-cell, median", 8, key["median"], " ms")
    at_most("the same, 99th percentile in medians", 2, key["p99"] / key["median"], "")
    at_most("1000 idle sessions", 100, loaded["1000 idle sessions"]["more"], " MB")
    many = loaded["200 sessions at 10 keys/s, slices of the 5-cell"]
    at_most("200 sessions at 10 keys/s, 99th percentile", 50, many["p99"], " ms")
    for what, figures in loaded.items():
        if what.startswith(AT_FRAMES):
            at_most(f"element at a point of a frame over a socket, {what.removeprefix(AT_FRAMES)}, median", 10,
                    figures["median"], " ms",
                    f" (95th percentile {number(figures['p95'])}, 99th {number(figures['p99'])})")
    for name in dict.fromkeys(part["polytope"] for part in pointed):
        works = [part[picture].get("work") for part in pointed if part["polytope"] == name
                 for picture in ("first", "second")]
        longest = max(filter(None, works), key=lambda work: work["median"])
        at_most(f"pointing on the page, {name}: scripts for one of the pictures, median", PAGE_FRAME,
                longest["median"], " ms", f" (95th percentile {number(longest['p95'])})")
    for name in ("24-cell", "120-cell", "600-cell"):
        at_most(f"frame with the projection and a highlight, {name}, relative to one without", 1.15,
                whole_ratio(wholes[name], "with both"), "")
    at_most("all files of the page, compressed with gzip", 250,
            sum(file.stat().st_size for file in PAGE.glob("*.gz")) / 1024, " KB")
    for what in ("frame", "state to json", "state to cbor"):
        worst = max(turn[name]["allocations"][what] for turn in turns.frames for name in REGULAR)
        at_most(f"allocations, {what}", 0, math.floor(worst), "")
    print("\n## Targets\n\nA ratio says how many times faster oval4d is; for sizes, it is oval4d's size divided by the other's.")
    table(["", "target", "oval4d", "other", "ratio", "reached"], rows)


def parts(turns):
    """Prints the time of each step of a picture."""
    print("\n## Parts\n\n21 slices at 1280 × 720; milliseconds, JavaScript's and VTK's in brackets.")
    rows = []
    for name in REGULAR:
        slicing = turns.compare(turns.ms(name, "slice"), turns.js_of(name, "slice_ms"))
        text = turns.compare(turns.ms(name, "json"), turns.js_of(name, "json_ms"))
        png = turns.compare(turns.ms(name, "encode"), turns.ms(name, "libpng"))
        frame = turns.compare(turns.ms(name, "frame"), turns.vtk_of(name, "fastest"))
        rows.append([name, *(number(statistics.median(turns.ms(name, step)))
                             for step in ("compose", "draw")),
                     *(f"{number(ours)} ({number(theirs)})" for ours, theirs, _ in (slicing, png, text)),
                     *(number(statistics.median(turns.ms(name, step)))
                       for step in ("cbor", "state to json", "state to cbor")),
                     f"{number(frame[0])} ({number(frame[1])})"])
    table(["", "scene", "render", "slice", "PNG", "JSON", "CBOR", "state to JSON", "state to CBOR", "state to PNG"], rows)
    cut = turns.quick[0]
    theirs = turns.js[0]
    table(["vertices, edges, faces cut", "oval4d", "JavaScript"],
          [[name, ", ".join(map(number, cut[name]["cut"])),
            ", ".join(number(theirs[name][kind]) for kind in ("balls", "bars", "faces")) if theirs else "—"]
           for name in REGULAR])


def growth():
    """Prints how times grow with the size of the polytope, the number of slices and the number of pixels."""
    steps = ("slice", "json", "cbor", "draw", "encode", "frame")

    def grow(title, runs, unit, size):
        print(f"\n### {title}")
        table(["", unit, *steps], [[label, size(run), *(run["ms"][step] for step in steps)] for label, run in runs])
        for step in steps:
            points = [(size(run), run["ms"][step]) for _, run in runs]
            print(f"{step} ∝ {unit}^{exponent(points):.2f} (larger half: ^{exponent(points[len(points) // 2:]):.2f})  ")

    print("\n## Growth\n\nMilliseconds.")
    grow("By the polytope: 21 slices, 1280 × 720", [(name, pictures(name, frames=8)) for name in GROWING],
         "elements cut", lambda run: sum(run["cut"]))
    grow("By the number of slices: the 600-cell, 1280 × 720",
         [(f"{count} slices", pictures("600-cell", count, frames=8)) for count in (1, 3, 11, 21, 51, 101, 201)],
         "slices", lambda run: run["slices"])
    for name in ("5-cell", "600-cell"):
        grow(f"By pixels: the {name}, 21 slices",
             [(f"{width} × {width * 9 // 16}", pictures(name, 21, width, width * 9 // 16, 8))
              for width in (256, 640, 1280, 1920, 3840)], "pixels", lambda run: run["pixels"])


def polytopes():
    """Prints the times to build polytopes and to read files."""
    done = subprocess.run([BIN / "bench_polytopes", "--benchmark_format=json", "--benchmark_min_time=0.1"],
                          capture_output=True, text=True, check=True)
    runs = json.loads(done.stdout)["benchmarks"]
    print("\n## Polytopes: building and reading")
    table(["", "elements or bytes", "ms"],
          [[f"{run['name'].split('/')[0]}: {run['label']}", run.get("size", run.get("bytes")), run["real_time"]]
           for run in runs])
    built = [(run["size"], run["real_time"]) for run in runs if run["name"].startswith("build")]
    print(f"\nbuild ∝ elements^{exponent(built):.2f}")


def whole_turns():
    """Returns for each polytope of WHOLE a list with one entry per turn: the milliseconds of a frame in each of
    WHOLE_VARIANTS, which are measured one after the other."""
    return {polytope: [{what: pictures(polytope, frames=20, **settings)["ms"]["frame"]
                        for what, settings in WHOLE_VARIANTS.items()} for _ in range(TURNS)] for polytope in WHOLE}


def whole_ratio(turns, what):
    """Returns the median of the ratios, in each turn, of a frame in the variant `what` to one with slices alone."""
    return statistics.median(turn[what] / turn["slices alone"] for turn in turns)


def whole(wholes):
    """Prints how much the projection of the whole object and a highlighted element add to a frame."""
    print("\n## The whole object: milliseconds from a state to its frame, 21 slices, 1280 × 720\n\n"
          f"Medians of {TURNS} turns; in each turn, all variants are measured one after the other.")
    added = list(WHOLE_VARIANTS)[1:]
    table(["", "slices alone, ms", *(f"{what}, relative" for what in added)],
          [[polytope, statistics.median(turn["slices alone"] for turn in turns),
            *(whole_ratio(turns, what) for what in added)] for polytope, turns in wholes.items()])


# The functions that vtk_field.py shows. Arrays and formulas differ only in the source of the values.
FIELDS = {
    "tiger": "(sqrt(x^2+y^2)-1)^2 + (sqrt(z^2+w^2)-0.7)^2 - 0.09",
    "blobs": "0.6 - (" + " + ".join(
        f"exp(-((x-({math.cos(0.785 * a)}))^2 + (y-({math.sin(0.785 * a)}))^2 + (z-({0.6 * math.cos(2.4 * a)}))^2)"
        "/(0.16+0.2*(w+1.6)))" for a in range(8)) + ")*(0.09/(0.04+0.05*(w+1.6)))^1.5",
    "flow": "1.2 - exp(-(pi/2)^2*(w+1.6)/4)*pi/4*sqrt(" + " + ".join(
        f"(exp(pi/4*{a})*sin(pi/4*{b}+pi/2*{c}) + exp(pi/4*{c})*cos(pi/4*{a}+pi/2*{b}))^2"
        for a, b, c in ("xyz", "yzx", "zxy")) + ")",
}


def sampled(field, file, side=64):
    """Writes a field of vtk_field.py as an array with `side` samples along each of the axes t, z, y, x."""
    program = """
import sys, numpy
source = open(sys.argv[1]).read().split("def main")[0]
exec(source)
side = int(sys.argv[4])
g = numpy.linspace(-1.6, 1.6, side, dtype=numpy.float32)
z, y, x = numpy.meshgrid(g, g, g, indexing="ij", sparse=True)
values = numpy.lib.format.open_memmap(sys.argv[3], "w+", numpy.float32, (side,) * 4)
for moment, t in enumerate(g):
    values[moment] = FIELDS[sys.argv[2]](x, y, z, t)
"""
    subprocess.run(["/usr/bin/python3", "-c", program, peers.FOLDER / "vtk_field.py", field, file, str(side)], check=True)


def fields():
    """Prints the times of fields, as arrays and as formulas, beside scipy and VTK; and of arrays with fog."""
    print("\n## Fields: milliseconds from a state to its PNG, 21 slices, 1280 × 720\n\n"
          "Arrays of 64⁴ samples. Medians of three turns; in each turn, all are measured one after the other.")
    if why := peers.why_no_fields():
        print(f"\nNot measured: {why}.")
        return
    shown = {"spacing": "0.12", "levels": "0", "inside": "below"}
    box = {"box": ",".join(["-1.6", "1.6"] * 4)}
    rows = []
    for field, formula in FIELDS.items():
        with tempfile.TemporaryDirectory(prefix="oval4d-") as folder:
            file = Path(folder, f"{field}.npy")
            sampled(field, file)
            turns = [(pictures(file, frames=12, **shown),
                      pictures("formula", frames=12, formula=formula, **box, **shown),
                      pictures(file, frames=12, fog="-1:0.9,0:0.5,0.5:0", **shown),
                      peers.vtk_field(field)["whole"]) for _ in range(3)]
        times = [(*(ours["ms"]["frame"] for ours in turn[:3]), turn[3]) for turn in turns]
        rows.append([field, *(statistics.median(column) for column in zip(*times)),
                     *(statistics.median(turn[3] / turn[i] for turn in times) for i in (0, 1)),
                     *(1e3 / statistics.median(turn[i]["ms"]["draft"] for turn in turns) for i in (0, 1)),
                     max(count for turn in turns for ours in turn[:3] for count in ours["allocations"].values())])
    table(["", "array, ms", "formula, ms", "array with fog, ms", "scipy and VTK, ms", "ratio, array", "ratio, formula",
           "drafts a second, array", "drafts a second, formula", "most allocations a picture or message"], rows)
    print("\nTargets: ratios ≥ 20, at least 30 drafts a second (the pictures while the object turns), no allocations.")
    field_growth(shown)


def field_growth(settings):
    """Prints how the time of a picture grows if an array has twice as many samples along each axis, and if a picture is
    twice as wide and high, so that its surfaces need four times as many points; and the memory: that of the whole
    program, and how much of it grows with the array."""
    small, large = 48, 96
    rows = []
    for field in FIELDS:
        with tempfile.TemporaryDirectory(prefix="oval4d-") as folder:
            files = {side: Path(folder, f"{side}.npy") for side in (small, large)}
            for side, file in files.items():
                sampled(field, file, side)
            turns = [(pictures(files[small], frames=12, **settings), pictures(files[large], frames=12, **settings),
                      pictures(files[small], width=2560, height=1440, frames=12, **settings)) for _ in range(3)]
            of_array = {side: file.stat().st_size for side, file in files.items()}
        rows.append([field, *(statistics.median(turn[i]["ms"]["frame"] for turn in turns) for i in range(3)),
                     *(statistics.median(turn[i]["ms"]["frame"] / turn[0]["ms"]["frame"] for turn in turns) for i in (1, 2)),
                     max(turn[1]["memory"] for turn in turns) / of_array[large],
                     statistics.median(turn[1]["memory"] - turn[0]["memory"] for turn in turns)
                     / (of_array[large] - of_array[small])])
    table([f"milliseconds from a state to its PNG, {small}⁴ samples", "1280 × 720", f"{large}⁴ samples", "2560 × 1440",
           "ratio, samples", "ratio, pixels", f"memory of the program ÷ array of {large}⁴",
           "growth of the memory ÷ growth of the array"], rows)
    print("\nTargets: ratios ≤ 5, memory ≤ 1.25.")


def exported(what, polytope, turns):
    """Runs bench_export; returns its measurements."""
    done = subprocess.run([BIN / "bench_export", what, polytope, str(turns)], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def exports():
    """Prints the times of exported files, and of filled faces beside GLU's tessellator."""
    print("\n## Export: files of the 120-cell\n\nFrom a state to the bytes of the file. Medians of five turns; in each "
          "turn, all files are made one after the other.")
    table(["", "ms", "bytes"], [[f"{file['format']}, {file['about']}", statistics.median(file["ms"]), file["bytes"]]
                                for file in exported("files", "120-cell", TURNS)])
    print("\n## Filling of the faces of 21 slices of a star\n\nThe ratio says how many times faster "
          "oval4d is than GLU's tessellator, which returns triangles, fans and strips; oval4d's convex pieces are "
          "counted as fans.")
    rows = []
    for polytope in STARS:
        run = exported("faces", polytope, QUICK_TURNS)
        rows.append([polytope, run["faces"], run["sides"], *Turns.compare(run["ms"]["ours"], run["ms"]["glu"]),
                     run["triangles"]["ours"], run["triangles"]["glu"], run["area_difference"], run["glu_failures"]])
    table(["", "faces", "sides", "oval4d, ms", "GLU, ms", "ratio", "triangles, oval4d", "triangles, GLU",
           "relative difference of areas", "errors of GLU"], rows)


def two_cores():
    """Prints the pictures per second for each way to use several cores."""
    print("\n## Drawing: state to PNG, as fast as possible\n\nThreads are llvmpipe's own.")
    for polytope in ("5-cell", "600-cell"):
        table([polytope, "pictures a second", "relative to the first row", "ms a picture"],
              drawing.rows(BIN / "bench_drawing", polytope))


def under_load(loaded):
    """Prints the latencies and the memory of a running server."""
    print("\n## Load: a server and its clients on one machine\n\nMilliseconds from a key to its picture or, for "
          "pointing, from a point to the answer that names the element there.")
    table(["", "pictures or answers", "median", "95th percentile", "99th percentile", "worst"],
          [[what, row["pictures"], row["median"], row["p95"], row["p99"], row["worst"]]
           for what, row in loaded.items() if "median" in row])
    table(["", "frames a second"],
          [[what, row["rate"]] for what, row in loaded.items() if "rate" in row])
    floods = [row for row in loaded.values() if "sent" in row]
    table(["", "pictures made", "sent after", "the newest seen after"],
          [[row["what"], row["pictures"], row["sent"], row["seen"]] for row in floods])
    idle, after = loaded["1000 idle sessions"], loaded["memory after all that"]["after"]
    print(f"\nMemory: {idle['before']:.0f} MB at the start, {idle['more']:.0f} MB more with 1000 idle sessions, "
          f"{after:.0f} MB after all clients have left.")


def pointing(pointed):
    """Prints how soon the page lights what is under the mouse."""
    print("\n## Pointing on the page, in Chromium without a graphics card\n\nMilliseconds, median (95th percentile). "
          "After a movement of the mouse, a first picture highlights what was cut from the element itself, and a second "
          "one all that shows it, when the server has answered. *Work* is how long the page's scripts run for a picture; "
          "*shown* is the time from the movement until the browser has rendered the page.")

    def figures(summary):
        return f"{number(summary['median'])} ({number(summary['p95'])})" if summary else "—"

    table(["", "points", "first, work", "second, work", "first, shown", "second, shown"],
          [[f"{part['polytope']}, {part['part']}", part["points"],
            *(figures(part[picture].get(what)) for what in ("work", "shown") for picture in ("first", "second"))]
           for part in pointed])


def main():
    wanted = sys.argv[2:] or PARTS
    for name in wanted:
        if name not in PARTS:
            sys.exit(f"'{name}' is not one of {', '.join(PARTS)}")
    for why in filter(None, (peers.why_no_vtk(), peers.why_no_js())):
        print(f"No comparison: {why}.", file=sys.stderr)
    print(f"# How fast oval4d is\n\n{os.cpu_count()} cores.")
    turns = Turns() if {"targets", "parts"} & set(wanted) else None
    loaded = load() if {"targets", "load"} & set(wanted) else None
    wholes = whole_turns() if {"targets", "whole"} & set(wanted) else None
    pointed = point_on_page() if {"targets", "pointing"} & set(wanted) else None
    for name in wanted:
        {"targets": lambda: targets(turns, loaded, wholes, pointed), "parts": lambda: parts(turns), "growth": growth,
         "polytopes": polytopes, "whole": lambda: whole(wholes), "fields": fields, "export": exports,
         "drawing": two_cores, "load": lambda: under_load(loaded), "pointing": lambda: pointing(pointed)}[name]()


if __name__ == "__main__":
    main()
