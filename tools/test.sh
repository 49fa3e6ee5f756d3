#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs every test. Arguments go to ctest: test.sh -R Icp
# A warning fails it; a build that is configured by hand only shows it.
#   PRESET=asan-ubsan tools/test.sh   runs another of the presets (release is the default)
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${PRESET:-release}
more=()
[ "$preset" = asan-ubsan ] && more+=(clang libclang-rt-14-dev)
# The report's page is opened in a browser; whichever is there already will do.
command -v chromium >/dev/null || more+=(chromium)
command -v node >/dev/null || more+=(nodejs)
command -v npm >/dev/null || more+=(npm)
tools/setup.sh "${more[@]}"
cmake --preset "$preset" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON >"/tmp/libscan-configure.$$" 2>&1 || {
  cat "/tmp/libscan-configure.$$" >&2
  exit 1
}
rm -f "/tmp/libscan-configure.$$"
cmake --build --preset "$preset"
ctest --preset "$preset" --parallel "$(nproc)" "$@"
