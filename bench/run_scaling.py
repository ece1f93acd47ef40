#!/usr/bin/env python3
"""Time of the whole command against the number of spheres and of tetrahedra, with the share of every stage.

    bench/run_scaling.py --tool build/release/matstruct [--data ../shared/data] [--only part-1 00000068]

Every model is run at several gammas, and every surface at one of them with smaller and smaller tetrahedra, nothing beside
it. Compares with the times that the paper gives for its numbers of spheres. Writes docs/scaling.md, .json and .png; the
picture needs matplotlib and is left out without it.
"""
import datetime
import math
import sys

import run_models

GAMMAS = (20, 30, 40, 60, 80, 120)
TET_SIZES, TET_GAMMA = (0.05, 0.03, 0.02, 0.014, 0.01), 40  # in diagonals, and the gamma that goes with them
MODELS = ("00000068", "fandisk_tm", "part-1", "fertility", "socket")
# The paper's running times: spheres, seconds (8 cores and a GPU).
PAPER = [(846, 360), (2300, 600), (2600, 480), (5700, 1020)]


def paper_seconds(spheres):
    """Of the paper's model whose number of spheres is nearest by ratio, scaled in proportion to the number."""
    nearest = min(PAPER, key=lambda row: abs(math.log(row[0] / spheres)))
    return nearest[1] * spheres / nearest[0]


def measured(tool, kind, path, gamma, tet_size, options, limit):
    sampling = ["--gamma", f"{gamma:g}", "--tet-size", f"{tet_size:g}"]
    outcome = run_models.run_one(tool, path, [*sampling, *options], limit)
    report = outcome["report"]
    return report and {"model": f"{kind}/{path.stem}", "gamma": gamma, "tet_size": tet_size,
                       "tets": report["input"]["tets"], "spheres": report["mesh"]["spheres"], "seconds": outcome["seconds"],
                       "stages": {stage["name"]: stage["seconds"] for stage in report["stages"]}}


def markdown(runs, facts, picture):
    stages = list(dict.fromkeys(name for run in runs for name in run["stages"]))
    yield "# Time against size"
    yield ""
    yield "Written by `bench/run_scaling.py`; do not edit. " + facts
    yield ""
    yield ("Time of the whole command, tetrahedralisation included; stages in % of it. Times faster: than the paper's "
           "time for the model with the nearest number of spheres, in proportion to the number. Tet size: greatest "
           "length of edges inside the solid, in diagonals; without one as coarse as the surface allows.")
    yield ""
    header = ["model", "gamma", "tet size", "tets", "spheres", "time s", "ms per sphere", "times faster than the paper",
              *stages]
    rows = ([run["model"], f"{run['gamma']:g}", f"{run['tet_size']:g}" if run["tet_size"] else "", run["tets"],
             run["spheres"], f"{run['seconds']:.2f}", f"{1000 * run['seconds'] / run['spheres']:.2f}",
             f"{paper_seconds(run['spheres']) / run['seconds']:.0f}",
             *(f"{100 * run['stages'].get(stage, 0) / run['seconds']:.0f}" for stage in stages)] for run in runs)
    yield from run_models.table(header, rows)
    if picture:
        yield ""
        yield f"![Time against the number of spheres and of tetrahedra]({picture.name})"


def draw(runs, path):
    """True if there is a picture."""
    try:
        import matplotlib
    except ImportError:
        return False
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, panels = plt.subplots(1, 2, figsize=(11, 4))
    own_sizes = [run for run in runs if not run["tet_size"]]
    one_gamma = [run for run in runs if run["gamma"] == TET_GAMMA and run["model"].startswith("surface/")]
    for axes, shown, key, label in ((panels[0], own_sizes, "spheres", "spheres"),
                                    (panels[1], one_gamma, "tets", f"tetrahedra, gamma {TET_GAMMA}")):
        for model in dict.fromkeys(run["model"] for run in shown):
            own = sorted((run[key], run["seconds"]) for run in shown if run["model"] == model)
            axes.plot(*zip(*own), marker="o", markersize=4, label=model)
        axes.set(xscale="log", yscale="log", xlabel=label, ylabel="seconds, whole command")
        axes.grid(True, which="both", alpha=0.3)
    panels[0].plot(*zip(*PAPER), "kx", label="paper, 8 cores and a GPU")
    for axes in panels:
        axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=150)
    return True


def main():
    parser = run_models.arguments(__doc__, "scaling.md", MODELS, 600)
    parser.add_argument("--gamma", nargs="*", type=float, default=GAMMAS)
    args = parser.parse_args()
    chosen = run_models.models(args.data, args.only)
    if not chosen:
        sys.exit(f"{args.data}: no models in tet/ or surface/")
    runs = []
    for kind, path in chosen:
        samplings = [(gamma, 0) for gamma in args.gamma]
        if kind == "surface":
            samplings += [(TET_GAMMA, size) for size in TET_SIZES]
        for gamma, tet_size in samplings:
            run = measured(args.tool, kind, path, gamma, tet_size, args.options, args.limit)
            if run is None:
                print(f"{kind}/{path.stem} at gamma {gamma:g}, tet size {tet_size:g}: no result", flush=True)
                continue
            runs.append(run)
            print(f"{run['model']} gamma {gamma:g}: {run['tets']} tets, {run['spheres']} spheres, {run['seconds']:.2f} s",
                  flush=True)
    if not runs:
        sys.exit("no run has a result")
    facts = f"{datetime.date.today()}, {run_models.machine()}; options: {' '.join(args.options) or 'defaults'}."
    picture = args.output.with_suffix(".png")
    drawn = draw(runs, picture)
    run_models.write(args.output, markdown(runs, facts, picture if drawn else None), {"facts": facts, "runs": runs})


if __name__ == "__main__":
    main()
