#!/usr/bin/env python3
"""Run the tool on random CAD parts and compare the topology with what the parts' boundary representations say.

    bench/soak.py [--number 300] [--seed 1] [--tool build/release/matstruct] [--parts build/bench/bench/cad_parts]

Writes docs/soak.md: figures, and a row for each part that is slow or fails. Exits with 1 if one fails: no result, another
topology, or a guarantee that does not hold. Python's standard library only.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run_one(tool, folder, part, limit, options):
    out = folder / "out" / part["file"]
    command = [tool, "compute", str(folder / part["file"]), "-o", str(out), "--quiet", "--threads", "1", *options]
    start = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
        code, said = done.returncode, done.stderr.strip().replace(f"{out}/", "")
    except subprocess.TimeoutExpired:
        code, said = None, "over the time limit"
    seconds = time.monotonic() - start
    reports = [json.loads(path.read_text()) for path in out.glob("*.report.json")] if out.exists() else []
    report = reports[0] if len(reports) == 1 else None
    if report is None:
        fault = f"no result: {said}" if code is not None else said
    elif report["topology"]["betti"] != part["betti"]:
        fault = f"Betti numbers {report['topology']['betti']} instead of {part['betti']}"
    else:
        fault = "" if report["guarantees_hold"] else said
    return {**part, "seconds": seconds, "code": code, "fault": fault, "report": report}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tool", default=str(ROOT / "build/release/matstruct"))
    parser.add_argument("--parts", default=str(ROOT / "build/bench/bench/cad_parts"))
    parser.add_argument("--number", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=120, help="seconds after which a run is killed")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs/soak.md")
    parser.add_argument("options", nargs="*", default=["--samples", "5000"], help="for `matstruct compute`, after --")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([args.parts, name, str(args.number), str(args.seed)], check=True, stdout=subprocess.DEVNULL)
        parts = json.loads((folder / "parts.json").read_text())
        results = []
        with ThreadPoolExecutor(args.jobs) as pool:
            for result in pool.map(lambda part: run_one(args.tool, folder, part, args.limit, args.options), parts):
                results.append(result)
                print(f"{result['file']} {result['seconds']:.1f} s {result['fault'] or 'good'}", flush=True)
    done = [r for r in results if r["report"]]
    failed = [r for r in results if r["fault"]]
    right = sum(r["report"]["topology"]["betti"] == r["betti"] for r in done)
    solid = sum(r["report"]["input"]["betti"] == r["betti"] for r in done)
    lines = [sum(r["report"]["features"][key] for r in done) for key in ("lines_preserved", "lines")]
    share = sum(r["report"]["input"]["seconds"] for r in done) / max(sum(r["seconds"] for r in done), 1e-9)
    seconds = [r["seconds"] for r in results]
    tets = [r["report"]["input"]["tets"] for r in done]
    text = ["# Soak of random CAD parts", "",
            f"Written by `bench/soak.py --number {args.number} --seed {args.seed}`; do not edit. The parts come from "
            "`bench/cad_parts.cpp`; their Betti numbers from their vertices, edges, faces and shells, without a mesh.", "",
            "| figure | measured |", "|---|---|",
            f"| parts | {len(results)} |", f"| with a result | {len(done)} |", f"| topology of the solid right | {solid} |",
            f"| topology of the medial mesh right | {right} |",
            f"| all guarantees hold | {sum(r['report']['guarantees_hold'] for r in done)} |",
            f"| repaired | {sum(bool(r['report']['input']['repair']['steps']) for r in done)} |",
            f"| convex sharp lines kept | {lines[0]} of {lines[1]} |",
            f"| faces of a part, median and greatest | {statistics.median(r['faces'] for r in results):.0f}, "
            f"{max(r['faces'] for r in results)} |",
            f"| tets, median and greatest | {statistics.median(tets):.0f}, {max(tets)} |",
            f"| time of the command, median and greatest, s | {statistics.median(seconds):.1f}, {max(seconds):.1f} |",
            f"| share of it for reading and tetrahedralising | {100 * share:.0f} % |", "",
            "## Failures", ""]
    text += ["| part | faces | time s | what |", "|---|---|---|---|"] if failed else ["None."]
    text += [f"| {r['file']} | {r['faces']} | {r['seconds']:.1f} | {r['fault'].replace('|', '/')[-300:]} |" for r in failed]
    text += ["", "## Slowest", "", "| part | faces | tets | spheres | time s |", "|---|---|---|---|---|"]
    text += [f"| {r['file']} | {r['faces']} | {r['report']['input']['tets']} | {r['report']['mesh']['spheres']} | "
             f"{r['seconds']:.1f} |" for r in sorted(done, key=lambda r: -r["seconds"])[:10]]
    args.output.write_text("\n".join(text) + "\n")
    print("\n".join(text))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
