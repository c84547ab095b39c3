#!/usr/bin/python3
"""Form factors of curved surfaces against their closed forms, by mesh refinement: a table of docs/accuracy.md.

Usage: examples/measure_curved.py BUILD [ACCURACY]     (BUILD holds luxel; default accuracy 1e-5)

Each surface is replaced by flat patches whose corners lie on it, n around the axis; doubling n divides the error
of such inscribed meshes by four (order 2). Sources of the closed forms: Howell, A Catalog of Radiation Heat Transfer
Configuration Factors (numbers in the names); concentric spheres: reciprocity and closure.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

BUILD = pathlib.Path(sys.argv[1])
ACCURACY = sys.argv[2] if len(sys.argv) > 2 else "1e-5"


class Mesh:
    def __init__(self):
        self.vertices, self.lines = [], []

    def group(self, name):
        self.lines.append(f"g {name}")

    def grid(self, point, n, m, inside_out=False):
        """Quads between point(i / n, j / m); two corners that coincide make a triangle."""
        base = len(self.vertices)
        for j in range(m + 1):
            self.vertices += [point(i / n, j / m) for i in range(n + 1)]
        for j in range(m):
            for i in range(n):
                corners = [base + 1 + b * (n + 1) + a for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
                distinct = [c for k, c in enumerate(corners)
                            if math.dist(self.vertices[c - 1], self.vertices[corners[k - 1] - 1]) > 1e-12]
                if inside_out:
                    distinct.reverse()
                self.lines.append("f " + " ".join(map(str, distinct)))

    def write(self, file):
        text = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in self.vertices] + self.lines
        file.write_text("\n".join(text) + "\n")


def around(radius, share, z):
    return radius * math.cos(2 * math.pi * share), radius * math.sin(2 * math.pi * share), z


def disk(mesh, name, radius, z, n, upwards):
    mesh.group(name)
    mesh.grid(lambda s, t: around(radius * t, s, z), n, max(n // 8, 1), inside_out=upwards)


def tube(mesh, name, radius, height, n, inward):
    mesh.group(name)
    rows = max(round(n * height / (2 * math.pi * radius)), 1)
    mesh.grid(lambda s, t: around(radius, s, height * t), n, rows, inside_out=inward)


def sphere(mesh, name, radius, centre_z, n, inward):
    """n meridians, n / 2 rings of triangles between the poles."""
    mesh.group(name)
    base, rings = len(mesh.vertices) + 1, n // 2
    for j in range(rings + 1):
        theta = math.pi * j / rings
        z = centre_z + radius * math.cos(theta)
        mesh.vertices += [around(radius * math.sin(theta), i / n, z) for i in range(n if 0 < j < rings else 1)]

    def at(i, j):
        if j == 0:
            return base
        return base + 1 + (j - 1) * n + (i % n if j < rings else 0)
    for j in range(rings):
        for i in range(n):
            triangles = [(at(i, j), at(i, j + 1), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i + 1, j))]
            for corners in triangles:
                if len(set(corners)) == 3:
                    mesh.lines.append("f " + " ".join(map(str, corners[::-1] if inward else corners)))


def two_disks(n):
    mesh = Mesh()
    disk(mesh, "lower", 1, 0, n, True)
    disk(mesh, "upper", 1, 1, n, False)
    return mesh, "lower", "upper", 0.38196601125011


def sphere_and_disk(n):
    mesh = Mesh()
    sphere(mesh, "sphere", 0.3, 0.5, n, False)
    disk(mesh, "disk", 1, 0, n, True)
    return mesh, "sphere", "disk", (1 - 1 / math.sqrt(5)) / 2


def closed_cylinder(n):
    mesh = Mesh()
    disk(mesh, "bottom", 1, 0, n, True)
    disk(mesh, "top", 1, 2, n, False)
    tube(mesh, "wall", 1, 2, n, True)
    return mesh, "wall", "wall", 0.585786437626905


def concentric_cylinders(n):
    mesh = Mesh()
    tube(mesh, "inner", 1, 3, n, False)
    tube(mesh, "outer", 2, 3, n, True)
    return mesh, "outer", "outer", 0.288183992934


def concentric_spheres(n):
    mesh = Mesh()
    # unlike meshes: alike ones have areas of just the right ratio
    sphere(mesh, "inner", 1, 0, n, False)
    sphere(mesh, "outer", 2, 0, 3 * n // 4, True)
    return mesh, "outer", "outer", 0.75


SCENES = {"two coaxial disks (C-41)": two_disks, "sphere to coaxial disk": sphere_and_disk,
          "wall of a closed cylinder to itself (C-41)": closed_cylinder,
          "outer of two concentric cylinders to itself (C-92)": concentric_cylinders,
          "outer of two concentric spheres to itself": concentric_spheres}


def factor(mesh, first, second, file):
    mesh.write(file)
    result = subprocess.run([BUILD / "luxel", "factors", file, "--as-is", "--by", "group", "--accuracy", ACCURACY,
                             "--json", "--quiet"], capture_output=True, text=True, check=False)
    report = json.loads(result.stdout)
    groups = report["groups"]
    return report, report["form_factors"][groups.index(first)][groups.index(second)]


def main():
    print("| factor | exact | n | patches | error | order | CPU s |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, scene in SCENES.items():
            last = None
            for n in (16, 32) if scene is concentric_spheres else (16, 32, 64):
                mesh, first, second, exact = scene(n)
                report, value = factor(mesh, first, second, pathlib.Path(folder) / "scene.obj")
                error = value - exact
                order = f"{math.log2(abs(last / error)):.2f}" if last else ""
                print(f"| {name} | {exact:.6f} | {n} | {report['patches']:,} | {error:.1e} | {order} | "
                      f"{report['cpu_seconds']:.2f} |", flush=True)
                last = error


if __name__ == "__main__":
    main()
