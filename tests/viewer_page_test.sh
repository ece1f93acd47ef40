#!/usr/bin/env bash
# Runs the browser tests of the page in the folder that has the viewer's packages; 77 where there is no browser.
set -euo pipefail
if [[ -z "${MATSTRUCT_BROWSER:-}" ]] && ! command -v chromium google-chrome >/dev/null; then
  echo "no browser is here: skipped"
  exit 77
fi
exec node --test "$(dirname "$0")/../viewer/test/page.test.mjs"
