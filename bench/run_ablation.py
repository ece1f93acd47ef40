#!/usr/bin/env python3
"""What density and each part of the method buy: means over the CAD models, without and with it.

    bench/run_ablation.py --tool build/release/matstruct [--data ../shared/data] [--only part-] [--gamma 20 40]

Variants are the defaults, those of VARIANTS, and one for every flag of `matstruct compute --help` that begins with
--no-, each at every gamma. Writes docs/ablation.md and .json. Python's standard library only.
"""
import datetime
import re
import statistics
import subprocess
import sys

import run_models

GAMMAS = (20, 30, 40, 60, 80)
PARTICLES = ["--particle-rounds", "30"]
# What a switch needs to make a difference.
NEEDED = {"--no-gradient-projection": PARTICLES}
# Further variants: name, options of `matstruct compute`.
VARIANTS = [("no thinning of faces", ["--thinning", "0"]), ("no refinement", ["--refinements", "0"]),
            ("tets of 0.1 diagonals", ["--tet-size", "0.1"]), ("tets of 0.04 diagonals", ["--tet-size", "0.04"]),
            ("particles", PARTICLES), ("particles, no remesh", [*PARTICLES, "--no-remesh"])]


def variants(tool):
    text = subprocess.run([tool, "compute", "--help"], capture_output=True, text=True, check=True).stdout
    switches = list(dict.fromkeys(re.findall(r"(?<![\w-])--no-[\w-]+", text)))
    return [("all", []), *VARIANTS,
            *((switch[2:].replace("-", " "), [switch, *NEEDED.get(switch, [])]) for switch in switches)]


# ---------------------------------------------------------------- figures of one variant

def mean(values):
    return statistics.mean(values) if values else float("nan")


def figures(results):
    """Means over the models that have a result, and shares of all."""
    reports = [r["report"] for r in results if r["report"]]
    metric = lambda name: mean([report["metrics"][name] for report in reports])
    strata = lambda name: mean([r["evaluation"]["structure"][name] for r in results if r["evaluation"]])
    wrong = sum(r["report"] is None or not r["report"]["topology"]["equal"] for r in results)
    return {"models": len(reports), "spheres": mean([report["mesh"]["spheres"] for report in reports]),
            "mser": metric("mser"), "triangle_quality": metric("triangle_quality"),
            "topology_error": wrong / len(results), "hausdorff_percent": metric("hausdorff_percent"),
            "medialness_mean_percent": metric("medialness_mean_percent"), "spike_share": metric("spike_share"),
            "sheets": strata("sheets"), "seams": strata("seams"), "junctions": strata("junctions"),
            "seconds": mean([r["seconds"] for r in results])}


# ---------------------------------------------------------------- the table

COLUMNS = ["gamma", "variant", "models", "spheres", "MSER", "TQ", "TER", "Hausdorff %", "medialness %", "spikes %",
           "sheets", "seams", "junctions", "time s"]


def row(entry):
    f = entry["figures"]
    return [f"{entry['gamma']:g}", entry["variant"], f["models"], f"{f['spheres']:.0f}", f"{f['mser']:.4f}",
            f"{f['triangle_quality']:.3f}", f"{f['topology_error']:.2f}", f"{f['hausdorff_percent']:.3f}",
            f"{f['medialness_mean_percent']:.4f}", f"{100 * f['spike_share']:.2f}", f"{f['sheets']:.0f}",
            f"{f['seams']:.0f}", f"{f['junctions']:.0f}", f"{f['seconds']:.1f}"]


def markdown(entries, facts):
    yield "# What each part buys"
    yield ""
    yield "Written by `bench/run_ablation.py`; do not edit. " + facts
    yield ""
    yield ("Means over the models. MSER: share of seam and junction spheres that are not what they claim; TQ: triangle "
           "quality; TER: share of models with wrong topology or no result; Hausdorff distance and medialness in % of "
           "the diagonal; spikes in % of the sheet spheres; time of the whole command.")
    yield ""
    yield from run_models.table(COLUMNS, map(row, sorted(entries, key=lambda entry: entry["gamma"])))


def main():
    parser = run_models.arguments(__doc__, "ablation.md")
    parser.add_argument("--gamma", nargs="*", type=float, default=GAMMAS)
    args = parser.parse_args()
    chosen = run_models.cad_models(args.data, args.only)
    if not chosen:
        sys.exit(f"{args.data}: no CAD models in tet/ or surface/")
    facts = (f"{datetime.date.today()}, {run_models.machine()}, {len(chosen)} models; further options: "
             f"{' '.join(args.options) or 'none'}.")
    entries = []
    for gamma in args.gamma:
        for name, switches in variants(args.tool):
            options = ["--gamma", f"{gamma:g}", *switches, *args.options]
            results = [run_models.measured(args.tool, kind, path, options, args.limit) for kind, path in chosen]
            entries.append({"gamma": gamma, "variant": name, "figures": figures(results)})
            print(" | ".join(map(str, row(entries[-1]))), flush=True)
        # After each gamma: a run takes an hour.
        run_models.write(args.output, markdown(entries, facts), {"facts": facts, "entries": entries})


if __name__ == "__main__":
    main()
