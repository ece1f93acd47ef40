#!/usr/bin/env python3
"""Writes the small models that are shipped in data/. The same bytes every time; needs nothing but Python.

Grid-like models are sets of cells of a rectilinear grid; the bracket is a plate with two round holes and a wall on it.
All are closed and oriented outward.
"""
import math
import pathlib
import struct
from itertools import permutations, product

DATA = pathlib.Path(__file__).resolve().parent.parent / "data"


def grid_tets(planes, solid):
    """Vertices and positive tets of the cells (i, j, k) for which solid(i, j, k); six tets (Kuhn) per cell."""
    ids, vertices, tets = {}, [], []

    def vertex(corner):
        if corner not in ids:
            ids[corner] = len(vertices)
            vertices.append(tuple(planes[axis][corner[axis]] for axis in range(3)))
        return ids[corner]

    for cell in product(*(range(len(p) - 1) for p in planes)):
        if not solid(*cell):
            continue
        for axes in permutations(range(3)):
            corner = list(cell)
            tet = [vertex(tuple(corner))]
            for axis in axes:
                corner[axis] += 1
                tet.append(vertex(tuple(corner)))
            odd = sum(a > b for i, a in enumerate(axes) for b in axes[i + 1:]) % 2
            if odd:
                tet[2], tet[3] = tet[3], tet[2]
            tets.append(tuple(tet))
    return vertices, tets


def boundary(tets):
    """Facets that belong to one tet only, counter-clockwise seen from outside."""
    facets = {}
    for a, b, c, d in tets:
        for facet in ((b, c, d), (a, d, c), (a, b, d), (a, c, b)):
            key = tuple(sorted(facet))
            facets[key] = None if key in facets else facet
    return [facet for facet in facets.values() if facet]


def used_only(vertices, triangles):
    """The same triangles without unused vertices."""
    used = sorted({v for t in triangles for v in t})
    new = {v: i for i, v in enumerate(used)}
    return [vertices[v] for v in used], [tuple(new[v] for v in t) for t in triangles]


def extruded(loops, low, high, cap):
    """Triangles (as coordinates) of the region `cap` (2D triangles, counter-clockwise) extruded from z = low to high;
    `loops` are its boundary loops with the region on their left."""
    at = lambda p, z: (p[0], p[1], z)
    triangles = []
    for a, b, c in cap:
        triangles.append((at(a, high), at(b, high), at(c, high)))
        triangles.append((at(a, low), at(c, low), at(b, low)))
    for loop in loops:
        for a, b in zip(loop, loop[1:] + loop[:1]):
            triangles.append((at(a, low), at(b, low), at(b, high)))
            triangles.append((at(a, low), at(b, high), at(a, high)))
    return triangles


def square_with_hole(x, y, half, radius, n):
    """Square around (x, y) without an n-gon (n a multiple of 8): 2D triangles, the hole's loop (clockwise) and the points of
    the square's sides in order, counter-clockwise from the direction of +x."""
    circle, square = [], []
    for k in range(n):
        c, s = math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n)
        scale = half / max(abs(c), abs(s))
        circle.append((round(x + radius * c, 9), round(y + radius * s, 9)))
        square.append((round(x + scale * c, 9), round(y + scale * s, 9)))
    cap = []
    for k in range(n):
        j = (k + 1) % n
        cap += [(circle[k], square[k], square[j]), (circle[k], square[j], circle[j])]
    return cap, circle[::-1], square


def bracket():
    """An angle bracket: foot 40 x 20 x 4 with two holes of radius 5, and a wall 4 thick and 24 high along one end."""
    n, foot, top, wall = 32, 4.0, 24.0, 4.0
    left_cap, left_hole, left = square_with_hole(10.0, 10.0, 10.0, 5.0, n)
    right_cap, right_hole, right = square_with_hole(30.0, 10.0, 10.0, 5.0, n)
    eighth = n // 8
    # The squares' points from corner to corner; they share the side x = 20. The wall stands on 40 <= x <= 44.
    right_side = [right[k % n] for k in range(-eighth, eighth + 1)]
    outer = [left[k % n] for k in range(eighth, n - eighth + 1)]           # top left round to bottom middle
    outer += [right[k % n] for k in range(n - 3 * eighth + 1, n - eighth)]  # along the bottom to the right
    low_right, high_right = right_side[0], right_side[-1]
    back = [right[k] for k in range(eighth + 1, 3 * eighth)]                # along the top, right to left
    triangles = []
    at = lambda p, z: (p[0], p[1], z)
    for a, b, c in left_cap + right_cap:
        triangles.append((at(a, foot), at(b, foot), at(c, foot)))
        triangles.append((at(a, 0.0), at(c, 0.0), at(b, 0.0)))
    chain = [high_right] + back + outer + [low_right]
    for path in (chain, left_hole + left_hole[:1], right_hole + right_hole[:1]):
        for a, b in zip(path, path[1:]):
            triangles.append((at(a, 0.0), at(b, 0.0), at(b, foot)))
            triangles.append((at(a, 0.0), at(b, foot), at(a, foot)))
    triangles += wall_triangles(right_side, wall, foot, top)
    return triangles


def wall_triangles(side, thickness, foot, top):
    """The wall beyond the foot's end `side` (2D points with rising y): all of its faces but the one that they share."""
    x = side[0][0]
    y0, y1, far = side[0][1], side[-1][1], x + thickness
    triangles = []

    def fan(points):
        triangles.extend((points[0], points[i], points[i + 1]) for i in range(1, len(points) - 1))

    ridge = [(x, p[1], foot) for p in side]
    base = [(x, p[1], 0.0) for p in side]
    fan([(x, y0, top)] + [(x, y1, top)] + ridge[::-1])          # towards the foot, above it
    fan([(far, y0, 0.0)] + base + [(far, y1, 0.0)])              # bottom
    fan([(far, y0, 0.0), (far, y1, 0.0), (far, y1, top), (far, y0, top)])
    fan([(x, y0, top), (far, y0, top), (far, y1, top), (x, y1, top)])
    fan([(x, y0, foot), (x, y0, 0.0), (far, y0, 0.0), (far, y0, top), (x, y0, top)])
    fan([(x, y1, foot), (x, y1, top), (far, y1, top), (far, y1, 0.0), (x, y1, 0.0)])
    return triangles


def write_stl(name, triangles):
    """Binary STL of triangles given by coordinates."""
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(x for p in t for x in p), 0) for t in triangles)
    (DATA / name).write_bytes(b"matstruct example model".ljust(80, b" ") + struct.pack("<I", len(triangles)) + body)


def write_off(name, vertices, triangles):
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += [f"{x:g} {y:g} {z:g}" for x, y, z in vertices]
    lines += [f"3 {a} {b} {c}" for a, b, c in triangles]
    (DATA / name).write_text("\n".join(lines) + "\n")


def write_msh(name, vertices, tets):
    """Gmsh 2.2, text."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(vertices))]
    lines += [f"{i} {x:g} {y:g} {z:g}" for i, (x, y, z) in enumerate(vertices, 1)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    lines += [f"{i} 4 2 1 1 " + " ".join(str(v + 1) for v in tet) for i, tet in enumerate(tets, 1)]
    (DATA / name).write_text("\n".join(lines + ["$EndElements"]) + "\n")


def steps(length, n):
    return [length * i / n for i in range(n + 1)]


def main():
    write_msh("box.msh", *grid_tets([steps(1, 2), steps(2, 4), steps(3, 6)], lambda i, j, k: True))

    vertices, tets = grid_tets([steps(2, 4), steps(2, 4), steps(3, 6)], lambda i, j, k: i < 2 or j < 2)
    write_off("l_profile.off", *used_only(vertices, boundary(tets)))

    vertices, tets = grid_tets([steps(6, 6)] * 3, lambda i, j, k: not all(2 <= a < 4 for a in (i, j, k)))
    write_stl("hollow_box.stl", [[vertices[v] for v in t] for t in boundary(tets)])

    write_stl("bracket.stl", bracket())


if __name__ == "__main__":
    main()
