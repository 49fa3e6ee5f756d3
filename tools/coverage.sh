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
gcovr --filter libscan/ --filter synth/ --filter tools/ \
  --csv build/coverage/coverage.csv --html-details build/coverage/coverage/index.html build/coverage

# Columns of the file: name, lines, covered lines, ...
awk -F, '
  NR > 1 && $2 > 0 {
    folder = $1; sub("/[^/]*$", "", folder)
    lines[folder] += $2; covered[folder] += $3
    lines["total"] += $2; covered["total"] += $3
  }
  END {
    for (name in lines)
      printf "%-22s %6d of %6d lines  %5.1f %%\n", name, covered[name], lines[name],
             100 * covered[name] / lines[name]
  }' build/coverage/coverage.csv | LC_ALL=C sort
