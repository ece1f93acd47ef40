#!/usr/bin/env python3
"""Reconstruct every result of folders and keep the figures as docs/reconstruction.md and .json.

    bench/run_reconstruct.py out/ [more folders] [--tool build/release/matstruct] [--only bunny]

Folders are as `matstruct compute` leaves them (NAME.ma, NAME.solid.ply, NAME.report.json). The surface is put beside as
NAME.surface.ply, where pages and pictures look for it. One at a time; processor time is that of the whole command, which
looks for self-intersections exactly (--verify). That the file is a closed 2-manifold, its components and its genus are
counted here, from the triangles; those of the solid come from the Betti numbers of its tetrahedra, in the report. Exits
with 1 if a guarantee fails. Needs python3-numpy.
"""
import argparse
import datetime
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import time

import numpy

from run_models import ROOT, machine, table, write, yes

TIME_S = 20  # aim, every model


def triangles_of(path):
    """The triangles of a binary PLY as the tool writes it: they are the last bytes."""
    data = path.read_bytes()
    header = data[:data.index(b"end_header\n")].decode().splitlines()
    count = next(int(line.split()[2]) for line in header if line.startswith("element face"))
    kind = numpy.dtype([("corners", "u1"), ("ids", "<i4", 3)])
    return numpy.frombuffer(data[len(data) - count * kind.itemsize:], kind)["ids"].astype(numpy.int64)


def fans_of(triangles):
    """Of each half-edge, the least one in the same fan around the vertex that it leaves; None if the triangles are not
    closed: every directed edge once, and its opposite once."""
    size = triangles.max() + 1
    start, end = (numpy.concatenate([triangles[:, k] for k in order]) for order in ((0, 1, 2), (1, 2, 0)))
    forward, backward = numpy.sort(start * size + end), numpy.sort(end * size + start)
    if not (numpy.array_equal(forward, backward) and (numpy.diff(forward) > 0).all()):
        return None
    # Corners of a vertex that share an edge are one fan: rounds around vertices are the cycles of the map below.
    halves = start * size + end
    order = numpy.argsort(halves)
    faces = len(triangles)
    before = numpy.concatenate([numpy.arange(faces) + 2 * faces, numpy.arange(faces), numpy.arange(faces) + faces])
    following = order[numpy.searchsorted(halves, (end * size + start)[before], sorter=order)]
    label, step = numpy.arange(3 * faces), following
    for _ in range(16):  # doubling: fans of up to 2^16 triangles
        label = numpy.minimum(label, label[step])
        step = step[step]
    return label


def components_of(fans):
    """Labels of triangles, whose corners k, k + faces and k + 2 faces are in the fans."""
    faces = len(fans) // 3
    label = numpy.arange(len(fans))
    while True:
        least = label[fans].reshape(3, faces).min(axis=0)
        lower = label.copy()
        for corner in fans.reshape(3, faces):
            numpy.minimum.at(lower, corner, least)
        lower = lower[lower]
        if numpy.array_equal(lower, label):
            return len(numpy.unique(least))
        label = lower


def topology_of(triangles):
    """Closed 2-manifold, components, genus. A vertex with several fans counts once for each."""
    fans = fans_of(triangles)
    if fans is None:
        return {"closed": False, "components": 0, "genus": 0}
    vertices, components = len(numpy.unique(fans)), components_of(fans)
    return {"closed": vertices == len(numpy.unique(triangles)), "components": components,
            "genus": components - (vertices - len(triangles) // 2) // 2}


def topology_of_solid(mesh):
    """Of its surface; where it touches itself, that of what is as near to it as one likes and does not."""
    report = mesh.with_suffix(".report.json")
    if not report.exists():
        return None
    parts, tunnels, cavities = json.loads(report.read_text())["input"]["betti"]
    return {"closed": True, "components": parts + cavities, "genus": tunnels}


def run_one(tool, mesh, options, limit):
    surface, solid = mesh.with_suffix(".surface.ply"), mesh.with_suffix(".solid.ply")
    command = [tool, "reconstruct", str(mesh), "-o", str(surface), "--verify", "--json", "--quiet", *options]
    if solid.exists():
        command += ["--surface", str(solid)]
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    result = {"folder": mesh.parent.name, "model": mesh.stem, "exit": None, "figures": None, "closed": False,
              "like_solid": False, "embedded": False}
    try:
        process = subprocess.run(command, capture_output=True, text=True, timeout=limit)
        result["exit"], result["said"] = process.returncode, process.stderr.strip()
        result["figures"] = json.loads(process.stdout) if process.stdout else None
    except subprocess.TimeoutExpired:
        result["said"] = "over the limit"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    result["seconds"] = time.monotonic() - start
    result["processor_seconds"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if result["figures"]:
        ours = topology_of(triangles_of(surface))
        result["closed"] = ours["closed"]
        result["embedded"] = not result["figures"]["surface"]["self_intersection"]
        result["like_solid"] = ours == topology_of_solid(mesh)
    return result


COLUMNS = ["model", "triangles", "closed", "embedded", "genus", "topology", "to envelope %", "from envelope %", "hidden %",
           "filled %", "to input %", "from input %", "processor s", "s"]


def row(result):
    name, figures = f"{result['folder']}/{result['model']}", result["figures"]
    if not figures:
        return [name, f"**{result['said'].replace('|', '/') or 'no result'}**"]
    envelope, given = figures["envelope"], figures.get("input")
    percent = lambda value: f"{value:.3f}"
    return [name, figures["surface"]["triangles"], yes(result["closed"]), yes(result["embedded"]),
            figures["topology"]["genus"], yes(result["like_solid"]), percent(envelope["surface_to_envelope_percent"]),
            percent(envelope["envelope_to_surface_percent"]), f"{100 * envelope['hidden_share']:.1f}",
            percent(envelope["deepest_filling_percent"]),
            f"{given['surface_to_input_percent']:.2f}" if given else "",
            f"{given['input_to_surface_percent']:.2f}" if given else "", f"{result['processor_seconds']:.1f}",
            f"{result['seconds']:.1f}"]


def summary(results):
    count = lambda holds: f"{sum(bool(r['figures'] and holds(r)) for r in results)} of {len(results)}"
    times = [r["processor_seconds"] for r in results]
    return [("closed 2-manifold", count(lambda r: r["closed"]), "all"),
            ("without self-intersections", count(lambda r: r["embedded"]), "all"),
            ("components and genus equal to the solid's", count(lambda r: r["like_solid"]), "all"),
            ("within the tolerance", count(lambda r: r["figures"]["envelope"]["holds"]), "all"),
            ("with a tunnel or bubble filled", count(lambda r: r["figures"]["envelope"]["deepest_filling_percent"]), ""),
            ("processor time, greatest, s", f"{max(times, default=0):.1f}", f"<= {TIME_S}"),
            ("processor time, median, s", f"{statistics.median(times or [0]):.1f}", "")]


def markdown(results, facts):
    yield from ("# Reconstruction of the test models", "",
                "Written by `bench/run_reconstruct.py`; do not edit. " + facts, "")
    yield from table(["figure", "measured", "wanted"], summary(results))
    yield from ("", "Embedded: no self-intersection, looked for exactly. Topology: components and genus of the solid. Columns, "
                "in % of the diagonal: greatest distances from the surface to the envelope and back; share of the envelope's "
                "area in closed cracks; half width of the widest tunnel or bubble that was filled for the topology; "
                "two-sided distance to the solid's surface. Words: `docs/design/reconstruct.md`. Bold: a guarantee fails.",
                "")
    yield from table(COLUMNS, map(row, results))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    parser.add_argument("--tool", default=str(ROOT / "build/release/matstruct"))
    parser.add_argument("--only", nargs="*", default=[], help="results whose name contains one of these")
    parser.add_argument("--limit", type=float, default=300, help="seconds after which a run is killed")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs/reconstruction.md")
    parser.add_argument("--option", action="append", default=[], help="passed to `matstruct reconstruct`, as --option=--verify")
    args = parser.parse_args()
    meshes = [mesh for folder in args.folders for mesh in sorted(folder.glob("*.ma"))
              if not args.only or any(word in mesh.stem for word in args.only)]
    if not meshes:
        sys.exit("no results there; run 'matstruct compute' first")
    version = subprocess.run([args.tool, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    facts = f"{version}, {datetime.date.today()}, {machine()}; options: {' '.join(args.option) or 'defaults'}."
    results = []
    for mesh in meshes:
        results.append(run_one(args.tool, mesh, args.option, args.limit))
        print(" ".join(map(str, row(results[-1]))), flush=True)
        write(args.output, markdown(results, facts), {"facts": facts, "results": results})
    for line in table(["figure", "measured", "wanted"], summary(results)):
        print(line)
    sys.exit(0 if all(r["exit"] == 0 and r["closed"] and r["like_solid"] for r in results) else 1)


if __name__ == "__main__":
    main()
