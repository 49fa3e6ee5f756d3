// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/rbf.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/algebraic_sphere.h"
#include "libscan/reconstruct/followed_surface.h"
#include "libscan/reconstruct/rbf_level.h"
#include "libscan/reconstruct/winding_number.h"
#include "libscan/reconstruct/world_surface.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr double first_radius = 1.5;        // reaches through the unit cube
constexpr double spacings_in_radius = 3;    // some 28 nodes of a surface within it
constexpr double finest = 0.7;              // node spacing over the samples': all of them count
constexpr double relative_residual = 1e-3;  // what is left, the next level takes up
constexpr double least_share = 0.02;        // of the samples, for a further level
constexpr double cell_sigmas = 1.5;         // smaller facets would show the noise alone
constexpr double most_sigmas = 3;           // that scatter moves a sample
constexpr double least_far_radius = 0.3;    // finer levels add less than what is known there
constexpr double nearest_far = 0.5;         // of a level's node spacing, off the samples
constexpr double far_spacings = 3;          // and of the samples'
constexpr double far_slack = 0.25;          // of it: how far distances are off between nodes
constexpr double clearly = 0.25;            // winding number off that of the surface
constexpr double least_gradient = 1e-3;     // of the first sphere, at full agreement 1
constexpr int max_iterations = 100;         // of a level

// The radius that a sample's levels halve down to.
double last_radius(double spacing) {
  return spacings_in_radius * finest * spacing;
}

class RbfField {
 public:
  explicit RbfField(const Samples& samples)
      : samples_(samples),
        tree_(samples.points),
        winding_(samples),
        fitted_(samples.points.size()),
        silent_(samples.points.size(), 0) {
    SphereSums sums;
    for (std::size_t i = 0; i < samples.points.size(); ++i)
      sums.add(samples.area[i], samples.points[i] - centre_, samples.normals[i]);
    // Sheets whose normals oppose one another tell of no sphere: then one about the cube.
    if (const auto sphere = sums.fit(); sphere && sphere->gradient_on_sphere() > least_gradient)
      base_ = *sphere;
    parallel_for(fitted_.size(), [&](std::size_t i) {
      const Eigen::Vector3d x = samples.points[i] - centre_;
      fitted_[i] = {base_.distance(x), base_.gradient(x).normalized()};
    });
  }

  // Returns the share of the samples that it still has something to say of.
  double add_level(double radius) {
    radius_ = radius;
    std::vector<std::uint32_t> group_of;
    std::vector<RbfNode> all = nodes(radius, group_of);
    if (radius >= least_far_radius) add_far_nodes(radius, all);
    RbfLevel level(radius, std::move(all));
    const RbfSolve solved =
        level.solve(radius / spacings_in_radius, relative_residual, max_iterations);
    iterations_ += solved.iterations;
    relative_residual_ = solved.relative_residual;
    unknowns_ += 4 * level.nodes().size();
    std::vector<char> silent(level.nodes().size());
    for (std::size_t n = 0; n < silent.size(); ++n)
      silent[level.nodes()[n].group] = level.is_silent(n);
    parallel_for(fitted_.size(),
                 [&](std::size_t i) { fitted_[i] += level.at(samples_.points[i]); });
    std::size_t heard = 0;
    for (std::size_t i = 0; i < silent_.size(); ++i) {
      if (is_left_out(i)) continue;
      silent_[i] = silent[group_of[i]] ? static_cast<char>(silent_[i] + 1) : 0;
      heard += !is_left_out(i);
    }
    levels_.push_back(std::move(level));
    return static_cast<double>(heard) / static_cast<double>(silent_.size());
  }

  double value(const Eigen::Vector3d& x) const {
    double sum = base_.distance(x - centre_);
    for (const RbfLevel& level : levels_) sum += level.value(x);
    return sum;
  }

  int iterations() const { return iterations_; }
  double last_residual() const { return relative_residual_; }
  std::size_t unknowns() const { return unknowns_; }

 private:
  // Detail fades towards finer levels: where two in a row found noise alone, there is no more. Nor
  // is there where samples lie too far apart for a level: each would be a bump of its own.
  bool is_left_out(std::size_t i) const {
    return silent_[i] >= 2 || radius_ <= last_radius(spacing(i)) / 2;
  }

  double spacing(std::size_t i) const { return std::sqrt(samples_.area[i]); }

  // A sample moved onto the surface so far, as far as scatter may have moved it off: cubes that cut
  // through the scatter would collect its tails.
  Eigen::Vector3d without_scatter(std::size_t i) const {
    const double most = most_sigmas * samples_.sigma[i];
    const Jet& f = fitted_[i];
    const double length = f.gradient.norm();
    if (!(length > 0)) return samples_.points[i];
    return samples_.points[i] - std::clamp(f.value / length, -most, most) / length * f.gradient;
  }

  // What is missing, in the mean of each cube's samples, weighted by area.
  std::vector<RbfNode> nodes(double radius, std::vector<std::uint32_t>& group_of) const {
    const double width = radius / spacings_in_radius;
    std::vector<std::uint64_t> keys;
    for (std::size_t i = 0; i < samples_.points.size(); ++i) {
      const Eigen::Vector3d x = without_scatter(i);
      std::uint64_t key = 0;
      for (int a = 0; a < 3; ++a)
        key = key << 21 | static_cast<std::uint64_t>(std::max(0.0, std::floor(x[a] / width)));
      keys.push_back(key);
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < keys.size(); ++i)
      if (!is_left_out(i)) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    std::vector<RbfNode> all;
    group_of.resize(keys.size());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      while (end < order.size() && keys[order[end]] == keys[order[begin]]) ++end;
      for (std::size_t n = begin; n < end; ++n)
        group_of[order[n]] = static_cast<std::uint32_t>(all.size());
      all.push_back(node({order.data() + begin, end - begin}, radius));
      all.back().group = group_of[order[begin]];
    }
    return all;
  }

  // Places on a lattice away from the samples, where it is clear which side they are on: the
  // distance from the samples. Without them a sum of functions that only know the surface may
  // vanish anywhere else too.
  void add_far_nodes(double radius, std::vector<RbfNode>& all) const {
    const double width = radius / spacings_in_radius;
    const auto count = static_cast<int>(std::ceil(1 / width));
    for (int i = 0; i < count * count * count; ++i) {
      const Eigen::Vector3d x = width * Eigen::Vector3d(i % count + 0.5, i / count % count + 0.5,
                                                        i / (count * count) + 0.5);
      const std::size_t nearest = tree_.nearest(x, unlimited_m)->index;
      const Eigen::Vector3d away = x - samples_.points[nearest];
      const double least = std::max(nearest_far * width, far_spacings * spacing(nearest));
      const double inside = winding_.at(x) - winding_.on_surface();
      if (away.norm() < least || std::abs(inside) < clearly) continue;
      const double side = inside > 0 ? -1 : 1;
      const Jet now = at(x);
      const Jet wanted{side * away.norm() - now.value,
                       radius * (side * away.normalized() - now.gradient)};
      all.push_back({.place = x,
                     .wanted = wanted,
                     .slack = std::pow(far_slack * width, 2),
                     .group = static_cast<std::uint32_t>(all.size())});
    }
  }

  Jet at(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d d = x - centre_;
    Jet sum{base_.distance(d), base_.gradient(d).normalized()};
    for (const RbfLevel& level : levels_) sum += level.at(x);
    return sum;
  }

  RbfNode node(std::span<const std::uint32_t> members, double radius) const {
    RbfNode node{Eigen::Vector3d::Zero(), {}, 0};
    double total = 0;
    for (const std::uint32_t i : members) {
      const double w = samples_.area[i];
      total += w;
      node.place += w * samples_.points[i];
      node.wanted.value -= w * fitted_[i].value;
      node.wanted.gradient += w * radius * (samples_.normals[i] - fitted_[i].gradient);
      node.variance += w * w * samples_.sigma[i] * samples_.sigma[i];
    }
    node.place /= total;
    node.wanted = 1 / total * node.wanted;
    node.variance /= total * total;
    return node;
  }

  const Samples& samples_;
  KdTree tree_;
  WindingNumber winding_;
  const Eigen::Vector3d centre_ = Eigen::Vector3d::Constant(0.5);
  AlgebraicSphere base_{-0.75, Eigen::Vector3d::Zero(), 1};  // about the cube
  std::vector<Jet> fitted_;                                  // at the samples, so far
  double radius_ = first_radius;                             // of the level that is being added
  std::vector<char> silent_;  // levels in a row that had nothing to say of a sample but noise
  std::vector<RbfLevel> levels_;
  int iterations_ = 0;
  double relative_residual_ = 0;
  std::size_t unknowns_ = 0;
};

double fine_spacing(const Samples& samples) {
  std::vector<double> areas = samples.area;
  const auto twentieth = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 20);
  std::nth_element(areas.begin(), twentieth, areas.end());
  return std::sqrt(*twentieth);
}

}  // namespace

void check(const RbfOptions& options) {
  if (options.max_depth < 3 || options.max_depth > 20)
    throw Error(Trouble::usage,
                "rbf: max_depth is " + std::to_string(options.max_depth) + ", limits 3 and 20");
}

SurfaceResult rbf(const PointCloud& cloud, const RbfOptions& options, const Progress& progress) {
  check(options);
  const Stopwatch watch;
  const Samples samples = prepare_samples(cloud);
  const double spacing = fine_spacing(samples);
  const double last = last_radius(spacing);
  RbfField field(samples);
  for (double radius = first_radius;; radius /= 2) {
    if (progress)
      progress("solve", std::log2(first_radius / radius) / std::log2(first_radius / last));
    if (field.add_level(radius) < least_share || radius <= last) break;
  }
  if (progress) progress("surface", 0);
  const double cell = spacing + cell_sigmas * median(samples.sigma);  // as sample_depths() has it
  const int depth = static_cast<int>(
      std::clamp(std::ceil(-std::log2(cell)), 3.0, static_cast<double>(options.max_depth)));
  SurfaceResult result =
      world_surface(followed_surface(samples.points, depth,
                                     [&](const Eigen::Vector3d& u) { return field.value(u); }),
                    samples, "rbf");
  result.finest_cell_m = samples.box.side_m / (1 << depth);
  result.sigma_m = samples.box.side_m * median(samples.sigma);
  result.unknowns = field.unknowns();
  result.iterations = field.iterations();
  result.relative_residual = field.last_residual();
  result.stop = result.relative_residual <= relative_residual ? SolveStop::converged
                                                              : SolveStop::iteration_limit;
  result.cost.seconds = watch.seconds();
  if (progress) progress("surface", 1);
  return result;
}

}  // namespace scan
