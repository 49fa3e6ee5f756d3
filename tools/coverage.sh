#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# Line coverage by the tests, per folder. Builds the coverage preset and runs every test first;
# arguments go to ctest: coverage.sh -R Icp
#   build/coverage/coverage.csv        per file
#   build/coverage/coverage/index.html line by line
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh gcovr
find build/coverage -name '*.gcda' -delete 2>/dev/null || true  # counts add up over runs
PRESET=coverage tools/test.sh "$@"

mkdir -p build/coverage/coverage
gcovr -j "$(nproc)" --filter libscan/ --filter synth/ --filter tools/ \
  --csv build/coverage/coverage.csv --html-details build/coverage/coverage/index.html build/coverage

# Columns of the file: name, lines, covered lines, ...
awk -F, '
  function row(name, lines, covered) {
    printf "%-22s %6d of %6d lines  %5.1f %%\n", name, covered, lines, 100 * covered / lines
  }
  NR > 1 && $2 > 0 {
    folder = $1; sub("/[^/]*$", "", folder)
    lines[folder] += $2; covered[folder] += $3; all += $2; all_covered += $3
  }
  END {
    for (folder in lines) row(folder, lines[folder], covered[folder]) | "sort"
    close("sort")
    row("all", all, all_covered)
  }' build/coverage/coverage.csv
