#!/usr/bin/env python3
"""Holds the operators against each other on random scenes that nobody has tidied up.

    random_scenes.py LUXEL FOLDER FIRST LAST [crossing|apart]

Scene FIRST, FIRST + 1, ... LAST - 1: rooms closed or with a wall or the ceiling missing, boxes and plates that stand,
float, lean and (crossing) run through each other and through the lamps, or (apart) spheres, terrain and bodies at any
scale and far from the origin. Each is solved by `dense` (accuracy 1e-4), `gather` and `hierarchical` (0.005). A line
tells the relative RMS difference of irradiance from dense, the largest on one patch (relative to its irradiance, or to
0.3 of the mean where that is more), and the error bar; `<<` marks a difference above twice the accuracy, outside the
error bar, or above 15 % on one patch. The same seed gives the same scene.
"""

import csv
import json
import math
import pathlib
import random
import subprocess
import sys

ACCURACY = 0.005
PATCHES = 1500
SIDES = {  # corners of a box, bit k for axis k, counter-clockwise from outside
    "-x": (0, 4, 6, 2), "+x": (1, 3, 7, 5), "-y": (0, 1, 5, 4),
    "+y": (2, 6, 7, 3), "-z": (0, 2, 3, 1), "+z": (4, 5, 7, 6),
}


def turned(point, about, angle, lean):
    x, y, z = (p - c for p, c in zip(point, about))
    x, y = x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)
    y, z = y * math.cos(lean) - z * math.sin(lean), y * math.sin(lean) + z * math.cos(lean)
    return (x + about[0], y + about[1], z + about[2])


class Mesh:
    def __init__(self):
        self.vertices, self.faces = [], []

    def face(self, material, corners):
        first = len(self.vertices)
        self.vertices += corners
        self.faces.append((material, range(first, first + len(corners))))

    def box(self, low, high, material, angle=0.0, lean=0.0):
        middle = [(a + b) / 2 for a, b in zip(low, high)]
        corners = [[(high if i >> k & 1 else low)[k] for k in range(3)] for i in range(8)]
        corners = [turned(corner, middle, angle, lean) for corner in corners]
        for side in SIDES.values():
            self.face(material, [corners[i] for i in side])

    def room(self, size, missing):
        corners = [tuple(size[k] if i >> k & 1 else 0.0 for k in range(3)) for i in range(8)]
        for number, (name, side) in enumerate(SIDES.items()):
            if name != missing:
                self.face(f"wall{number}", [corners[i] for i in reversed(side)])

    def sphere(self, centre, radius, rings, material, inwards=False):
        def at(ring, step):
            polar, around = math.pi * ring / rings, math.pi * step / rings
            return (centre[0] + radius * math.sin(polar) * math.cos(around),
                    centre[1] + radius * math.sin(polar) * math.sin(around), centre[2] + radius * math.cos(polar))
        for ring in range(rings):
            for step in range(2 * rings):
                a, b = at(ring, step), at(ring + 1, step)
                c, d = at(ring + 1, step + 1), at(ring, step + 1)
                triangles = ([] if ring == rings - 1 else [[a, b, c]]) + ([] if ring == 0 else [[a, c, d]])
                for triangle in triangles:
                    self.face(material, triangle[::-1] if inwards else triangle)

    def terrain(self, size, cells, random_height):
        height = [[random_height() for _ in range(cells + 1)] for _ in range(cells + 1)]
        def at(i, j):
            return (size[0] * i / cells, size[1] * j / cells, height[i][j])
        for i in range(cells):
            for j in range(cells):
                self.face("wall4", [at(i, j), at(i + 1, j), at(i + 1, j + 1)])
                self.face("wall4", [at(i, j), at(i + 1, j + 1), at(i, j + 1)])

    def moved(self, scale, offset):
        self.vertices = [(x * scale + offset, y * scale - offset, z * scale) for x, y, z in self.vertices]

    def write(self, folder, name, chance):
        with open(folder / f"{name}.obj", "w") as file:
            for vertex in self.vertices:
                file.write("v %.17g %.17g %.17g\n" % vertex)
            for material, corners in self.faces:
                file.write(f"usemtl {material}\nf " + " ".join(str(i + 1) for i in corners) + "\n")
        finishes = {f"wall{k}": {"reflectance": [round(chance.uniform(0, 0.9), 2) for _ in range(3)]} for k in range(6)}
        finishes |= {"body": {"reflectance": 0.6}, "dark body": {"reflectance": 0.2}, "panel": {"reflectance": 0.5},
                     "lamp": {"reflectance": 0.3, "exitance": [10, 8, 5]},
                     "lit body": {"reflectance": 0.3, "exitance": 3}}
        used = {material for material, _ in self.faces}
        scene = folder / f"{name}.json"
        scene.write_text(json.dumps({"mesh": f"{name}.obj", "materials": {k: finishes[k] for k in sorted(used)}}))
        return scene


def crossing(chance):
    """Bodies and lamps anywhere."""
    mesh = Mesh()
    size = [chance.uniform(0.7, 3), chance.uniform(0.7, 3), chance.uniform(0.6, 1.5)]
    mesh.room(size, chance.choice([None, None, "+z", "-y"]))
    for _ in range(chance.randint(0, 6)):
        extent = [chance.uniform(0.05, 0.35) * min(size[:2]) for _ in range(3)]
        extent[2] = min(extent[2], 0.5 * size[2])
        if chance.random() < 0.3:
            extent[chance.randint(0, 2)] = 0.01
        reach = 0.75 * max(extent[:2])
        if reach > min(size[:2]) / 2 - 0.01:
            continue
        x, y = chance.uniform(reach, size[0] - reach), chance.uniform(reach, size[1] - reach)
        place = chance.choice(["floor", "air", "wall"])
        z = 0.0 if place == "floor" else chance.uniform(0.02, size[2] - extent[2] - 0.02)
        lean = chance.uniform(-0.3, 0.3) if place == "air" and 0.2 < z < size[2] - extent[2] - 0.2 else 0.0
        angle = 0.0 if place == "wall" else chance.uniform(0, 6.3)
        x = extent[0] / 2 if place == "wall" else x
        low = (x - extent[0] / 2, y - extent[1] / 2, z)
        mesh.box(low, [a + b for a, b in zip(low, extent)], chance.choice(["body", "dark body", "body", "lit body"]),
                 angle, lean)
    for _ in range(chance.randint(1, 4)):
        a, b = chance.uniform(0.02, 0.3) * size[0], chance.uniform(0.02, 0.3) * size[1]
        x, y = chance.uniform(0.02, size[0] - a - 0.02), chance.uniform(0.02, size[1] - b - 0.02)
        way = chance.choice(["down", "up", "aside"])
        if way == "down":
            z = size[2] - 0.002 if chance.random() < 0.3 else chance.uniform(0.1, size[2] - 0.005)
            lamp = [(x, y, z), (x, y + b, z), (x + a, y + b, z), (x + a, y, z)]
        elif way == "up":
            z = chance.uniform(0.002, size[2] * 0.7)
            lamp = [(x, y, z), (x + a, y, z), (x + a, y + b, z), (x, y + b, z)]
        else:
            z, h = chance.uniform(0.01, size[2] - 0.3), chance.uniform(0.02, 0.28)
            lamp = [(x, y, z), (x + a, y, z), (x + a, y, z + h), (x, y, z + h)]
        lamp = lamp[:3] if chance.random() < 0.3 else lamp
        mesh.face("lamp", lamp)
        if chance.random() < 0.5:
            mesh.face("panel", lamp[::-1])
    return mesh


def apart(chance):
    """Bodies that keep off each other, curved ones too, at any scale."""
    mesh = Mesh()
    size = [chance.uniform(0.7, 3), chance.uniform(0.7, 3), chance.uniform(0.7, 1.5)]
    around = chance.choice(["room", "open room", "ball", "terrain"])
    if around == "ball":
        size = [2.0, 2.0, 2.0]
        mesh.sphere((1, 1, 1), 1, chance.randint(5, 9), "wall0", inwards=True)
    elif around == "terrain":
        mesh.terrain(size, 14, lambda: chance.uniform(-0.15, -0.03))
    else:
        mesh.room(size, "+z" if around == "open room" else None)
    for gx in (0.3, 0.7):
        for gy in (0.3, 0.7):
            x, y, z = gx * size[0], gy * size[1], chance.uniform(0.35, 0.6) * size[2]
            reach = 0.13 * min(size[:2])
            body = chance.choice(["box", "plate", "sphere", "lit sphere", "nothing"])
            if body in ("sphere", "lit sphere"):
                material = "lit body" if body == "lit sphere" else "dark body"
                mesh.sphere((x, y, z), reach * chance.uniform(0.3, 1), chance.randint(4, 6), material)
            elif body != "nothing":
                extent = [1.3 * reach * chance.uniform(0.3, 1) for _ in range(3)]
                if body == "plate":
                    extent[chance.randint(0, 2)] *= 0.01
                stands = body == "box" and around in ("room", "open room") and chance.random() < 0.5
                low = (x - extent[0] / 2, y - extent[1] / 2, 0.0 if stands else z)
                mesh.box(low, [a + b for a, b in zip(low, extent)], "body", chance.uniform(0, 6.3),
                         0.0 if stands else chance.uniform(-0.5, 0.5))
    for number in range(chance.randint(1, 3)):
        a, b = (chance.uniform(0.02, 0.3) * s for s in size[:2])
        x, y = chance.uniform(0.25, 0.4) * size[0], chance.uniform(0.25, 0.4) * size[1]
        z = size[2] * (chance.uniform(0.7, 0.8) + 0.01 * number)
        mesh.face("lamp", [(x, y, z), (x, y + b, z), (x + a, y + b, z), (x + a, y, z)])
    scale = chance.choice([1, 1, 1e-5, 1e5])
    mesh.moved(scale, chance.choice([0, 0, 1e4]) * scale)
    return mesh


def solve(luxel, scene, operator, accuracy):
    table = scene.with_suffix(".csv")
    arguments = ["--patches", PATCHES, "--operator", operator, "--accuracy", accuracy, "-o", table]
    done = subprocess.run([luxel, "solve", "--json", "--full-precision", scene, *map(str, arguments)],
                          capture_output=True, text=True)
    if done.returncode > 1:
        return None, done.stderr.strip(), done.returncode
    with open(table, newline="") as file:
        rows = [[float(row[k]) for k in ("area", "H_r", "H_g", "H_b")] for row in csv.DictReader(file)]
    return rows, json.loads(done.stdout)["error"]["operator"], done.returncode


def difference(found, reference):
    """Relative RMS of the worst channel; the largest on one patch, and which."""
    worst, largest = 0.0, (0.0, -1)
    total = sum(row[0] for row in reference)
    for c in (1, 2, 3):
        mean = math.sqrt(sum(row[0] * row[c] ** 2 for row in reference) / total)
        if mean == 0:
            continue
        square = sum(b[0] * (a[c] - b[c]) ** 2 for a, b in zip(found, reference)) / total
        worst = max(worst, math.sqrt(square) / mean)
        for i, (a, b) in enumerate(zip(found, reference)):
            largest = max(largest, (abs(a[c] - b[c]) / max(b[c], 0.3 * mean), i))
    return worst, largest


def main():
    luxel, folder, first, last = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    make = apart if sys.argv[5:] == ["apart"] else crossing
    folder.mkdir(parents=True, exist_ok=True)
    marked = 0
    for seed in range(first, last):
        chance = random.Random(seed)
        scene = make(chance).write(folder, f"{make.__name__}{seed}", chance)
        reference, bar, status = solve(luxel, scene, "dense", 1e-4)
        if reference is None:
            print(f"{scene.name}: dense refused: {bar}", flush=True)
            continue
        line = f"{scene.name}: {len(reference)} patches; dense {'status 1 ' if status else ''}to {bar['high']:.4f}"
        for operator in ("gather", "hierarchical"):
            found, bar, status = solve(luxel, scene, operator, ACCURACY)
            if found is None:
                line += f"; {operator} refused: {bar} <<"
                continue
            rms, (most, patch) = difference(found, reference)
            mark = rms > 2 * ACCURACY or not bar["low"] <= rms <= bar["high"] or most > 0.15
            marked += mark
            line += f"; {operator} {'status 1 ' if status else ''}{rms:.4f} ({bar['low']:.4f} to {bar['high']:.4f})"
            line += f", {most:.3f} on patch {patch}{' <<' if mark else ''}"
        print(line, flush=True)
    print(f"{marked} marked of {2 * (last - first)}")


if __name__ == "__main__":
    main()
