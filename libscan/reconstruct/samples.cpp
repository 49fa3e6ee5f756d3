// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/noise.h"
#include "libscan/search/batch.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::size_t least_points = 16;
constexpr std::size_t area_neighbours = 10;
constexpr double cells_per_spacing = 1, cells_per_sigma = 1.5;

bool is_valid(const PointCloud& cloud, std::size_t i) {
  if (!cloud.sigma_m.empty() && !(cloud.sigma_m[i] >= 0 && std::isfinite(cloud.sigma_m[i])))
    return false;
  return cloud.points[i].allFinite() && cloud.normals[i].allFinite() &&
         cloud.normals[i].norm() > 1e-6;
}

void require_enough(std::size_t count, const char* what) {
  if (count < least_points)
    throw Error(Trouble::input,
                "cloud: " + std::to_string(count) + " " + what + ", at least " +
                    std::to_string(least_points) + " needed",
                "a surface needs oriented points: estimate and orient normals first");
}

// Sorts and merges the points of the indices and moves them to the unit cube.
void merge_equal_points(const PointCloud& cloud, std::vector<std::size_t>& indices,
                        Samples& samples) {
  const auto key = [&](std::size_t i) {
    const Eigen::Vector3d& x = cloud.points[i];
    return std::array{x[2], x[1], x[0]};
  };
  const auto normal_key = [&](std::size_t i) {
    const Eigen::Vector3d& n = cloud.normals[i];
    return std::array{n[2], n[1], n[0]};
  };
  std::sort(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(key(a), normal_key(a)) < std::pair(key(b), normal_key(b));
  });
  for (std::size_t first = 0, last; first < indices.size(); first = last) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double sigma_m = 0;
    for (last = first; last < indices.size() && key(indices[last]) == key(indices[first]); ++last) {
      sum += cloud.normals[indices[last]].normalized();
      if (!cloud.sigma_m.empty()) sigma_m += cloud.sigma_m[indices[last]];
    }
    const double agreement = sum.norm() / static_cast<double>(last - first);
    if (agreement < 0.1) {
      samples.invalid_points += last - first;
      continue;
    }
    samples.points.push_back(samples.box.to_unit(cloud.points[indices[first]]));
    samples.normals.push_back(sum.normalized());
    if (!cloud.sigma_m.empty())
      samples.sigma.push_back(sigma_m / static_cast<double>(last - first) / samples.box.side_m);
  }
}

// pi r^2 / k to the k-th of every `step`-th point, for all points, then the median around.
void estimate_areas(Samples& samples, std::size_t step) {
  std::vector<Eigen::Vector3d> thinned;
  for (std::size_t i = 0; i < samples.points.size(); i += step)
    thinned.push_back(samples.points[i]);
  const KdTree tree(thinned);
  const std::size_t count = samples.points.size();
  const std::size_t k = std::min(area_neighbours, thinned.size() - 1);
  const std::vector<std::uint32_t> order = curve_order(samples.points);
  std::vector<Neighbour> found;
  k_nearest_of_each(tree, samples.points, k + 1, order, found);
  std::vector<double> raw(count);
  for (std::size_t i = 0; i < count; ++i)
    raw[i] = std::numbers::pi * found[i * (k + 1) + k].distance2_m2 / static_cast<double>(k * step);
  samples.area.resize(count);
  parallel_chunks(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<double> areas(k + 1);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t n = 0; n <= k; ++n) areas[n] = raw[found[i * (k + 1) + n].index * step];
      std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(k / 2),
                       areas.end());
      samples.area[i] = areas[k / 2];
    }
  });
}

void measure_areas(Samples& samples) {
  estimate_areas(samples, 1);
  // k neighbours of a surface lie within sqrt(k m / pi) spacings; let that be three sigma.
  const double spacings = 3 * median(samples.sigma) / std::sqrt(median(samples.area));
  const double step = std::ceil(std::numbers::pi * spacings * spacings / area_neighbours);
  const double most = static_cast<double>(samples.points.size()) / (4.0 * area_neighbours);
  if (step > 1 && most >= 1)
    estimate_areas(samples, static_cast<std::size_t>(std::min(step, most)));
}

}  // namespace

Samples prepare_samples(const PointCloud& cloud, double sigma_m) {
  check(cloud);
  Samples samples;
  std::vector<std::size_t> valid;
  std::vector<Eigen::Vector3d> points;
  if (!cloud.normals.empty())
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (is_valid(cloud, i)) {
        valid.push_back(i);
        points.push_back(cloud.points[i]);
      }
  samples.invalid_points = cloud.size() - valid.size();
  require_enough(valid.size(), "valid points with a normal");
  samples.box = robust_box(points);
  if (!(samples.box.side_m > 0))
    throw Error(Trouble::input, "cloud: its points lie at one place, a surface needs an extent");
  std::erase_if(valid, [&](std::size_t i) {
    const Eigen::Vector3d u = samples.box.to_unit(cloud.points[i]);
    return u.minCoeff() < 0 || u.maxCoeff() > 1;
  });
  samples.outlying_points = points.size() - valid.size();
  merge_equal_points(cloud, valid, samples);
  require_enough(samples.points.size(), "valid points at different places");
  samples.scattered_all_around = samples.sigma.empty();
  if (samples.sigma.empty())
    samples.sigma.assign(samples.points.size(), sigma_m > 0 ? sigma_m / samples.box.side_m
                                                            : estimate_sigma(samples.points));
  measure_areas(samples);
  return samples;
}

std::vector<int> sample_depths(const Samples& samples, int least, int most) {
  std::vector<int> depths(samples.points.size());
  // Chance makes some areas small: the finest level is one that a twentieth of the samples want.
  std::vector<double> areas = samples.area;
  const auto small = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 20);
  std::nth_element(areas.begin(), small, areas.end());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double cell = cells_per_spacing * std::sqrt(std::max(samples.area[i], *small)) +
                        cells_per_sigma * samples.sigma[i];
    depths[i] =
        cell > 0
            ? static_cast<int>(std::clamp(std::floor(-std::log2(cell)), static_cast<double>(least),
                                          static_cast<double>(most)))
            : most;
  }
  return depths;
}

}  // namespace scan
