#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# Installs what libscan needs on Debian 12 and is not there yet. Quick when nothing is missing.
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache mold pkg-config
  libeigen3-dev libtbb-dev libembree-dev libflann-dev liblz4-dev libpcl-dev libopencv-dev
  libcgal-dev libceres-dev libassimp-dev libpng-dev libturbojpeg0-dev zlib1g-dev
  nlohmann-json3-dev libcli11-dev libgtest-dev libjs-three
)
# Further packages by name: setup.sh libbenchmark-dev ...
packages+=("$@")

installed() { dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null | grep -qx installed; }

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

run=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "error: missing packages (${missing[*]}) need root to install, and there is no sudo" >&2
    exit 1
  }
  run=(sudo)
fi
echo "installing: ${missing[*]}" >&2
"${run[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${run[@]}" apt-get install -y -qq --no-install-recommends \
  "${missing[@]}" >/dev/null
