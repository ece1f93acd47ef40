#!/usr/bin/env bash
# One picture of all models of a folder: computes each file of its subfolders tet, surface and cad that can be computed,
# and draws them.
#
#     tools/gallery.sh ../shared/data gallery.png [results]
#
# Results are kept if a folder for them is given. MATSTRUCT_TOOL names the program, else that of the release build.
set -euo pipefail
if (($# < 2)); then
  sed -n '2,7s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
tool=${MATSTRUCT_TOOL:-$(dirname "$0")/../build/release/matstruct}
results=${3:-$(mktemp -d)}
[[ -n "${3:-}" ]] || trap 'rm -rf "$results"' EXIT

folders=()
for kind in tet surface cad; do
  for model in "$1/$kind"/*; do
    [[ -f "$model" ]] || continue
    # 3: a guarantee failed; there is something to see all the same. What is refused has said why.
    "$tool" compute "$model" -o "$results/$kind" --quiet || (($? == 3 || $? == 1)) || exit 1
  done
  if compgen -G "$results/$kind/*.ma" >/dev/null; then folders+=("$results/$kind"); fi
done
"$tool" render "${folders[@]}" -o "$2" --gallery
