#!/usr/bin/env python3
"""Do the contacts of spheres agree with the paper's way to find them: sample every cell, project every sample?

    bench/run_agreement.py --program build/bench/bench/agreement [--data ../shared/data] [--only part-1]

Three comparisons for every solid of DATA/tet and, if it is not there, DATA/surface: of the volume samples on the first
spheres, with many and with 200 samples in a cell, and of the exact contacts on the spheres of the finished mesh. Models
that agree on fewer than 99 % of the first spheres are looked at closer, with four times the samples. With --resume
only what the .json of the output does not have is measured. Writes docs/agreement.md and .json. Python's standard
library only; the program comes with the preset bench.
"""
import argparse
import datetime
import json
import pathlib
import subprocess

import run_models

WANTED_PERCENT = 99
CLOSER = 4


def percent(part, whole):
    return 100 * part / whole if whole else 100.0


def measured(args, path, per_cell):
    """What the program says, and its last line of errors."""
    command = [args.program, str(path), f"{args.gamma:g}", str(args.most), str(per_cell)]
    done = subprocess.run(command, capture_output=True, text=True)
    return (json.loads(done.stdout) if done.returncode == 0 else None,
            (done.stderr.strip().splitlines() or [""])[-1])


def wants_closer(result):
    return result["agreement"] and FIGURES["agreement"](result["agreement"]["samples"]) < WANTED_PERCENT


def completed(args, kind, path, known):
    """`known`: the result so far, or None."""
    result = known or {"model": f"{kind}/{path.stem}", "cad": path.stem not in run_models.ORGANIC}
    if known is None:
        result["agreement"], result["said"] = measured(args, path, args.per_cell)
    if wants_closer(result) and "closer" not in result:
        result["closer"] = (measured(args, path, CLOSER * args.per_cell)[0] or {}).get("samples")
    return result


# ---------------------------------------------------------------- the tables

FIGURES = {
    "agreement": lambda a: percent(a["equal"], a["compared"]),
    "two references": lambda a: percent(a["references_equal"], a["compared"]),
    "where sure": lambda a: percent(a["equal_where_sure"], a["references_equal"]),
    "upheld": lambda a: percent(a["equal"] + a["ours_right"], a["compared"])}
COLUMNS = ["model", "spheres", *(f"{name} %" for name in FIGURES), "disputed", "ours right", "reference right"]


def row(result, name):
    if result["agreement"] is None:
        return [result["model"], f"**{result['said']}**"]
    return row_of(result, result["agreement"][name])


def row_of(result, a):
    return [result["model"], a["compared"], *(f"{figure(a):.1f}" for figure in FIGURES.values()), a["disputed"],
            a["ours_right"], a["reference_right"]]


def summary(results, name):
    for kind, cad in (("CAD", True), ("organic", False)):
        found = [r["agreement"][name] for r in results if r["agreement"] and r["cad"] == cad]
        if not found:
            continue
        total = {key: sum(a[key] for a in found) for key in found[0]}
        for label, figure in FIGURES.items():
            values = [figure(a) for a in found]
            good = sum(v >= WANTED_PERCENT for v in values)
            yield [f"{kind}: {label} %", f"{figure(total):.2f}", f"{min(values):.1f}", f"{good} of {len(values)}"]
        yield [f"{kind}: disputes, ours right : reference right",
               f"{total['ours_right']} : {total['reference_right']} of {total['disputed']}"]


def seconds(results, name):
    found = [r["agreement"][name] for r in results if r["agreement"]]
    ours, reference = (sum(a[f"{who}_seconds"] for a in found) for who in ("our", "reference"))
    return f"ours {ours:.0f} s, a reference {reference:.0f} s"


def markdown(results, facts, args):
    yield "# Contacts beside the paper's way"
    yield ""
    yield "Written by `bench/run_agreement.py`; do not edit. " + facts
    yield ""
    yield ("The reference: samples of every power cell, projected and clustered; the number of clusters is the contact "
           "order. Agreement: share of the spheres for which ours is the same. Two references: the same for a reference "
           "with other random numbers, which is what can be asked for. Where sure: agreement where both references have "
           "the same. Where ours and the first reference differ, a judge decides; upheld: agreement and what was "
           "decided for ours. Judges may find a third number.")
    for title, name, text in (
            ("Volume samples", "samples",
             f"The fixed samples of `docs/design/samples.md` on sheet spheres of the first set, evenly chosen, after their "
             f"cells are completed to {args.per_cell} samples by hit-and-run; a reference has {args.per_cell} too, and the "
             f"judge ten times as many. This is for the comparison only: compute() never completes cells, and goes by "
             f"exact contacts, see below. Time to complete and cluster, and to sample and cluster once for a reference, "
             f"all models: {seconds(results, 'samples')}."),
            ("Volume samples, 200 in a cell", "few_samples",
             "The same with 200, where chance decides about clusters near the limit of 2 % of the cell; the judge has "
             f"2000. Time: {seconds(results, 'few_samples')}."),
            ("Contacts of the result", "contacts",
             "The exact contacts of the spheres of the finished mesh that are not on sharp lines, or of some evenly chosen "
             "ones; 200 samples in a cell of the reference. A cell may reach past a seam beside its sphere, so the judge "
             "is 200 samples around the centre, within 2 % of the spacing: the sub-volumes that meet in the sphere. Smooth "
             "shapes are not classified by contacts (`docs/design/structure.md`); their facets give many.")):
        yield ""
        yield f"## {title}"
        yield ""
        yield text
        yield ""
        yield from run_models.table(["figure", "all spheres", "least of a model", f"models >= {WANTED_PERCENT} %"],
                                    summary(results, name))
        yield ""
        yield from run_models.table(COLUMNS, (row(r, name) for r in results))
        if name == "samples":
            yield ""
            yield (f"The models below {WANTED_PERCENT} % with {CLOSER * args.per_cell} samples in a cell: what is left of "
                   f"their disputes is not chance.")
            yield ""
            yield from run_models.table(COLUMNS, (row_of(r, r["closer"]) for r in results if r.get("closer")))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(run_models.ROOT / "build/bench/bench/agreement"))
    parser.add_argument("--data", type=pathlib.Path, default=run_models.ROOT.parent / "shared/data")
    parser.add_argument("--only", nargs="*", help="models whose name contains one of these")
    parser.add_argument("--gamma", type=float, default=40)
    parser.add_argument("--most", type=int, default=250, help="spheres of a model that are compared")
    parser.add_argument("--per-cell", type=int, default=10000, help="samples in a cell, ours and the reference's")
    parser.add_argument("--output", type=pathlib.Path, default=run_models.ROOT / "docs/agreement.md")
    parser.add_argument("--resume", action="store_true", help="measure only what the output's .json does not have")
    args = parser.parse_args()
    chosen = run_models.models(args.data, args.only)
    tets = {path.stem for kind, path in chosen if kind == "tet"}
    chosen = [(kind, path) for kind, path in chosen if kind == "tet" or path.stem not in tets]
    if not chosen:
        parser.error(f"{args.data}: no models in tet/ or surface/")
    stored = args.output.with_suffix(".json")
    known = {r["model"]: r for r in json.loads(stored.read_text())["results"]} if args.resume else {}
    results = []
    for kind, path in chosen:
        results.append(completed(args, kind, path, known.get(f"{kind}/{path.stem}")))
        print(*(" | ".join(map(str, row(results[-1], name))) for name in ("samples", "few_samples", "contacts")), sep="\n", flush=True)
    facts = (f"{datetime.date.today()}, {run_models.machine()}; gamma {args.gamma:g}, at most "
             f"{args.most} spheres of a model.")
    run_models.write(args.output, markdown(results, facts, args), {"facts": facts, "results": results})


if __name__ == "__main__":
    main()
