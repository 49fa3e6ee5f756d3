#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# Installs a build, builds the project beside this file against the installation and runs it.
#   serve.sh BUILD
set -euo pipefail
build=$1
source=$(cd "$(dirname "$0")" && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$build" --prefix "$place/prefix" >/dev/null
cmake -S "$source" -B "$place/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$place/prefix" -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" >/dev/null
cmake --build "$place/build" >"$place/log" || { cat "$place/log" >&2; exit 1; }
"$place/build/how_accurate" | tee "$place/said"
"$place/prefix/bin/scan" version >/dev/null
# The surface is made of some ten points at each place: better than one of them, though not perfect.
awk '$1 == "sigma_of_a_point" { sigma = $2 }
     $1 == "accuracy_rms" { good = $2 > 0 && $2 < sigma }
     END { exit !good }' "$place/said"
