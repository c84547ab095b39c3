#!/usr/bin/python3
"""Error of the form factors against run time: the tables and the plot of docs/accuracy.md.

Usage: examples/measure_accuracy.py BUILD [REPEATS]     (BUILD holds luxel and generate_scene; gnuplot draws)

Largest and root-mean-square raw row errors of closed scenes (the exact row sum is 1), CPU seconds of the whole
`luxel factors` process (the median of the repeats) and its peak memory.
"""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

BUILD = pathlib.Path(sys.argv[1])
REPEATS = int(sys.argv[2]) if len(sys.argv) > 2 else 3
PLOT = pathlib.Path(__file__).parent.parent / "docs" / "images" / "accuracy.svg"

# Measured on the same kind of machine: patches, CPU seconds, largest row error.
VIEW3D = {"cube": [(2400, 0.34, 1.3e-6), (10086, 6.1, 1.3e-6)],
          "room": [(582, 2.2, 2e-4), (582, 10.7, 4.1e-5), (2328, 24, 2e-4), (5238, 114, 2e-4), (9948, 417, 2e-4)]}
SCENES = {"cube": [["cube", "10"], ["cube", "20"], ["cube", "30"], ["cube", "41"]],
          "room": [["room", "9", "4"], ["room", "18", "8"], ["room", "27", "12"], ["room", "37", "17"]]}
ACCURACIES = {"cube": ["1e-3", "1e-5", "5e-7"], "room": ["1e-3", "1e-4", "1e-5", "1e-6"]}


def run(mesh, accuracy):
    seconds = []
    for _ in range(REPEATS):
        result = subprocess.run([BUILD / "luxel", "factors", mesh, "--as-is", "--accuracy", accuracy, "--json", "--quiet"],
                                capture_output=True, text=True, check=False)
        report = json.loads(result.stdout)
        seconds.append(report["cpu_seconds"])
    return report, statistics.median(seconds)


def main():
    curves = {}
    with tempfile.TemporaryDirectory() as folder:
        for kind, scenes in SCENES.items():
            print(f"\n| {kind}: patches | asked | largest row error | RMS | CPU s | wall s | MiB |\n|---|---|---|---|---|---|---|")
            for scene in scenes:
                mesh = pathlib.Path(folder) / "scene.obj"
                mesh.write_bytes(subprocess.run([BUILD / "generate_scene", *scene], capture_output=True, check=True).stdout)
                for accuracy in ACCURACIES[kind]:
                    report, seconds = run(mesh, accuracy)
                    rows = report["operator"]["row_sum_error"]
                    print(f"| {report['patches']:,} | {accuracy} | {rows['max']:.1e} | {rows['rms']:.1e} | {seconds:.2f} | "
                          f"{report['wall_seconds']:.2f} | {report['peak_bytes'] / 2**20:.0f} |", flush=True)
                    curves.setdefault((kind, report["patches"]), []).append((seconds, rows["max"]))
    draw(curves)


def draw(curves):
    script = ["set terminal svg size 1100,520 font 'Helvetica,13' background 'white'", f"set output '{PLOT}'",
              "set multiplot layout 1,2", "set logscale xy", "set format y '10^{%T}'", "set grid lc '#dddddd'",
              "set xlabel 'CPU time [s]'", "set ylabel 'largest raw row error'", "set key bottom left box opaque"]
    for kind in SCENES:
        plots = []
        for (of, patches), points in curves.items():
            if of != kind:
                continue
            name = f"${kind}{patches}"
            script += [f"{name} << EOD", *(f"{x} {y}" for x, y in points), "EOD"]
            plots.append(f"{name} with linespoints lw 2 pt 7 title 'Luxel, {patches:,} patches'")
        script += [f"$view3d_{kind} << EOD", *(f"{x} {y} {n}" for n, x, y in VIEW3D[kind]), "EOD"]
        plots.append(f"$view3d_{kind} with points pt 9 ps 1.4 lc 'black' title 'View3D'")
        plots.append(f"$view3d_{kind} using 1:($2*1.6):3 with labels font ',10' notitle")
        title = "closed cube" if kind == "cube" else "room with a floating box"
        script += [f"set title '{title}'", "plot " + ", ".join(plots)]
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)


if __name__ == "__main__":
    main()
