#!/usr/bin/env bash
# From a fresh clone to a medial mesh: installs packages, builds the tool, computes a shipped model (or the one given).
set -euo pipefail
model=$(realpath "${1:-$(dirname "$0")/../data/bracket.stl}")
cd "$(dirname "$0")/.."

tools/setup.sh
cmake --preset release -DMATSTRUCT_BUILD_TESTS=OFF
cmake --build --preset release --target matstruct_tool
build/release/matstruct compute "$model" -o out/
