// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/moving_least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/shortest.h"
#include "libscan/reconstruct/algebraic_sphere.h"
#include "libscan/reconstruct/followed_surface.h"
#include "libscan/reconstruct/samples.h"
#include "libscan/reconstruct/world_surface.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr double widening = 1.5;  // the support of neighbours may be so much wider
// Supports reach at least so many times as far as the nearest sample: a fit off the surface weighs
// 1 - 1/9 of the samples or more that one on it weighs. Else the last few that a support holds
// decide, which off an edge may all be of one side, whose plane goes on there.
constexpr double farther = 3;
constexpr std::size_t probes = 2000;              // samples at which the noise is estimated
constexpr double narrowest = 2.5, widest = 20.5;  // support, in spacings
constexpr double hole = 1;                        // left out about a sample, in spacings
constexpr double least_gain = 0.99;               // a wider support must be better by this factor
constexpr double give_up = 1.5;                   // and the search ends where it is so much worse
constexpr double least_agreement = 0.1;           // of normals, for a fit to all
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class MlsField {
 public:
  MlsField(const Samples& samples, const MlsOptions& options)
      : samples_(samples), options_(options), tree_(samples.points), support_(samples.area.size()) {
    if (options.support_spacings > 0)
      set_support(options.support_spacings);
    else
      choose_support();
  }

  // A support's radius at the median sample, in unit-cube lengths.
  double typical_support() const {
    std::vector<double> all = support_;
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return *middle;
  }

  // Samples within `left_out` have no say. Where the others contradict one another, the fit goes by
  // the nearest one's normal.
  std::optional<AlgebraicSphere> sphere(const Eigen::Vector3d& x, std::vector<Neighbour>& found,
                                        double left_out = 0) const {
    const auto nearest = tree_.nearest(x, unlimited_m);
    const double least = farther * std::sqrt(nearest->distance2_m2);
    tree_.within(x, std::max(widening * support_[nearest->index], least), found);
    std::erase_if(found, [&](const Neighbour& n) {
      return n.distance2_m2 < left_out * left_out || !(weight(n, least) > 0);
    });
    if (std::none_of(found.begin(), found.end(), [&](const Neighbour& n) { return weight(n) > 0; }))
      return std::nullopt;
    SphereSums sums;
    for (const Neighbour& n : found)
      sums.add(weight(n, least), samples_.points[n.index] - x, samples_.normals[n.index]);
    if (!(sums.agreement() < least_agreement)) {
      const Eigen::Vector3d here = sums.fit()->gradient(Eigen::Vector3d::Zero()).normalized();
      if (const auto fitted = refit(found, x, least, here, false)) return fitted;
    }
    const auto first = std::min_element(
        found.begin(), found.end(),
        [](const Neighbour& a, const Neighbour& b) { return a.distance2_m2 < b.distance2_m2; });
    return refit(found, x, least, samples_.normals[first->index], true);
  }

  double value(const Eigen::Vector3d& x) const {
    thread_local std::vector<Neighbour> found;
    const auto fitted = sphere(x, found);
    return fitted ? fitted->distance(Eigen::Vector3d::Zero()) : unknown;
  }

  // The samples, moved onto the surface.
  std::vector<Eigen::Vector3d> seeds() const {
    std::vector<Eigen::Vector3d> on_surface = samples_.points;
    parallel_for(on_surface.size(), [&](std::size_t i) {
      std::vector<Neighbour> found;
      for (int step = 0; step < 2; ++step) {
        const auto fitted = sphere(on_surface[i], found);
        if (!fitted) return;
        const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
        on_surface[i] -= fitted->distance(zero) * fitted->gradient(zero).normalized();
      }
    });
    return on_surface;
  }

 private:
  // With a support of its own, or of `least` if that is wider.
  double weight(const Neighbour& n, double least = 0) const {
    const double h = std::max(support_[n.index], least);
    const double t = 1 - n.distance2_m2 / (h * h);
    return t > 0 ? samples_.area[n.index] * t * t * t * t : 0;
  }

  // Weights less the more a normal differs from the fit's gradient there (Oztireli 2009, eq. 15).
  // On a thin wall or in a narrow gap the samples that face elsewhere are fitted too: if each fit
  // has the other's samples behind it, what is inside is inside both, and if it has them before it,
  // inside either.
  std::optional<AlgebraicSphere> refit(const std::vector<Neighbour>& found,
                                       const Eigen::Vector3d& x, double least,
                                       const Eigen::Vector3d& here, bool is_wall) const {
    const double tolerance2 = options_.normal_tolerance * options_.normal_tolerance;
    SphereSums near, other;
    for (const Neighbour& n : found) {
      const double w = weight(n, least);
      const Eigen::Vector3d offset = samples_.points[n.index] - x;
      const Eigen::Vector3d& normal = samples_.normals[n.index];
      const double difference2 = (normal - here).squaredNorm();
      near.add(w * std::exp(-difference2 / tolerance2), offset, normal);
      if (difference2 > tolerance2) other.add(w, offset, normal);
    }
    if (near.agreement() < least_agreement) return std::nullopt;
    const AlgebraicSphere a = *near.fit();
    if (!is_wall || other.agreement() < least_agreement) return a;
    const AlgebraicSphere b = *other.fit();
    const double of_other = a.mean_value(other), of_near = b.mean_value(near);
    if (of_other * of_near <= 0) return a;
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    return (a.distance(zero) < b.distance(zero)) == (of_near < 0) ? b : a;
  }

  void set_support(double spacings) {
    for (std::size_t i = 0; i < support_.size(); ++i)
      support_[i] = spacings * std::sqrt(samples_.area[i]);
  }

  void choose_support() {
    double best = narrowest, least = std::numeric_limits<double>::infinity();
    for (double spacings = narrowest; spacings < widest; spacings *= std::sqrt(2.0)) {
      set_support(spacings);
      const double miss = mean_miss();
      if (miss > give_up * least) break;
      if (miss < least * least_gain) {
        least = miss;
        best = spacings;
      }
    }
    set_support(best);
  }

  // Mean distance of some samples from the surface that others make, those next to them left out
  // (their normals may know of them); far ones cut off at three times the median.
  double mean_miss() const {
    const std::size_t step = std::max<std::size_t>(1, samples_.points.size() / probes);
    std::vector<double> misses(samples_.points.size() / step);
    parallel_for(misses.size(), [&](std::size_t i) {
      std::vector<Neighbour> found;
      const std::size_t at = i * step;
      const auto fitted = sphere(samples_.points[at], found, hole * std::sqrt(samples_.area[at]));
      misses[i] = fitted ? std::abs(fitted->distance(Eigen::Vector3d::Zero())) : support_[at];
    });
    const auto middle = misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2);
    std::nth_element(misses.begin(), middle, misses.end());
    const double most = 3 * *middle;
    double sum = 0;
    for (const double miss : misses) sum += std::min(miss, most);
    return sum / static_cast<double>(misses.size());
  }

  const Samples& samples_;
  const MlsOptions& options_;
  KdTree tree_;
  std::vector<double> support_;
};

int depth_for(double support, const MlsOptions& options) {
  const double depth = std::ceil(-std::log2(support / 3));
  return static_cast<int>(std::clamp(depth, 3.0, static_cast<double>(options.max_depth)));
}

void require(bool fulfilled, const char* field, double value, const char* limit) {
  if (!fulfilled)
    throw Error(Trouble::usage,
                std::string("mls: ") + field + " is " + shortest(value) + ", limit " + limit);
}

}  // namespace

void check(const MlsOptions& options) {
  require(options.support_spacings == 0 ||
              (options.support_spacings >= 1 && options.support_spacings <= 100),
          "support_spacings", options.support_spacings, "0 or 1 to 100");
  require(options.normal_tolerance > 0, "normal_tolerance", options.normal_tolerance, "above 0");
  require(options.max_depth >= 3 && options.max_depth <= 20, "max_depth", options.max_depth,
          "3 to 20");
}

SurfaceResult mls(const PointCloud& cloud, const MlsOptions& options, const Progress& progress) {
  check(options);
  const Stopwatch watch;
  const Samples samples = prepare_samples(cloud);
  if (progress) progress("surface", 0);
  const MlsField field(samples, options);
  const int depth = depth_for(field.typical_support(), options);
  Mesh mesh = followed_surface(field.seeds(), depth,
                               [&](const Eigen::Vector3d& u) { return field.value(u); });
  SurfaceResult result = world_surface(std::move(mesh), samples, "mls");
  result.finest_cell_m = samples.box.side_m / (1 << depth);
  result.stop = SolveStop::direct;
  result.cost.seconds = watch.seconds();
  if (progress) progress("surface", 1);
  return result;
}

}  // namespace scan
