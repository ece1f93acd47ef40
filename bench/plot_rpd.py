#!/usr/bin/env python3
r"""Plot and tables of docs/performance.md from the figures of bench/rpd_bench.

    build/bench/bench/rpd_bench --benchmark_repetitions=3 --benchmark_enable_random_interleaving=true \
        --benchmark_out=rpd.json
    bench/plot_rpd.py rpd.json

Takes several files, too. Writes docs/rpd_scaling.png and the part of docs/performance.md between its two marks. Of
repeated runs the fastest counts: other work on the machine only ever adds to a time. Needs matplotlib.
"""
import argparse
import json
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def read(paths):
    """Fastest run of each benchmark by name: wall and CPU time in ms, counters."""
    best = {}
    for run in (run for path in paths for run in json.loads(path.read_text())["benchmarks"]):
        if run["run_type"] != "iteration":
            continue
        name = "/".join(p for p in run["run_name"].split("/") if p not in ("process_time", "real_time")
                        and not p.startswith("iterations:"))
        kept = best.setdefault(name, {**run, "wall": math.inf, "cpu": math.inf})
        kept["wall"] = min(kept["wall"], run["real_time"])
        kept["cpu"] = min(kept["cpu"], run["cpu_time"])
    return best


def table(header, rows):
    yield "| " + " | ".join(header) + " |"
    yield "|" + "---|" * len(header)
    for row in rows:
        yield "| " + " | ".join(row) + " |"


def against_cgal(runs):
    for name in sorted(n.split("/")[1] for n in runs if n.startswith("cgal/")):
        cgal, one, two = (runs[key] for key in (f"cgal/{name}", f"rpd/{name}/threads:1", f"rpd/{name}/threads:2"))
        yield [name, f"{two['tets']:.0f}", f"{two['spheres']:.0f}", f"{two['cells']:.0f}",
               f"**{one['cpu'] / cgal['cpu']:.1f}**", f"{two['wall'] / cgal['wall']:.1f}", f"{two['wall']:.0f}",
               f"{cgal['wall']:.0f}", f"{runs[f'exact/{name}']['exact']:.0f}"]


def updates(runs):
    for name, run in sorted(runs.items()):
        if name.startswith("update/"):
            _, model, change = name.split("/")
            full = runs[f"rpd/{model}/threads:2"]
            yield [model, change, f"**{run['wall'] / full['wall']:.2f}**", f"{run['wall']:.0f}", f"{full['wall']:.0f}"]


def series(runs, name):
    found = sorted((run["spheres"], run["cpu"]) for key, run in runs.items() if key.startswith(name + "/"))
    return [n for n, _ in found], [t for _, t in found]


def growth(runs):
    for name, what in SERIES.items():
        sizes, times = series(runs, name)
        rate = [t / (n * math.log(n)) for n, t in zip(sizes, times)]
        yield [what] + [f"{r / rate[0]:.2f}" for r in rate]


SERIES = {"scaling_fixed": "diagram, 10k tets", "scaling_proportional": "diagram, 5/3 tets per sphere",
          "scaling_cgal": "CGAL's triangulation alone"}


def plot(runs, path):
    figure, axes = plt.subplots(figsize=(6, 4.2))
    for (name, what), style in zip(SERIES.items(), ("o-", "s-", "^--")):
        axes.loglog(*series(runs, name), style, label=what)
    sizes, times = series(runs, "scaling_proportional")
    scale = times[0] / (sizes[0] * math.log(sizes[0]))
    axes.loglog(sizes, [scale * n * math.log(n) for n in sizes], "k:", label="n log n")
    axes.set(xlabel="spheres n", ylabel="processor time, ms")
    axes.grid(True, which="major", alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("json", type=pathlib.Path, nargs="+")
    runs = read(parser.parse_args().json)
    plot(runs, DOCS / "rpd_scaling.png")
    sizes, _ = series(runs, "scaling_fixed")
    lines = [BEGIN, "", "### Diagram against triangulation", "",
             *table(["model", "tets", "spheres", "pieces", "processor, 1 thread / CGAL", "wall, 2 threads / CGAL",
                     "diagram ms", "CGAL ms", "exact side tests"], against_cgal(runs)),
             "", "### Update against computing anew", "",
             *table(["model", "spheres removed and inserted again", "update / full", "update ms", "full ms"], updates(runs)),
             "", "### Growth", "", "Processor time / (n log n), relative to the smallest size.", "",
             *table(["", *(f"n = {n:.0f}" for n in sizes)], growth(runs)), "", END]
    page = DOCS / "performance.md"
    text = page.read_text()
    page.write_text(text[:text.index(BEGIN)] + "\n".join(lines) + text[text.index(END) + len(END):])


if __name__ == "__main__":
    main()
