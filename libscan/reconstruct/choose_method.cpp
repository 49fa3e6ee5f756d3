// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/choose_method.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/local_planes.h"

namespace scan {
namespace {

constexpr std::size_t neighbours = 24;
constexpr double open_share = 0.02;
constexpr double flat = 0.1;
// A point is on a rim if its neighbours' mean lies off by more than this share of their reach: for
// a full disc it is 0, with a deviation of 0.5 / sqrt(24) = 0.1 per axis; for half a disc
// 4 / (3 pi) = 0.42.
constexpr double rim_offset = 0.36;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * share);
  return text;
}

double rim_share(const PointCloud& cloud, const LocalPlanes& all) {
  const std::size_t count = cloud.size();
  if (all.neighbours == 0) return 0;
  const auto rims =
      ordered_sum(count, 1024, std::size_t{0}, [&](std::size_t begin, std::size_t end) {
        std::size_t found = 0;
        for (std::size_t i = begin; i < end; ++i) {
          Eigen::Vector3d mean = Eigen::Vector3d::Zero();
          for (std::size_t n = 0; n < all.neighbours; ++n)
            mean += cloud.points[all.around[i * all.neighbours + n]] - cloud.points[i];
          mean /= static_cast<double>(all.neighbours);
          mean -= mean.dot(all.planes[i].normal) * all.planes[i].normal;
          found += mean.norm() > rim_offset * all.planes[i].reach_m;
        }
        return found;
      });
  return static_cast<double>(rims) / static_cast<double>(count);
}

double median_unflatness(const LocalPlanes& all) {
  std::vector<double> ratios;
  for (const LocalPlane& plane : all.planes)
    ratios.push_back(plane.width_m > 0 ? plane.thickness_m / plane.width_m : 1);
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

}  // namespace

MethodChoice choose_method(const PreparedPoints& points) {
  const LocalPlanes planes = local_planes(points.cloud.points, neighbours);
  MethodChoice choice;
  choice.rim_share = rim_share(points.cloud, planes);
  choice.unflatness = median_unflatness(planes);
  const std::string rims = percent(choice.rim_share) + " of the points lie on rims";
  if (choice.rim_share <= open_share) {
    choice.reason = "the surface is closed (" + rims + "), which SSD makes most accurately";
  } else if (!points.viewpoints.empty()) {
    choice.method = ReconstructMethod::range_fusion;
    choice.reason = "the surface is open (" + rims +
                    ") and the scanners' places are known, so rays tell what is free";
  } else if (choice.unflatness < flat) {
    choice.method = ReconstructMethod::mls;
    choice.reason =
        "the surface is open (" + rims + ") and smooth, and local fits end where the samples end";
  } else {
    choice.reason = "the surface is open (" + rims + ") but too noisy for local fits";
  }
  return choice;
}

}  // namespace scan
