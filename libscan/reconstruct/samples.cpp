// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::size_t least_points = 16;
constexpr std::size_t area_neighbours = 10;

bool is_valid(const PointCloud& cloud, std::size_t i) {
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
    for (last = first; last < indices.size() && key(indices[last]) == key(indices[first]); ++last)
      sum += cloud.normals[indices[last]].normalized();
    const double agreement = sum.norm() / static_cast<double>(last - first);
    if (agreement < 0.1) {
      samples.invalid_points += last - first;
      continue;
    }
    samples.points.push_back(samples.box.to_unit(cloud.points[indices[first]]));
    samples.normals.push_back(sum.normalized());
  }
}

void estimate_areas(Samples& samples) {
  const KdTree tree(samples.points);
  const std::size_t count = samples.points.size();
  const std::size_t k = std::min(area_neighbours, count - 1);
  std::vector<std::uint32_t> around(count * k);
  std::vector<double> raw(count);
  parallel_chunks(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.k_nearest(samples.points[i], k + 1, found);  // the point itself is one of them
      raw[i] = std::numbers::pi * found.back().distance2_m2 / static_cast<double>(k);
      for (std::size_t n = 0; n < k; ++n) around[i * k + n] = found[n + 1].index;
    }
  });
  samples.area.resize(count);
  parallel_chunks(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<double> areas(k);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t n = 0; n < k; ++n) areas[n] = raw[around[i * k + n]];
      std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(k / 2),
                       areas.end());
      samples.area[i] = areas[k / 2];
    }
  });
}

}  // namespace

Samples prepare_samples(const PointCloud& cloud) {
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
  estimate_areas(samples);
  return samples;
}

std::vector<int> sample_depths(const Samples& samples, double samples_per_cell, int least,
                               int most) {
  std::vector<int> depths(samples.points.size());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double cell = std::sqrt(samples_per_cell * samples.area[i]);
    depths[i] =
        cell > 0
            ? static_cast<int>(std::clamp(std::floor(-std::log2(cell)), static_cast<double>(least),
                                          static_cast<double>(most)))
            : most;
  }
  return depths;
}

}  // namespace scan
