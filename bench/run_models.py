#!/usr/bin/env python3
"""Run the tool on every model of a folder and keep the figures as docs/results.md and docs/results.json.

    bench/run_models.py --tool build/release/matstruct [--data ../shared/data] [--only bunny]

Models are the tetrahedral meshes in DATA/tet and the surfaces in DATA/surface. One at a time, so that times mean
something. Measures are the reports' own, the numbers of the strata those of `matstruct evaluate`; time and memory of
the whole command are taken from outside. Exits with 1 if a model has no result or a guarantee fails. Python's standard
library only.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
TET_FORMATS = {".msh", ".mesh", ".vtk", ".vtu"}
SURFACE_FORMATS = {".stl", ".obj", ".off", ".ply"}
# Models without sharp edges by design; the others are CAD parts, over which the distance is averaged.
ORGANIC = {"bunny", "fertility", "elephant_igl", "3holes", "quadknot", "bear"}
# Surfaces that bound no solid (open, or not manifold, as given): a refusal is the right answer for them.
NO_SOLIDS = {"not_convex"}

TIME_LIMIT_S = 60      # the whole command, every model
MEDIAN_TIME_S = 10
# Means over the models, and for MSER the greatest value.
WANTED = {"cad": {"mser": 0.005, "mser_greatest": 0.05, "triangle_quality": 0.75, "hausdorff_percent": 0.6},
          "organic": {"triangle_quality": 0.72, "hausdorff_percent": 0.62}}
# Sheets, seams, junctions and medial curves of solids of revolution, with and without rims.
KNOWN_STRUCTURE = {"cylinder": (2, 0, 0, 1), "torus": (0, 0, 0, 1), "tube": (5, 2, 0, 0)}
GUARANTEES = {"topology": "equal", "thin": "holds", "tiling": "holds", "features": "holds", "preservation": "holds"}


def models(data, only):
    found = [("tet", path) for path in sorted((data / "tet").glob("*")) if path.suffix in TET_FORMATS]
    found += [("surface", path) for path in sorted((data / "surface").glob("*")) if path.suffix in SURFACE_FORMATS]
    return [(kind, path) for kind, path in found if not only or any(word in path.stem for word in only)]


def cad_models(data, only):
    """Those of them that are CAD parts and bound a solid."""
    return [(kind, path) for kind, path in models(data, only)
            if path.stem not in ORGANIC and not (kind == "surface" and path.stem in NO_SOLIDS)]


def arguments(description, output, only=None, limit=300):
    """The parser of a bench over models, for what they have in common; `output`: the table's name in docs."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("--tool", default=str(ROOT / "build/release/matstruct"))
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--only", nargs="*", default=only, help="models whose name contains one of these")
    parser.add_argument("--limit", type=float, default=limit, help="seconds after which a run is killed")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs" / output, help="further files go beside it")
    parser.add_argument("options", nargs="*", help="options for `matstruct compute`, after --")
    return parser


def write(output, lines, data):
    """The table, and beside it the data that it was made of as JSON."""
    output.write_text("\n".join(lines) + "\n")
    output.with_suffix(".json").write_text(json.dumps(data, indent=1) + "\n")


def evaluate(tool, out, name):
    """What `matstruct evaluate` finds of a result; the distance, which the report has, from few samples."""
    command = [tool, "evaluate", str(out / f"{name}.ma"), "--surface", str(out / f"{name}.solid.ply"), "--samples",
               "1000", "--json", "--quiet"]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def run_one(tool, path, options, limit):
    """The command's outcome: exit code (None: over the limit), seconds, last line said, report, evaluation."""
    with tempfile.TemporaryDirectory() as out:
        command = [tool, "compute", str(path), "-o", out, *options]
        start = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            said = process.communicate(timeout=limit)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            said = process.communicate()[1]
        seconds = time.monotonic() - start
        report = pathlib.Path(out) / f"{path.stem}.report.json"
        evaluation = evaluate(tool, pathlib.Path(out), path.stem) if report.exists() else None
        return {"exit": process.returncode if process.returncode >= 0 else None, "signal": -min(process.returncode, 0),
                "seconds": seconds, "said": (said.strip().splitlines() or [""])[-1],
                "report": json.loads(report.read_text()) if report.exists() else None, "evaluation": evaluation}


def measured(tool, kind, path, options, limit):
    outcome = run_one(tool, path, options, limit)
    cad = path.stem not in ORGANIC
    refused_rightly = kind == "surface" and path.stem in NO_SOLIDS and outcome["exit"] == 1
    return {"kind": kind, "model": path.stem, "cad": cad, "refused_rightly": refused_rightly, **outcome}


# ---------------------------------------------------------------- the table

def yes(flag):
    return "yes" if flag else "**no**"


COLUMNS = ["model", "tets", "spheres", "faces", "Betti", "topology", "thin", "tiling", "lines", "inserted", "TQ",
           "Hausdorff %", "MSER", "medialness mean %", "max %", "spikes", "sheets", "seams", "junctions", "structure",
           "time s", "memory MiB"]


def structure(model, strata):
    """The numbers of sheets, seams and junctions, and whether they are right where that is known."""
    known = KNOWN_STRUCTURE.get(model)
    found = tuple(strata[name] for name in ("sheets", "seams", "junctions", "curves"))
    return [*found[:3], "" if known is None else yes(found == known)]


def row(result):
    name = f"{result['kind']}/{result['model']}"
    report = result["report"]
    if report is None:
        if result["refused_rightly"]:
            return [name, "refused: not a closed surface"]
        why = "killed after the time limit" if result["signal"] == 9 else f"signal {result['signal']}" \
            if result["signal"] else f"exit code {result['exit']}: {result['said'].replace('|', '/')}"
        return [name, f"**{why}**"]
    features, preservation, metrics = report["features"], report["preservation"], report["metrics"]
    lines = f"{features['lines_preserved']}/{features['lines']}"
    return [name, report["input"]["tets"], report["mesh"]["spheres"], report["mesh"]["faces"],
            " ".join(map(str, report["topology"]["betti"])), yes(report["topology"]["equal"]),
            yes(report["thin"]["holds"]), f"{report['tiling']['volume_error']:.0e}" if report["tiling"]["holds"]
            else f"**{report['tiling']['volume_error']:.0e}**", lines if features["holds"] else f"**{lines}**",
            preservation["inserted"], f"{metrics['triangle_quality']:.3f}",
            f"{metrics['hausdorff_percent']:.2f}", f"{metrics['mser']:.3f}",
            f"{metrics['medialness_mean_percent']:.3f}", f"{metrics['medialness_max_percent']:.2f}", metrics["spikes"],
            *structure(result["model"], result["evaluation"]["structure"]), f"{result['seconds']:.1f}",
            f"{report['peak_memory_mib']:.0f}"]


def known_right(done):
    known = [r for r in done if r["model"] in KNOWN_STRUCTURE]
    right = sum(structure(r["model"], r["evaluation"]["structure"])[-1] == "yes" for r in known)
    return f"{right} of {len(known)}"


def summary(results):
    """Lines (what, value, wanted) over all models that can have a result."""
    due = [r for r in results if not r["refused_rightly"]]
    done = [r for r in due if r["report"]]
    reports = [r["report"] for r in done]
    out_of = lambda count: f"{count} of {len(due)}"
    holding = lambda name: out_of(sum(bool(report[name][GUARANTEES[name]]) for report in reports))
    mean = lambda values: f"{statistics.mean(values):.3f}" if values else "-"
    seconds = [r["seconds"] for r in due]
    cad, organic = ([r["report"] for r in done if r["cad"] == kind] for kind in (True, False))
    of = lambda name, group: [report["metrics"][name] for report in group]
    lines = [sum(report["features"][key] for report in cad) for key in ("lines_preserved", "lines")]
    return [
        ("models with a result", out_of(len(done)), "all"),
        ("topology equal (b0, b1, b2)", holding("topology"), "all"),
        ("thin", holding("thin"), "all"),
        ("cells tile the solid (volume to 1e-9, Euler characteristic)", holding("tiling"), "all"),
        ("convex sharp lines preserved, CAD models", f"{lines[0]} of {lines[1]}", "all"),
        ("MSER, mean over CAD models", mean(of("mser", cad)), f"<= {WANTED['cad']['mser']}"),
        ("MSER, greatest of a CAD model", f"{max(of('mser', cad), default=0):.3f}",
         f"<= {WANTED['cad']['mser_greatest']}"),
        ("triangle quality, mean over CAD models", mean(of("triangle_quality", cad)),
         f">= {WANTED['cad']['triangle_quality']}"),
        ("two-sided Hausdorff distance, mean over CAD models, % of the diagonal", mean(of("hausdorff_percent", cad)),
         f"<= {WANTED['cad']['hausdorff_percent']}"),
        ("MSER, mean over organic models", mean(of("mser", organic)), ""),
        ("triangle quality, mean over organic models", mean(of("triangle_quality", organic)),
         f">= {WANTED['organic']['triangle_quality']}"),
        ("two-sided Hausdorff distance, mean over organic models, % of the diagonal",
         mean(of("hausdorff_percent", organic)), f"<= {WANTED['organic']['hausdorff_percent']}"),
        ("medialness, mean over all models of the mean, % of the diagonal",
         mean(of("medialness_mean_percent", reports)), ""),
        ("medialness, greatest, % of the diagonal", f"{max(of('medialness_max_percent', reports), default=0):.2f}", ""),
        ("spikes, all models", sum(of("spikes", reports)), ""),
        ("structure right, solids of revolution", known_right(done), "all"),
        ("triangle quality, mean over all models", mean(of("triangle_quality", reports)), ""),
        ("spheres, median", f"{statistics.median([r['mesh']['spheres'] for r in reports] or [0]):.0f}", ""),
        ("time of the whole command, greatest, s", f"{max(seconds, default=0):.1f}", f"<= {TIME_LIMIT_S}"),
        ("time of the whole command, median, s", f"{statistics.median(seconds or [0]):.1f}", f"<= {MEDIAN_TIME_S}"),
        ("peak memory, greatest, MiB", f"{max([r['peak_memory_mib'] for r in reports], default=0):.0f}", ""),
    ]


def table(header, rows):
    yield "| " + " | ".join(header) + " |"
    yield "|" + "---|" * len(header)
    for cells in rows:
        yield "| " + " | ".join(str(cell) for cell in list(cells) + [""] * (len(header) - len(cells))) + " |"


def markdown(results, facts):
    yield "# Results on the test models"
    yield ""
    yield "Written by `bench/run_models.py`; do not edit. " + facts
    yield ""
    yield from table(["figure", "measured", "wanted"], summary(results))
    yield ""
    yield ("Columns: Betti numbers of the medial mesh; topology: equal to the solid's; tiling: relative error of the "
           "sum of cell volumes; lines: convex sharp lines preserved / all; inserted: spheres added to keep topology "
           "and features; TQ: triangle quality; Hausdorff: two-sided, % of the diagonal; MSER: share of seam and "
           "junction spheres that are not what they claim; medialness: |radius - distance to the surface| over the "
           "faces, % of the diagonal; spikes: sheet spheres without a second contact; sheets, seams, junctions: traced "
           "in the mesh; structure: they are right, where that is known; time of the whole command, tetrahedralisation "
           "included. Bold: a guarantee or a known structure fails.")
    yield ""
    yield from table(COLUMNS, map(row, results))


def machine():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    return f"{len(os.sched_getaffinity(0))} cores, {names[0] if names else platform.machine()}"


def main():
    args = arguments(__doc__, "results.md").parse_args()
    chosen = models(args.data, args.only)
    if not chosen:
        sys.exit(f"{args.data}: no models in tet/ or surface/")
    results = []
    for kind, path in chosen:
        results.append(measured(args.tool, kind, path, args.options, args.limit))
        print(" ".join(map(str, row(results[-1]))), flush=True)
    version = subprocess.run([args.tool, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    facts = f"{version}, {datetime.date.today()}, {machine()}; options: {' '.join(args.options) or 'defaults'}."
    write(args.output, markdown(results, facts), {"facts": facts, "results": results})
    for line in table(["figure", "measured", "wanted"], summary(results)):
        print(line)
    sys.exit(0 if all(r["refused_rightly"] or r["exit"] == 0 for r in results) else 1)


if __name__ == "__main__":
    main()
