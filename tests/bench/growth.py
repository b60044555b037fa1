"""Makes tables of tests/bench/growth's measurements: python3 growth.py RESULT.json"""

import json
import math
import sys

TITLES = {
    "growBuild": ("Building, by elements of the polytope", "elements"),
    "growSlice": ("Slicing by 21 hyperplanes, by elements of the slices", "elements cut"),
    "growFrame": ("A whole frame at 1280 × 720, by elements of the slices", "elements cut"),
    "growSliceWithSlices": ("Slicing, by the number of slices", "slices"),
    "growFrameWithSlices": ("A whole frame at 1280 × 720, by the number of slices", "slices"),
    "growFrameWithPixels": ("A whole frame, by pixels", "pixels"),
}


def exponent(points):
    """The slope of the least-squares line through (log size, log time)."""
    xs, ys = [math.log(size) for size, _ in points], [math.log(time) for _, time in points]
    x0, y0 = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - x0) * (y - y0) for x, y in zip(xs, ys)) / sum((x - x0) ** 2 for x in xs)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        runs = json.load(file)["benchmarks"]
    medians = [run for run in runs if run.get("aggregate_name") == "median"]
    for name, (title, unit) in TITLES.items():
        rows = [run for run in medians if run["run_name"].split("/")[0] == name]
        if not rows:
            continue
        print(f"\n{title}\n\n| | {unit} | ms |\n| --- | --: | --: |")
        for run in rows:
            print(f"| {run['label']} | {run['size']:,.0f} | {run['real_time']:.3g} |")
        points = [(run["size"], run["real_time"]) for run in rows]
        if len(points) > 2:
            print(f"\nGrowth: time ∝ size^{exponent(points):.2f}; of the larger half: "
                  f"^{exponent(points[len(points) // 2:]):.2f}.")


if __name__ == "__main__":
    main()
