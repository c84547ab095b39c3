#!/usr/bin/env python3
"""Measures error against CPU time at 5,000 to a million patches: the tables and the plot of docs/scale.md.

    measure_scale.py LUXEL GENERATE_SCENE FOLDER [REPEATS [PART]...]

Runs `luxel solve` as a user would, with the error bar on, and reads time, peak memory and error from its reports; at
5,000 patches the error is also measured against a dense reference of accuracy 1e-5. Each line of a table is the median
of REPEATS runs with seeds 1, 2, ...; CPU seconds are those of the whole process. Needs gnuplot for the plot.
"""

import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys

CORNELL = pathlib.Path(__file__).parent / "scenes" / "cornell" / "cornell.json"


def run(luxel, arguments):
    done = subprocess.run([luxel, "solve", "--json", *map(str, arguments)], capture_output=True, text=True)
    if done.returncode > 1:
        sys.exit(f"luxel solve {arguments}: {done.stderr}")
    return json.loads(done.stdout)


def columns(path):
    with open(path, newline="") as file:
        rows = [[float(row[k]) for k in ("area", "H_r", "H_g", "H_b")] for row in csv.DictReader(file)]
    return rows


def difference(found, reference):
    worst = 0
    for c in (1, 2, 3):
        off = sum(b[0] * (a[c] - b[c]) ** 2 for a, b in zip(found, reference))
        whole = sum(b[0] * b[c] ** 2 for b in reference)
        worst = max(worst, math.sqrt(off / whole))
    return worst


class Study:
    def __init__(self, luxel, generate, folder, repeats):
        self.luxel, self.generate, self.folder, self.repeats = luxel, generate, folder, repeats
        folder.mkdir(parents=True, exist_ok=True)

    def scene(self, name, *arguments, finishes=None):
        mesh = self.folder / f"{name}.obj"
        if not mesh.exists():
            mesh.write_bytes(subprocess.run([self.generate, *map(str, arguments)], capture_output=True, check=True).stdout)
        scene = self.folder / f"{name}.json"
        if finishes is None:
            text = subprocess.run([self.generate, "finishes", mesh.name], capture_output=True, text=True, check=True).stdout
        else:
            text = json.dumps({"mesh": mesh.name, **finishes})
        scene.write_text(text)
        return scene

    def reference(self, scene, patches):
        path = self.folder / f"reference_{scene.stem}_{patches}.csv"
        if not path.exists():
            run(self.luxel, [scene, "--patches", patches, "--operator", "dense", "--accuracy", 1e-5, "--error-bar", "off",
                             "-o", path])
        return columns(path)

    def line(self, name, scene, sizing, operator, accuracy, reference=None, outputs=()):
        reports, errors = [], []
        for seed in range(1, self.repeats + 1):
            files = [self.folder / f"out{suffix}" for suffix in outputs]
            if reference and not files:
                files = [self.folder / "out.csv"]
            arguments = [scene, *sizing, "--operator", operator, "--accuracy", accuracy, "--seed", seed]
            for file in files:
                arguments += ["-o", file]
            reports.append(run(self.luxel, arguments))
            if reference:
                errors.append(difference(columns(files[0]), reference))
        cpu = sorted(report["cpu_seconds"] for report in reports)
        peak = max(report["peak_bytes"] for report in reports)
        bars = [report["error"]["operator"] for report in reports]
        estimate = statistics.median(bar["estimate"] for bar in bars)
        low, high = min(bar["low"] for bar in bars), max(bar["high"] for bar in bars)
        seen = f"{statistics.median(errors):.2g}" if errors else ""
        print(f"| {name} | {reports[0]['patches']:,} | {operator} | {accuracy:g} | {cpu[len(cpu) // 2]:.3g} "
              f"({cpu[0]:.3g} to {cpu[-1]:.3g}) | {peak / 1e9:.2g} | {estimate:.2g} ({low:.2g} to {high:.2g}) | {seen} |",
              flush=True)
        with open(self.folder / "points.txt", "a") as points:
            error = statistics.median(errors) if errors else estimate
            points.write(f"{name.replace(' ', '_')} {reports[0]['patches']} {operator} {cpu[len(cpu) // 2]} {error}\n")


def plot(folder):
    """Error against CPU time of all points measured so far: scale.png."""
    curves = {}
    for line in (folder / "points.txt").read_text().splitlines():
        name, patches, operator, cpu, error = line.split()
        if ".csv" in name or float(error) == 0:
            continue
        curves.setdefault((name.replace("_", " "), int(patches), operator), []).append((float(cpu), float(error)))
    script = ["set terminal pngcairo size 1180,560 font 'sans,11'", f"set output '{folder / 'scale.png'}'",
              "set logscale xy", "set grid", "set key outside right center",
              "set xlabel 'CPU seconds of the whole run, error bar included'",
              "set ylabel 'relative RMS error of irradiance'", "set format y '10^{%L}'"]
    styles = {"dense": 7, "gather": 5, "hierarchical": 9}
    parts = []
    for (name, patches, operator), points in sorted(curves.items(), key=lambda item: item[0][1]):
        key = f"{name}, {patches:,}: {operator}"
        parts.append(f"'-' with linespoints pointtype {styles[operator]} title '{key}'")
    script.append("plot " + ", ".join(parts))
    for points in (points for _, points in sorted(curves.items(), key=lambda item: item[0][1])):
        script += [f"{x} {y}" for x, y in sorted(points)] + ["e"]
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    study = Study(sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 3)
    parts = sys.argv[5:] or ["5k", "100k", "1M", "files", "ball"]
    print("| scene | patches | operator | accuracy asked | CPU s | peak GB | error bar | error against dense 1e-5 |")
    print("|---|---|---|---|---|---|---|---|")
    if "5k" in parts:
        reference = study.reference(CORNELL, 5700)
        for accuracy in (0.03, 0.012, 0.006, 0.0025):
            study.line("Cornell box", CORNELL, ["--patches", 5700], "gather", accuracy, reference)
        for accuracy in (0.03, 0.01, 0.003, 0.001):
            study.line("Cornell box", CORNELL, ["--patches", 5700], "hierarchical", accuracy, reference)
        for accuracy in (0.03, 0.01, 0.001):
            study.line("Cornell box", CORNELL, ["--patches", 5700], "dense", accuracy, reference)
    for part, cells, accuracies in (("100k", 120, (0.02, 0.01, 0.005, 0.002)), ("1M", 368, (0.02, 0.01, 0.003))):
        if part not in parts:
            continue
        blocks = study.scene(f"blocks{cells}", "blocks", cells)
        for operator in ("gather", "hierarchical"):
            for accuracy in accuracies:
                study.line("two blocks", blocks, ["--as-is"], operator, accuracy)
    if "files" in parts:
        for accuracy in (0.008, 0.004):
            study.line("Cornell box, .csv", CORNELL, ["--patches", 1000000], "gather", accuracy, outputs=(".csv",))
        study.line("Cornell box, .csv, .vtp", CORNELL, ["--patches", 1000000], "gather", 0.008, outputs=(".csv", ".vtp"))
    if "ball" in parts:
        ball = study.scene("ball", "ball", 1000000, finishes={
            "materials": {"white": {"reflectance": [0.7, 0.5, 0.4]}},
            "surfaces": {"lamp": {"reflectance": 0.3, "exitance": [30, 27, 24]}}})
        for accuracy in (0.02, 0.012):
            study.line("rough ball", ball, ["--as-is"], "gather", accuracy)
    plot(study.folder)


if __name__ == "__main__":
    main()
