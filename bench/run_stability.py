#!/usr/bin/env python3
"""Do rotation, scale, translation, meshing and threads change the structure that the tool finds?

    bench/run_stability.py --tool build/release/matstruct [--remesh build/bench/bench/remesh] [--data ../shared/data]

For every CAD model: its tetrahedra or, if it is a surface, its triangles are computed as they are, rotated, scaled by
1e-3 and 1e3 and translated by 100 diagonals, and so is the surface of its solid with every triangle cut in four and
remeshed (bench/remesh.cpp). The numbers of the strata are compared (sheets, seams, junctions, corners, boundaries,
curves). A model that is in DATA/tet and in DATA/surface is there in two files of other programs: those are compared,
too. Both once more without the pairs that have other numbers of sharp lines or corners: these are other solids. The
results for one and two threads are compared byte by byte. Writes docs/stability.md and .json. Python's standard library
only.
"""
import datetime
import json
import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

import run_models

# Rows of a rotation about the axis (1, 2, 3) by one radian: no plane stays a coordinate plane.
AXIS = [x / math.sqrt(14) for x in (1, 2, 3)]
ROTATION = [[math.cos(1) * (i == j) + (1 - math.cos(1)) * AXIS[i] * AXIS[j]
             + math.sin(1) * ((0 if i == j else (-1 if (j - i) % 3 == 1 else 1)) * AXIS[(3 - i - j) % 3])
             for j in range(3)] for i in range(3)]
TRANSLATION_DIAGONALS = 100
REMESHED, OTHER_FILE = "remeshed", "another program's file"
STRATA = ("sheets", "seams", "junctions", "corners", "boundaries", "curves")


def variants(diagonal):
    """Names and maps of a point. The first is the identity."""
    shift = TRANSLATION_DIAGONALS * diagonal / math.sqrt(3)
    return [("as it is", lambda p: p),
            ("rotated", lambda p: [sum(r * x for r, x in zip(row, p)) for row in ROTATION]),
            ("scaled by 1e-3", lambda p: [1e-3 * x for x in p]),
            ("scaled by 1e3", lambda p: [1e3 * x for x in p]),
            ("translated", lambda p: [x + shift for x in p])]


# ---------------------------------------------------------------- meshes as the tool writes them

def read_ply(path):
    """Header, points and the rest of a binary PLY file whose vertices are three doubles."""
    data = path.read_bytes()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:start]
    n = int(header.split(b"element vertex ")[1].split()[0])
    points = list(struct.iter_unpack("<3d", data[start:start + 24 * n]))
    return header, points, data[start + 24 * n:]


def write_ply(path, header, points, rest):
    path.write_bytes(header + b"".join(struct.pack("<3d", *p) for p in points) + rest)


def read_msh(path):
    """What comes before the nodes, the nodes and what follows in a binary MSH 2.2 file as the tool writes it."""
    data = path.read_bytes()
    number = data.index(b"$Nodes\n") + len(b"$Nodes\n")
    start = data.index(b"\n", number) + 1
    end = start + 28 * int(data[number:start])
    return data[:start], [node[1:] for node in struct.iter_unpack("<i3d", data[start:end])], data[end:]


def write_msh(path, header, points, rest):
    path.write_bytes(header + b"".join(struct.pack("<i3d", k + 1, *p) for k, p in enumerate(points)) + rest)


def cut_in_four(header, points, rest):
    """The same surface with every triangle cut at the middles of its edges."""
    faces = [face[1:] for face in struct.iter_unpack("<B3i", rest)]
    points, middles, finer = list(points), {}, []

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(points)
            points.append([(x + y) / 2 for x, y in zip(points[a], points[b])])
        return middles[key]

    for a, b, c in faces:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    for name, size in (("vertex", len(points)), ("face", len(finer))):
        header = re.sub(rf"(element {name}) \d+".encode(), rf"\1 {size}".encode(), header)
    return header, points, b"".join(struct.pack("<B3i", 3, *face) for face in finer)


def diagonal_of(points):
    return math.dist([min(p[k] for p in points) for k in range(3)], [max(p[k] for p in points) for k in range(3)])


# ---------------------------------------------------------------- runs

def compute(tool, path, out, options, limit):
    """The folder with the results, or None."""
    command = [tool, "compute", str(path), "-o", str(out), "--quiet", *options]
    try:
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode < 0:
        print(f"{path}: crashed with signal {-done.returncode}", file=sys.stderr, flush=True)
    return out if done.returncode in (0, 3) else None


def strata(tool, out, name):
    if out is None:
        return None
    found = run_models.evaluate(tool, out, name)["structure"]
    return [found[key] for key in STRATA]


def sharp(out, name):
    """Numbers of convex sharp lines and of corners, or None."""
    if out is None:
        return None
    features = json.loads((out / f"{name}.report.json").read_text())["features"]
    return [features["lines"], features["corners"]]


def measured(tool, remesh, kind, path, other, options, limit):
    """Numbers of strata by variant (None: no result), for meshes of other triangles also whether the sharp lines and
    corners are as many, and whether one and two threads give the same bytes."""
    name = path.stem
    result = {"model": f"{kind}/{name}", "strata": {}, "same_sharp_lines": {}, "same_bytes": None}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        original = compute(tool, path, folder / "original", options, limit)
        if original is None:
            return result
        surface = read_ply(original / f"{name}.solid.ply")
        shape, suffix, write = surface, "ply", write_ply
        if kind == "tet":
            tets = folder / "tets.msh"
            subprocess.run([tool, "tetrahedralize", str(path), "-o", str(tets), "--quiet"], check=True)
            shape, suffix, write = read_msh(tets), "msh", write_msh
        header, points, rest = shape
        changed = [(variant, suffix, write, (header, [move(p) for p in points], rest))
                   for variant, move in variants(diagonal_of(points))]
        changed.append(("triangles cut in four", "ply", write_ply, cut_in_four(*surface)))
        for number, (variant, suffix, write, content) in enumerate(changed):
            file = folder / f"{number}" / f"{name}.{suffix}"
            file.parent.mkdir()
            write(file, *content)
            out = compute(tool, file, folder / f"{number}" / "out", options, limit)
            result["strata"][variant] = strata(tool, out, name)
        remeshed = folder / "remeshed" / f"{name}.ply"
        remeshed.parent.mkdir()
        subprocess.run([remesh, str(original / f"{name}.solid.ply"), str(remeshed)], check=True)
        for variant, file in ((REMESHED, remeshed), (OTHER_FILE, other)):
            if file is not None:
                out = compute(tool, file, folder / f"{variant} out", options, limit)
                result["strata"][variant] = strata(tool, out, file.stem)
                result["same_sharp_lines"][variant] = sharp(out, file.stem) == sharp(original, name)
        bytes_of = {}
        for threads in ("1", "2"):
            out = compute(tool, path, folder / f"threads {threads}", [*options, "--threads", threads], limit)
            bytes_of[threads] = out and (out / f"{name}.ma").read_bytes()
        result["same_bytes"] = bytes_of["1"] is not None and bytes_of["1"] == bytes_of["2"]
    return result


# ---------------------------------------------------------------- the table

def columns(results):
    return list(dict.fromkeys(variant for r in results for variant in r["strata"]))[1:]


def agrees(result, variant):
    """Whether a variant has the numbers of the unmoved solid; None if the model has no such variant."""
    numbers = result["strata"].get("as it is")
    return None if variant not in result["strata"] else numbers is not None and numbers == result["strata"][variant]


def share(results, variant):
    answers = [a for a in (agrees(r, variant) for r in results) if a is not None]
    return f"{sum(answers)} of {len(answers)} ({100 * sum(answers) / max(1, len(answers)):.0f} %)"


def summary(results):
    yield ("same bytes for 1 and 2 threads", f"{sum(bool(r['same_bytes']) for r in results)} of {len(results)}", "all")
    for variant in columns(results):
        yield f"same numbers of strata: {variant}", share(results, variant), ">= 95 %"
        if variant in (REMESHED, OTHER_FILE):
            alike = [r for r in results if r["same_sharp_lines"].get(variant)]
            yield f"same numbers of strata: {variant}, with as many sharp lines and corners", share(alike, variant), ""


def row(result, names):
    numbers = result["strata"].get("as it is")
    if numbers is None:
        return [result["model"], "**no result**"]
    cells = []
    for variant in names:
        same, found = agrees(result, variant), result["strata"].get(variant)
        cells.append("" if same is None else "same" if same else
                     "**no result**" if found is None else " ".join(map(str, found)))
    return [result["model"], " ".join(map(str, numbers)), *cells, run_models.yes(result["same_bytes"])]


def markdown(results, facts):
    names = columns(results)
    yield "# Stability of the structure"
    yield ""
    yield "Written by `bench/run_stability.py`; do not edit. " + facts
    yield ""
    yield from run_models.table(["figure", "measured", "wanted"], summary(results))
    yield ""
    yield f"Numbers: {', '.join(STRATA)}."
    yield ""
    yield from run_models.table(["model", "as it is", *names, "same bytes"], (row(r, names) for r in results))


def main():
    parser = run_models.arguments(__doc__, "stability.md")
    parser.add_argument("--remesh", default=str(run_models.ROOT / "build/bench/bench/remesh"))
    args = parser.parse_args()
    if not pathlib.Path(args.remesh).exists():
        sys.exit(f"{args.remesh} is missing: cmake --preset bench; cmake --build --preset bench")
    chosen = run_models.cad_models(args.data, args.only)
    surfaces = {path.stem: path for kind, path in chosen if kind == "surface"}
    tets = {path.stem for kind, path in chosen if kind == "tet"}
    # One entry per solid: a tetrahedral mesh has the surface of the same name as its other mesh.
    chosen = [(kind, path) for kind, path in chosen if kind == "tet" or path.stem not in tets]
    if not chosen:
        sys.exit(f"{args.data}: no CAD models in tet/ or surface/")
    results = []
    for kind, path in chosen:
        other = surfaces.get(path.stem) if kind == "tet" else None
        results.append(measured(args.tool, args.remesh, kind, path, other, args.options, args.limit))
        print(" | ".join(map(str, row(results[-1], columns(results)))), flush=True)
    facts = f"{datetime.date.today()}, {run_models.machine()}; options: {' '.join(args.options) or 'defaults'}."
    run_models.write(args.output, markdown(results, facts), {"facts": facts, "results": results})
    for line in run_models.table(["figure", "measured", "wanted"], summary(results)):
        print(line)


if __name__ == "__main__":
    main()
