// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Hard input for every method that makes a surface, with what is to come of it.
#pragma once

#include <functional>
#include <vector>

#include "libscan/core/point_cloud.h"

namespace scan {

enum class Answer { surface, error, either };

struct HardCase {
  const char* name;
  PointCloud cloud;
  Answer answer;
  // Distance of a place from the true surface; it is held to `tolerance_m` where data supports it.
  std::function<double(const Eigen::Vector3d&)> distance_m;
  double tolerance_m = 0;
};

std::vector<HardCase> hard_cases();

// Before each point, a tenth of the object away along the true normal: of the torus, or +-z.
std::vector<Eigen::Vector3d> scanners_of(const PointCloud& cloud);

}  // namespace scan
