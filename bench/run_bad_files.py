#!/usr/bin/env python3
"""Run the tool on every broken file and check that each ends well: in a result whose guarantees hold, or in one sentence
and exit code 1, within the time limit and without leftover files.

    bench/run_bad_files.py [--tool build/release/matstruct] [--data ../shared/data/bad] [--output docs/bad_input.md]

With a tool built with sanitizers their findings count as faults, too: they are not one sentence.

The files are those of tools/make_bad_files.py and of the folders given. Writes a table; exits with 1 if a file ends in
any other way, or not as the generator's manifest expects. Python's standard library only.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIMIT_S = 120


def run_one(tool, path, entry, folder, options, limit):
    group = path.parent.name
    out = folder / "out" / group / path.name
    scratch = folder / "scratch" / group / path.name
    scratch.mkdir(parents=True)
    command = [tool, "compute", str(path), "-o", str(out), "--quiet", *options]
    start = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit, cwd=scratch,
                              env={**os.environ, "TMPDIR": str(scratch)})
        code, said = done.returncode, done.stderr.strip()
    except subprocess.TimeoutExpired:
        code, said = "over the time limit", ""
    reports = [json.loads(report.read_text()) for report in sorted(out.glob("*.report.json"))] if out.exists() else []
    faults = []
    if code == 0 and not (reports and all(report["guarantees_hold"] for report in reports)):
        faults.append("a result without guarantees")
    if code == 1 and (len(said.splitlines()) != 1 or path.name not in said):
        faults.append("not one sentence that names the file")
    if code not in (0, 1):
        faults.append(f"exit code {code}" if isinstance(code, int) else code)
    if entry and entry["expect"] not in ("either", "solid") and code != (0 if entry["expect"] == "accepted" else 1):
        faults.append("expected to be " + entry["expect"])
    if any(scratch.iterdir()) or (code == 1 and out.exists()):
        faults.append("files left over")
    return {"file": path.name, "defect": entry["defect"] if entry else "", "code": code, "said": said, "faults": faults,
            "seconds": time.monotonic() - start,
            "steps": [step for report in reports for step in report["input"]["repair"]["steps"]],
            "betti": [report["input"]["betti"] for report in reports]}


def outcome(result):
    if result["faults"]:
        return "**" + "; ".join(result["faults"]) + "**"
    if result["code"] == 1:
        return "refused: " + result["said"].split(result["file"])[-1].lstrip(":, ").replace("|", "/")[:160]
    betti = ", ".join(" ".join(map(str, b)) for b in result["betti"])
    return (("repaired: " + "; ".join(result["steps"])) if result["steps"] else "as it is") + f" (Betti {betti})"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tool", default=str(ROOT / "build/release/matstruct"))
    parser.add_argument("--data", type=pathlib.Path, nargs="*", default=[ROOT.parent / "shared/data/bad"])
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=LIMIT_S, help="seconds after which a run is killed")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "docs/bad_input.md")
    parser.add_argument("options", nargs="*", default=["--gamma", "20", "--samples", "2000"],
                        help="options for `matstruct compute`, after --")
    args = parser.parse_args()
    tool = str(pathlib.Path(args.tool).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.executable, str(ROOT / "tools/make_bad_files.py"), str(folder / "made")], check=True)
        manifest = json.loads((folder / "made/manifest.json").read_text())
        jobs = [(folder / "made" / entry["file"], entry) for entry in manifest]
        jobs += [(path, None) for data in args.data for path in sorted(data.resolve().glob("*")) if path.is_file()]
        with ThreadPoolExecutor(args.jobs) as pool:
            results = list(pool.map(lambda job: run_one(tool, *job, folder, args.options, args.limit), jobs))
    counts = [sum(r["code"] == 1 for r in results), sum(r["code"] == 0 and not r["steps"] for r in results),
              sum(r["code"] == 0 and bool(r["steps"]) for r in results), sum(bool(r["faults"]) for r in results)]
    lines = ["# Broken input", "",
             "Written by `bench/run_bad_files.py`; do not edit. "
             f"{len(results)} files: {counts[0]} refused, {counts[1]} accepted as they are, {counts[2]} repaired; "
             f"{counts[3]} ended in another way (bold). Longest {max(r['seconds'] for r in results):.0f} s.", "",
             "| file | defect | outcome |", "|---|---|---|"]
    lines += [f"| {r['file']} | {r['defect']} | {outcome(r)} |" for r in results]
    args.output.write_text("\n".join(lines) + "\n")
    for r in results:
        if r["faults"]:
            print(r["file"], r["faults"], r["said"][:300])
    print(lines[2])
    sys.exit(1 if counts[3] else 0)


if __name__ == "__main__":
    main()
