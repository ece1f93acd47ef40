#!/usr/bin/env bash
# Installs the Debian packages that building, testing and checking need. Does nothing, offline and at once, when all are
# there. Runs as root or with sudo. With --ci also what only the continuous integration uses. npm is for the viewer; a
# newer one than Debian's may be there already.
set -euo pipefail

packages=(g++ cmake ninja-build python3
          libcgal-dev libeigen3-dev libgmsh-dev liblbfgs-dev libtbb-dev
          libocct-data-exchange-dev
          libcli11-dev nlohmann-json3-dev libfmt-dev libpugixml-dev zlib1g-dev libgtest-dev)
if ! command -v npm >/dev/null; then
  packages+=(nodejs npm)
fi
if [[ "${1:-}" == --ci ]]; then
  packages+=(ccache clang-format chromium python3-vtk9)
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ "$status" == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

echo "Installing: ${missing[*]}"
as_root=()
if ((EUID != 0)); then
  as_root=(sudo)
fi
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
