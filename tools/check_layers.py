#!/usr/bin/env python3
"""Checks the architecture: who includes whom, which libraries show in headers, and how long files are.

1. A file of layer L includes only from L and from the layers that CMakeLists.txt lets L use, directly or not.
2. Headers of include/ and src/ include no heavy library: those stay inside the .cpp that adapts them. Headers of
   matstruct-mesher, a program of its own that does nothing else, may.
3. No source file is longer than MAX_LINES.

Prints one line per violation and exits with 1 if there is any.
"""
import pathlib
import re
import sys

MAX_LINES = 800
HEAVY = re.compile(r'#\s*include\s*[<"](CGAL|Eigen|gmsh|lbfgs|tbb|oneapi|boost|gmp)\b')
INCLUDE = re.compile(r'^\s*#\s*include\s*"([a-z_]+)/')
SOURCES = {".cpp", ".h", ".py", ".sh"}
FOLDERS = ("include", "src", "apps", "tests", "bench", "tools")


def allowed_layers(cmake):
    """For each layer the set of layers it may include, itself included, from the matstruct_layer() calls."""
    allowed = {}
    for name, arguments in re.findall(r"matstruct_layer\((\w+)([^)]*)\)", cmake):
        uses = re.search(r"USES((?:\s+[a-z_]+)+)", arguments)
        allowed[name] = {name}.union(*(allowed[used] for used in (uses.group(1).split() if uses else [])))
    return allowed


def violations(root):
    allowed = allowed_layers((root / "CMakeLists.txt").read_text())
    for folder in sorted((root / "src").iterdir()):
        if folder.is_dir() and folder.name not in allowed:
            yield f"{folder.relative_to(root)}: not a layer of CMakeLists.txt"
    for path in sorted(p for folder in FOLDERS for p in (root / folder).rglob("*") if p.suffix in SOURCES):
        name = path.relative_to(root)
        lines = path.read_text().splitlines()
        if len(lines) > MAX_LINES:
            yield f"{name}: {len(lines)} lines, more than {MAX_LINES}"
        layer = name.parts[1] if name.parts[0] == "src" else None
        public = name.parts[0] == "include"
        of_mesher = name.parts[:3] == ("src", "prepare", "mesher")
        for number, line in enumerate(lines, 1):
            if path.suffix == ".h" and (layer or public) and not of_mesher and HEAVY.search(line):
                yield f"{name}:{number}: heavy library in a header: {line.strip()}"
            included = INCLUDE.match(line)
            if not included or included.group(1) not in allowed:
                continue
            if public:
                yield f"{name}:{number}: a public header includes src/{included.group(1)}"
            elif layer and included.group(1) not in allowed.get(layer, set()):
                yield f"{name}:{number}: layer {layer} may not include {included.group(1)}"


def main():
    found = list(violations(pathlib.Path(__file__).resolve().parent.parent))
    for line in found:
        print(line)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
