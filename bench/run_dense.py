#!/usr/bin/env python3
"""The distance of dense results: every CAD model with gamma raised until the mesh has a given number of spheres.

    bench/run_dense.py --tool build/release/matstruct [--data ../shared/data] [--only part-1] [--spheres 10000]

The first gamma follows from the numbers of spheres in docs/results.json: they grow with its square. Writes docs/dense.md
and .json. Exits with 1 if a model has no result or a guarantee fails. Python's standard library only.
"""
import datetime
import json
import math
import statistics
import sys

import run_models

MOST_RUNS = 3  # per model
MARGIN = 1.05  # on the number of spheres asked for


def spheres_known(path):
    """(kind, model): gamma and number of spheres of the last run of run_models.py."""
    if not path.exists():
        return {}
    return {(r["kind"], r["model"]): (r["report"]["options"]["gamma"], r["report"]["mesh"]["spheres"])
            for r in json.loads(path.read_text())["results"] if r["report"]}


def dense(tool, kind, path, first, spheres, options, limit):
    """The run whose mesh has the spheres; of runs that do not come to it the last."""
    gamma, number = first
    for _ in range(MOST_RUNS):
        gamma *= math.sqrt(MARGIN * spheres / number)
        run = run_models.measured(tool, kind, path, ["--gamma", f"{gamma:.6g}", *options], limit)
        run["gamma"] = gamma
        if not run["report"]:
            break
        number = run["report"]["mesh"]["spheres"]
        if number >= spheres:
            break
    return run


def row(run):
    report = run["report"]
    cells = [f"{run['kind']}/{run['model']}", f"{run['gamma']:.0f}"]
    if not report:
        return cells + [f"**{run['said'] or 'over the time limit'}**"]
    metrics = report["metrics"]
    return cells + [report["mesh"]["spheres"], "yes" if report["guarantees_hold"] else "**no**",
                    f"{metrics['hausdorff_percent']:.3f}", f"{metrics['triangle_quality']:.3f}", f"{metrics['mser']:.4f}",
                    f"{run['seconds']:.1f}", f"{1000 * run['seconds'] / report['mesh']['spheres']:.2f}"]


def markdown(runs, spheres, facts):
    done = [run for run in runs if run["report"]]
    mean = lambda value: statistics.mean(map(value, done))
    yield "# Dense results"
    yield ""
    yield "Written by `bench/run_dense.py`; do not edit. " + facts
    yield ""
    yield f"CAD models with gamma raised until the mesh has {spheres} spheres."
    yield ""
    yield from run_models.table(["figure", "measured", "wanted"], [
        ["models with a result", f"{len(done)} of {len(runs)}", ""],
        ["all guarantees hold", f"{sum(run['report']['guarantees_hold'] for run in done)} of {len(runs)}", "all"],
        ["two-sided Hausdorff distance, mean, % of the diagonal",
         f"{mean(lambda run: run['report']['metrics']['hausdorff_percent']):.3f}", "<= 0.25"],
        ["time of the command per sphere, mean, ms",
         f"{mean(lambda run: 1000 * run['seconds'] / run['report']['mesh']['spheres']):.2f}", ""]])
    yield ""
    yield from run_models.table(["model", "gamma", "spheres", "guarantees", "Hausdorff %", "TQ", "MSER", "time s",
                                 "ms per sphere"], map(row, runs))


def main():
    parser = run_models.arguments(__doc__, "dense.md")
    parser.add_argument("--spheres", type=int, default=10000)
    args = parser.parse_args()
    known = spheres_known(run_models.ROOT / "docs/results.json")
    runs = []
    for kind, path in run_models.cad_models(args.data, args.only):
        run = dense(args.tool, kind, path, known.get((kind, path.stem), (40, 2500)), args.spheres, args.options, args.limit)
        runs.append(run)
        print(" | ".join(map(str, row(run))), flush=True)
    if not any(run["report"] for run in runs):
        sys.exit("no run has a result")
    facts = f"{datetime.date.today()}, {run_models.machine()}; options: {' '.join(args.options) or 'defaults'}"
    facts += f"; of the models only {' '.join(args.only)}." if args.only else "."
    run_models.write(args.output, markdown(runs, args.spheres, facts), {"facts": facts, "runs": runs})
    sys.exit(any(not run["report"] or not run["report"]["guarantees_hold"] for run in runs))


if __name__ == "__main__":
    main()
