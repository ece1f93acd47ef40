#!/usr/bin/env python3
"""Run the tool on CAD files, compare them with surfaces of the same name, and vary the size of the tets.

    bench/run_cad.py [--tool build/release/matstruct] [--data ../shared/data]

Writes docs/cad.md. Exits with 1 if a file has no result or a wrong topology. Python's standard library only.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
SIZES = (0, 0.2, 0.1, 0.05)  # --tet-size
STRATA = ("sheets", "seams", "junctions", "boundaries", "curves")
COMPARED = 3  # of them: how a free border is cut into pieces and where a medial curve ends is the sampling's
SIZED = ("part-1", "part-7", "trimesh_base_interface_ap203")


def run(tool, path, *options):
    """Reports by part, seconds of the command, what it said."""
    with tempfile.TemporaryDirectory() as out:
        start = time.monotonic()
        done = subprocess.run([tool, "compute", str(path), "-o", out, "--quiet", *options], capture_output=True, text=True,
                              timeout=300)
        seconds = time.monotonic() - start
        reports = [json.loads(report.read_text()) for report in sorted(pathlib.Path(out).glob("*.report.json"))]
    return reports, seconds, done.stderr.strip()


def betti(report):
    return " ".join(map(str, report["topology"]["betti"]))


def cad_rows(tool, files, options):
    for path in files:
        reports, seconds, said = run(tool, path, *options)
        if not reports:
            yield [path.stem, f"**{said}**"], False
        reading = sum(report["input"]["seconds"] for report in reports)
        for report in reports:
            name = path.stem + (f" / {report['input']['part']}" if report["input"]["part"] else "")
            features = report["features"]
            yield [name, report["input"]["tets"], f"{report['input']['deviation_percent']:.3f}", betti(report),
                   "yes" if report["topology"]["equal"] else "**no**",
                   f"{features['lines_preserved']}/{features['lines']}", report["mesh"]["spheres"],
                   f"{report['metrics']['hausdorff_percent']:.2f}", f"{seconds:.1f}", f"{100 * reading / seconds:.0f}"], \
                report["topology"]["equal"]


def twin_rows(tool, data, options):
    for cad in sorted((data / "cad").glob("part-*.step"), key=lambda p: int(p.stem.split("-")[1])):
        twin = data / "surface" / (cad.stem + ".stl")
        if not twin.exists():
            continue
        pair = [run(tool, path, *options)[0][0] for path in (cad, twin)]
        cells = [cad.stem]
        for value in (betti, lambda r: r["features"]["lines"], lambda r: r["features"]["corners"],
                      lambda r: r["input"]["tets"], lambda r: r["mesh"]["spheres"]):
            cells.append(" / ".join(str(value(report)) for report in pair))
        numbers = [[report["structure"][key] for key in STRATA] for report in pair]
        cells += [" / ".join(map(str, both)) for both in zip(*numbers)]
        same = numbers[0][:COMPARED] == numbers[1][:COMPARED]
        yield cells + ["yes" if same else "**no**"]


def size_rows(tool, data, options):
    for name in SIZED:
        for size in SIZES:
            reports, seconds, said = run(tool, data / "cad" / (name + ".step"), "--tet-size", str(size), *options)
            if not reports:
                yield [name, size, f"**{said}**"]
                continue
            report = reports[0]
            stages = {stage["name"]: stage["seconds"] for stage in report["stages"]}
            yield [name, size or "automatic", report["input"]["tets"], report["mesh"]["spheres"],
                   f"{report['metrics']['triangle_quality']:.3f}", f"{report['metrics']['hausdorff_percent']:.2f}",
                   f"{stages.get('restricted power diagram', 0):.2f}", f"{seconds:.1f}"]


def table(header, rows):
    yield "| " + " | ".join(header) + " |"
    yield "|" + "---|" * len(header)
    for cells in rows:
        yield "| " + " | ".join(str(cell) for cell in list(cells) + [""] * (len(header) - len(cells))) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tool", default=str(ROOT / "build/release/matstruct"))
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs/cad.md")
    parser.add_argument("options", nargs="*", default=["--samples", "20000"], help="for `matstruct compute`, after --")
    args = parser.parse_args()
    results = list(cad_rows(args.tool, sorted((args.data / "cad").iterdir()), args.options))
    text = ["# CAD input", "", "Written by `bench/run_cad.py`; do not edit. Options: " + " ".join(args.options) + ".", "",
            "## Every file", "",
            "Deviation: measured between triangles and CAD surface, % of the diagonal. Lines: convex sharp lines kept / "
            "all. Reading: share of the command's time until tetrahedra are there, all parts together.", ""]
    text += table(["model / part", "tets", "deviation %", "Betti", "topology", "lines", "spheres", "Hausdorff %", "time s",
                   "reading %"], [cells for cells, _ in results])
    text += ["", "## STEP files and their STL twins", "",
             "STEP / STL. Lines are convex sharp lines; the last column tells whether sheets, seams and junctions are as "
             "many.", ""]
    text += table(["model", "Betti", "lines", "corners", "tets", "spheres", *STRATA, "same structure"],
                  twin_rows(args.tool, args.data, args.options))
    text += ["", "## Number of tets against quality and time", "",
             "`--tet-size` is the greatest length of edges inside, in diagonals; automatic: as coarse as the surface "
             "allows. RPD: seconds of the restricted power diagram alone. What changes quality and distance is the "
             "sampling, within the scatter of its random choices; more tets only cost time, so the default adds none.", ""]
    text += table(["model", "tet size", "tets", "spheres", "TQ", "Hausdorff %", "RPD s", "time s"],
                  size_rows(args.tool, args.data, args.options))
    args.output.write_text("\n".join(text) + "\n")
    sys.exit(0 if all(good for _, good in results) else 1)


if __name__ == "__main__":
    main()
