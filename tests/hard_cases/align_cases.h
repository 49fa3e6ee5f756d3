// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The hard cases of aligning a pair, each with the outcomes wanted.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "libscan/align/icp.h"

namespace scan::test {

struct HardCase {
  std::string name;
  PointCloud source, target;
  Pose truth = Pose::Identity(), guess = Pose::Identity();
  std::set<Stop> wanted;
  double scale = 1;  // of the tolerance of any point of the source, where converged
  IcpOptions options = {};
};

std::vector<HardCase> input_cases();  // broken, missing or rough points and guesses
std::vector<HardCase> frame_cases();  // far places, other units, turned frames
std::vector<HardCase> scene_cases();  // shapes that leave motions open, uneven density, overlaps

}  // namespace scan::test
