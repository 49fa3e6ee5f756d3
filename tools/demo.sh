#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# From a bare Debian 12 to verified surfaces: installs what is missing, builds, runs every recipe and
# two sets of real data, and says where to look. Finished parts are kept: the second run is quick.
#   tools/demo.sh [FOLDER]      results go to FOLDER (demo-output beside the sources by default)
set -euo pipefail
cd "$(dirname "$0")/.."

out=$(realpath -m "${1:-demo-output}")
scan=build/release/scan
mkdir -p "$out"

title() { printf '\n== %s\n' "$1"; }

title "Set-up and build"
tools/setup.sh
# Tests make warnings errors, and the folder remembers: here they are not.
cmake --preset release -DLIBSCAN_TESTS=OFF -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF \
  >"$out/configure.log"
cmake --build --preset release --target scan

# Fetches a Debian package without installing it, and unpacks it to $out/packages/NAME.
unpack() {
  local folder="$out/packages/$1"
  [ -e "$folder/.done" ] && return
  mkdir -p "$folder"
  (cd "$folder" && apt-get download -qq "$1" && dpkg-deb -x ./*.deb . && rm ./*.deb)
  touch "$folder/.done"
}

for recipe in datasets/recipes/*.json; do
  name=$(basename "$recipe" .json)
  title "Simulated: $name"
  # What an earlier version left there is of another recipe (3) and is replaced.
  "$scan" run "$recipe" "$out/$name" --resume ||
    { [ $? = 3 ] && "$scan" run "$recipe" "$out/$name" --force; }
done

title "Real stereo pair: Motorcycle (Middlebury 2014, from Debian's python3-skimage)"
unpack python3-skimage
images="$out/packages/python3-skimage/usr/lib/python3/dist-packages/skimage/data"
stereo="$out/motorcycle"
mkdir -p "$stereo"
cat >"$stereo/calib.txt" <<'CALIB'
cam0=[994.978 0 311.193; 0 994.978 254.877; 0 0 1]
cam1=[994.978 0 342.279; 0 994.978 254.877; 0 0 1]
doffs=31.086
baseline=193.001
width=741
height=500
ndisp=64
CALIB
"$scan" acquire stereo "$images/motorcycle_left.png" "$images/motorcycle_right.png" \
  "$stereo/points.ply" --calibration "$stereo/calib.txt" --disparity "$stereo/disparity.pfm"
"$scan" verify "$stereo/disparity.pfm" --truth "$images/motorcycle_disp.npz" --doffs 31.086 \
  --picture "$stereo/disparity-error.png"

title "Real partial scans: two sides of a hippo (from Debian's libcgal-demo)"
unpack libcgal-demo
hippo="$out/hippo"
mkdir -p "$hippo"
tar -xzf "$out/packages/libcgal-demo/usr/share/doc/libcgal-dev/data.tar.gz" -C "$hippo" \
  --strip-components=2 data/points_3/hippo1.ply data/points_3/hippo2.ply
# The two views are some 43 degrees apart, and nothing is known of their poses.
"$scan" align "$hippo/hippo1.ply" "$hippo/hippo2.ply" "$hippo/aligned" --global
"$scan" reconstruct "$hippo/aligned/aligned.ply" "$hippo/surface.ply" --method auto
"$scan" info "$hippo/surface.ply"

title "Where to look"
for report in "$out"/*/report.html; do echo "  $report"; done
echo "  $stereo/disparity-error.png   (disparity, truth and error of the real stereo pair)"
echo "  $stereo/points.ply            (its metric points)"
echo "  $hippo/surface.ply            (the hippo's surface)"
