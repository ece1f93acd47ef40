#!/usr/bin/env bash
# From a fresh clone to tested: installs packages, builds everything, runs all tests. Arguments go to the configuration,
# for example -DMATSTRUCT_WERROR=ON.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh
cmake --preset release -DMATSTRUCT_BUILD_TESTS=ON "$@"
cmake --build --preset release
ctest --preset release --parallel "$(nproc)"
