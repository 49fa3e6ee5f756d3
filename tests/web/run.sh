#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# Opens a small run's report in Chromium: run.sh SCAN FOLDER. Exit code 77, with the reason on a line
# that begins with "skipped:", where browser, Node or its one package cannot be had.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
scan=$1 folder=$2

skip() {
  echo "skipped: $1"
  exit 77
}

CHROMIUM=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  skip "no chromium (apt-get install chromium)"
command -v node >/dev/null || skip "no node (apt-get install nodejs)"
command -v npm >/dev/null || skip "no npm (apt-get install npm)"
[ "$(node -p 'parseInt(process.versions.node)')" -ge 18 ] || skip "node is older than 18"

mkdir -p "$folder"
if ! cmp -s "$here/package-lock.json" "$folder/installed-lock.json"; then
  cp "$here/package.json" "$here/package-lock.json" "$folder/"
  (cd "$folder" && timeout 40 npm ci --no-audit --no-fund >npm.log 2>&1) ||
    skip "npm ci cannot fetch playwright-core (see $folder/npm.log)"
  cp "$here/package-lock.json" "$folder/installed-lock.json"
fi

status=0
"$scan" run "$here/../tools/small_run.json" "$folder/run" --force >/dev/null || status=$?
[ "$status" -le 1 ] || exit "$status"
export CHROMIUM LIBSCAN_REPORT="$folder/run/report.html"
export PLAYWRIGHT="$folder/node_modules/playwright-core"
exec node --test "$here/report.test.js"
