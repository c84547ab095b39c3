#!/usr/bin/env python3
"""Writes furnished_room.obj, room_with_door.obj and lamp_box.obj beside this file: metres, z up, fronts inwards.

Where two things touch (a leg and the floor, a shelf and the wall), both faces are left out, so that every room is
closed: whichever way one looks, one sees a front.
"""
from pathlib import Path


class Mesh:
    def __init__(self, comment):
        self.lines = ["# " + comment + "; written by generate_rooms.py"]
        self.numbers = {}

    def group(self, name, material):
        self.lines += ["", f"g {name}", f"usemtl {material}"]

    def vertex(self, point):
        key = tuple(round(x, 6) for x in point)
        if key not in self.numbers:
            self.numbers[key] = len(self.numbers) + 1
            self.lines.append("v " + " ".join(f"{x:g}" for x in key))
        return self.numbers[key]

    def face(self, *points):
        corners = [self.vertex(p) for p in points]
        self.lines.append("f " + " ".join(str(c) for c in corners))

    def rectangle(self, axis, at, first, second, front):
        """A rectangle across an axis (0, 1, 2) over two intervals of the next two axes in cyclic order."""
        (a0, a1), (b0, b1) = first, second
        corners = [(a0, b0), (a1, b0), (a1, b1), (a0, b1)]
        if front < 0:
            corners.reverse()
        points = []
        for a, b in corners:
            point = [0, 0, 0]
            point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = at, a, b
            points.append(point)
        self.face(*points)

    def rectangle_without(self, axis, at, first, second, holes, front):
        """The same less rectangular holes (first, second), as rectangles in strips along the second interval."""
        cuts = sorted({b for b in second} | {b for _, hole in holes for b in hole})
        for b in zip(cuts, cuts[1:]):
            in_strip = sorted(a for a, hole in holes if hole[0] < b[1] and b[0] < hole[1])
            ends = [first[0]] + [a for hole in in_strip for a in hole] + [first[1]]
            for a in zip(ends[::2], ends[1::2]):
                if a[0] < a[1]:
                    self.rectangle(axis, at, a, b, front)

    def box(self, x, y, z, sides, inward=False):
        """The named sides of a box: -x +x -y +y -z +z."""
        intervals = (x, y, z)
        for side in sides.split():
            axis = "xyz".index(side[1])
            end = 0 if side[0] == "-" else 1
            front = (1 if end else -1) * (-1 if inward else 1)
            self.rectangle(axis, intervals[axis][end], intervals[(axis + 1) % 3], intervals[(axis + 2) % 3], front)

    def write(self, name):
        (Path(__file__).parent / name).write_text("\n".join(self.lines) + "\n")


def furnished_room():
    mesh = Mesh("A room of 5 x 4 x 2.8 m with a window, a ceiling lamp, a table and a bookshelf")
    x, y, z = (0, 5), (0, 4), (0, 2.8)
    window = ((1.0, 2.6), (0.9, 2.3))  # y, z
    lamp = ((2.2, 2.8), (1.7, 2.3))  # x, y
    top = ((1.4, 3.0), (0.9, 1.7), (0.72, 0.76))
    legs = [((a, a + 0.06), (b, b + 0.06)) for a in (1.45, 2.89) for b in (0.95, 1.59)]
    shelf = ((3.2, 4.4), (3.65, 4.0), (0, 1.83))

    mesh.group("floor", "oak")
    mesh.rectangle_without(2, 0, x, y, legs + [shelf[:2]], +1)
    mesh.group("ceiling", "plaster")
    mesh.rectangle_without(2, z[1], x, y, [lamp], -1)
    mesh.group("walls", "plaster")
    mesh.rectangle_without(0, 0, y, z, [window], +1)
    mesh.rectangle_without(1, y[1], z, x, [(shelf[2], shelf[0])], -1)
    mesh.box(x, y, z, "+x -y", inward=True)
    mesh.group("window", "window")
    mesh.rectangle(0, 0, *window, +1)
    mesh.group("lamp", "lamp")
    mesh.rectangle(2, z[1], *lamp, -1)

    mesh.group("table", "beech")
    mesh.box(*top, "-x +x -y +y +z")
    mesh.rectangle_without(2, top[2][0], top[0], top[1], legs, -1)
    for leg in legs:
        mesh.box(*leg, (0, top[2][0]), "-x +x -y +y")

    mesh.group("shelf", "birch")
    board, back, compartments = 0.03, 0.02, 4
    height = (shelf[2][1] - board) / compartments
    inside = (shelf[0][0] + board, shelf[0][1] - board)
    openings = [(i * height + board, (i + 1) * height) for i in range(compartments)]
    mesh.box(*shelf, "-x +x +z")
    mesh.rectangle_without(1, shelf[1][0], shelf[2], shelf[0], [(o, inside) for o in openings], -1)
    for opening in openings:
        mesh.box(inside, (shelf[1][0], shelf[1][1] - back), opening, "-x +x +y -z +z", inward=True)
    mesh.write("furnished_room.obj")


def room_with_door():
    mesh = Mesh("A room of 4 x 4 x 2.6 m and the near half of a doorway in the wall at x = 4, which is 0.15 m thick")
    x, y, z = (0, 4), (0, 4), (0, 2.6)
    door_y, door_z, middle = (1.5, 2.4), (0, 2.1), 4.075
    mesh.group("floor", "screed")
    mesh.rectangle(2, 0, x, y, +1)
    mesh.rectangle(2, 0, (x[1], middle), door_y, +1)
    mesh.group("ceiling", "plaster")
    mesh.rectangle(2, z[1], x, y, -1)
    mesh.group("walls", "plaster")
    mesh.box(x, y, z, "-x -y +y", inward=True)
    mesh.rectangle(0, x[1], (y[0], door_y[0]), z, -1)
    mesh.rectangle(0, x[1], (door_y[1], y[1]), z, -1)
    mesh.rectangle(0, x[1], door_y, (door_z[1], z[1]), -1)
    mesh.group("doorway", "plaster")
    mesh.box((x[1], middle), door_y, door_z, "-y +y +z", inward=True)
    mesh.write("room_with_door.obj")


def lamp_box():
    mesh = Mesh("A lamp of 0.6 x 0.6 x 0.05 m about the origin, shining down")
    x, y, z = (-0.3, 0.3), (-0.3, 0.3), (-0.025, 0.025)
    mesh.group("lamp", "lamp")
    mesh.box(x, y, z, "-z")
    mesh.group("housing", "metal")
    mesh.box(x, y, z, "-x +x -y +y +z")
    mesh.write("lamp_box.obj")


furnished_room()
room_with_door()
lamp_box()
