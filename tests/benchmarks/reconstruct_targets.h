// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What peers reach on the inputs of reconstruct_inputs.h, and what libscan is to reach.
#pragma once

#include <string_view>

namespace scan {

// Mean distances (surface to truth / truth to surface) in 1e-5 of the diagonal and mean angle of
// normals. `ssdrecon`: version 18.75, depth 9, defaults; `best_peer`: the best of SSDRecon,
// PoissonRecon and CGAL with settings tuned by hand; `wanted`: of libscan with `auto`.
struct ReconstructTarget {
  std::string_view input;
  std::string_view ssdrecon;
  std::string_view best_peer;
  std::string_view wanted;
};

inline constexpr ReconstructTarget reconstruct_targets[] = {
    {"sphere", "0.31 / 0.31, 0.20 deg", "the same", "0.31, 0.20 deg"},
    {"torus", "0.92 / 0.92, 0.52 deg", "0.63", "0.6, 0.4 deg"},
    {"csg", "3.3 / 4.4, 1.3 deg", "2.3 / 2.7", "2 / 2, 0.8 deg"},
    {"bunny", "3.3 / 3.3, 1.9 deg", "2.5", "2.5, 1.8 deg"},
    {"plate", "9.9 / 10.2, 0.94 deg", "1.0 / 1.5", "4, 1 component, genus 0"},
    {"torus-0.1", "28 / 28, 7.0 deg", "9.4, 0.9 deg", "9, 1 deg"},
    {"bunny-0.1", "31 / 30, 8.4 deg", "21, 4.2 deg", "19, 4 deg"},
    {"csg-0.1", "35 / 37, 8.1 deg", "30, 5.4 deg", "22, 3 deg"},
    {"plate-0.1", "50 / 45, 15 deg, 71 components", "43 / 40, 11 deg", ""},
    {"torus-0.5", "244 / 145, 46 deg, 1047 components", "35, 2.7 deg",
     "30, 2.5 deg, 1 component, genus 1"},
    {"bunny-0.5", "260 / 142, 50 deg, 1611 components", "77, 8.1 deg",
     "65, 7 deg, 1 component, genus 0"},
    {"csg-0.5", "224 / 156, 40 deg, 1195 components", "", ""},
    {"torus-1", "650 / 192, 70 deg, 2517 components", "104", "80, 1 component"},
    {"bunny-1", "675 / 190, 71 deg, 2658 components", "156", "130, 1 component"},
    {"csg-1", "582 / 227, 64 deg, 2651 components", "", ""},
    {"bunny-outliers-5", "13000 / 30, 89 deg, 201 components", "31", ""},
    {"bunny-outliers-20", "12500 / 31, 89 deg, 734 components", "31",
     "1.2 times bunny-0.1, 1 component"},
    {"bunny-flipped-10", "36 / 33, 11 deg, 131 components", "31", "1.1 times bunny-0.1"},
    {"bunny-flipped-30", "136 / 47, 42 deg, 1066 components", "31", "1.1 times bunny-0.1"},
    {"bunny-flipped-patch", "1700 / 30, 39 deg, genus 80", "31", "1.1 times bunny-0.1"},
    {"torus-density", "17 / 17, 3.5 deg", "17", ""},
    {"bunny-density", "24 / 25, 5.1 deg", "24", "20"},
    {"torus-holes", "28 / 27, 3.5 deg", "26", ""},
    {"bunny-holes", "41 / 48, 5.4 deg", "41 / 48", "35 / 42"},
    {"bunny-5000", "36 / 37, 5.1 deg", "36 / 37", "33 / 33"},
    {"sphere-cap", "1110 / 8600, 15 deg", "15 / 12700", ""},
    {"bunny-views", "46 / 45, 8.6 deg, 3 components", "42", "38 / 38"},
    {"anchor-views", "52 / 90, 6 deg, 3 components", "52 / 90", "45 / 75"},
    {"lordquas-views", "22 / 23, 5.3 deg", "22 / 23", "20 / 20"},
};

}  // namespace scan
