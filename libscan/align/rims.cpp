// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/rims.h"

#include <algorithm>

namespace scan {
namespace {

constexpr std::size_t neighbours = 16;
// How far off the point their mean lies, in units of the farthest: of half a disc by 4 / (3 pi) =
// 0.42, of a whole one by chance by sqrt(1 / (2 * 15)) = 0.18 (root mean square): half way between.
constexpr double rim_share = 0.3;

}  // namespace

std::vector<bool> rim_points(const PreparedCloud& cloud) {
  std::vector<bool> rim(cloud.size(), false);
  std::vector<Neighbour> found;
  const auto find_all = [&](const auto& search) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      search.k_nearest(cloud.points[i], neighbours, found);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double reach_m = 0;
      for (const Neighbour& one : found) {  // itself is one of them
        const Eigen::Vector3d apart = cloud.points[one.index] - cloud.points[i];
        sum += apart;
        reach_m = std::max(reach_m, apart.norm());
      }
      rim[i] = sum.norm() > rim_share * reach_m * (static_cast<double>(found.size()) - 1);
    }
  };
  std::visit(find_all, cloud.search);
  return rim;
}

}  // namespace scan
