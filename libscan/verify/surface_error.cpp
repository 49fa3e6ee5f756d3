// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Accuracy (measured to truth), completeness (truth to measured) and their F-score.
#include "libscan/verify/surface_error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
#include "libscan/search/closest_point.h"
#include "libscan/search/hausdorff.h"
#include "libscan/search/kd_tree.h"
#include "libscan/verify/statistics.h"

namespace scan {
namespace {

constexpr double widest_share = 0.01;
constexpr double least_share = 1e-6;  // of the diagonal: errors below it need no digits
constexpr std::size_t most_doublings = 3;

using Distances = std::function<std::vector<double>(const std::vector<Eigen::Vector3d>& places)>;

// What is compared: points with normals (or none) that stand for the measured surface, and the
// distance of any place to it.
struct Measured {
  std::vector<Eigen::Vector3d> points = {};
  std::vector<Eigen::Vector3d> normals = {};  // (0,0,0): unknown
  Distances distances_m;
  std::string over;             // what `points` are
  Values values = Values::all;  // whether they are all there is
  Bounds bounds;
};

// Angle between two directions, accurate near 0 and pi as acos is not (Kahan 2006, section 12).
double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

struct Accuracy {
  std::vector<double> errors_m;
  std::vector<double> normal_errors_rad;  // of the points with a known normal
};

Accuracy accuracy_of(const Measured& measured, const TrueSurface& truth) {
  const auto nearest = TrueDistance(truth).nearest_of_each(measured.points);
  Accuracy accuracy;
  accuracy.errors_m.reserve(nearest.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    accuracy.errors_m.push_back(std::abs(nearest[i].signed_distance_m));
    if (!measured.normals.empty() && measured.normals[i].norm() > 0.5)
      accuracy.normal_errors_rad.push_back(angle_rad(measured.normals[i], nearest[i].normal));
  }
  return accuracy;
}

std::vector<SurfaceSample> seen_only(std::vector<SurfaceSample> samples,
                                     const SurfaceErrorOptions& options) {
  if (options.seen_points.empty()) return samples;
  const KdTree seen(options.seen_points);
  std::vector<char> unseen(samples.size());
  parallel_for(samples.size(), [&](std::size_t i) {
    unseen[i] = !seen.nearest(samples[i].point, options.seen_distance_m).has_value();
  });
  std::vector<SurfaceSample> kept;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (!unseen[i]) kept.push_back(samples[i]);
  if (kept.empty())
    throw Error(Trouble::computation, "completeness: no part of the true surface lies within " +
                                          std::to_string(options.seen_distance_m) +
                                          " m of a seen point");
  return kept;
}

// Where planes are looked at: beside the bounded parts of the truth, where something was seen; with
// neither, where something was measured.
Bounds plane_region(const Measured& measured, const TrueSurface& truth,
                    const SurfaceErrorOptions& options) {
  if (!options.seen_points.empty()) return bounds_of(options.seen_points);
  const bool any_bounded =
      !truth.meshes.empty() ||
      std::any_of(truth.shapes.begin(), truth.shapes.end(),
                  [](const PlacedShape& shape) { return bounds_of(shape).sizes().allFinite(); });
  return any_bounded ? Bounds() : measured.bounds;
}

std::vector<double> completeness_of(const Measured& measured,
                                    const std::vector<SurfaceSample>& samples) {
  std::vector<Eigen::Vector3d> places;
  places.reserve(samples.size());
  for (const SurfaceSample& sample : samples) places.push_back(sample.point);
  return measured.distances_m(places);
}

double share_within(const std::vector<double>& errors_m, double threshold_m) {
  const auto within = std::count_if(errors_m.begin(), errors_m.end(),
                                    [&](double error_m) { return error_m <= threshold_m; });
  return static_cast<double>(within) / static_cast<double>(errors_m.size());
}

double default_threshold_m(const std::vector<SurfaceSample>& truth_samples) {
  Bounds box;
  for (const SurfaceSample& sample : truth_samples) box.extend(sample.point);
  return box.diagonal().norm() / 100;
}

std::string within_text(double threshold_m) {
  char text[64];
  std::snprintf(text, sizeof text, "samples within %.4g m, both ways", threshold_m);
  return text;
}

// Harmonic mean of precision and recall (Knapitsch et al. 2017, eq. 5). It grows with both, so it
// lies between those of the ends of their intervals, 19 times out of 20 or more often.
Measurement f_score(const std::vector<double>& accuracy_m, Values accuracy_values,
                    const std::vector<double>& completeness_m, double threshold_m) {
  const auto harmonic = [](double precision, double recall) {
    const double sum = precision + recall;
    return sum > 0 ? 2 * precision * recall / sum : 0;
  };
  const double precision = share_within(accuracy_m, threshold_m);
  const double recall = share_within(completeness_m, threshold_m);
  const Interval p = accuracy_values == Values::all ? Interval{precision, precision}
                                                    : share_interval(precision, accuracy_m.size()),
                 r = share_interval(recall, completeness_m.size());
  return {.name = "f_score",
          .value = harmonic(precision, recall),
          .unit = "1",
          .over = within_text(threshold_m),
          .count = accuracy_m.size() + completeness_m.size(),
          .interval = Interval{harmonic(p.low, r.low), harmonic(p.high, r.high)}};
}

// Of the two surfaces, from below: the farthest sample of either.
Measurement hausdorff(const std::vector<double>& accuracy_m,
                      const std::vector<double>& completeness_m) {
  return {.name = "hausdorff",
          .value = std::max(quantile(accuracy_m, 1), quantile(completeness_m, 1)),
          .unit = "m",
          .over = "the farthest sample of either surface from the other",
          .count = accuracy_m.size() + completeness_m.size()};
}

std::vector<Measurement> compare(const Measured& measured, const TrueSurface& truth,
                                 const SurfaceErrorOptions& options) {
  const Accuracy accuracy = accuracy_of(measured, truth);
  const auto truth_samples = sample_truth(truth, options.samples, options.seed + 1,
                                          plane_region(measured, truth, options));
  const double threshold_m = options.f_score_threshold_m > 0 ? options.f_score_threshold_m
                                                             : default_threshold_m(truth_samples);
  const auto completeness_m = completeness_of(measured, seen_only(truth_samples, options));

  auto figures = summary("accuracy", accuracy.errors_m, "m", measured.over, measured.values);
  const auto other_way =
      summary("completeness", completeness_m, "m",
              options.seen_points.empty() ? "samples of the true surface, uniform by area"
                                          : "samples of the true surface near seen points",
              Values::drawn);
  figures.insert(figures.end(), other_way.begin(), other_way.end());
  figures.push_back(hausdorff(accuracy.errors_m, completeness_m));
  figures.push_back(f_score(accuracy.errors_m, measured.values, completeness_m, threshold_m));
  if (!accuracy.normal_errors_rad.empty())
    figures.push_back({.name = "normal_error_mean",
                       .value = mean(accuracy.normal_errors_rad),
                       .unit = "rad",
                       .over = measured.over,
                       .count = accuracy.normal_errors_rad.size(),
                       .interval = measured.values == Values::drawn
                                       ? mean_interval(accuracy.normal_errors_rad)
                                       : std::nullopt});
  return figures;
}

// Between two meshes no sample is needed: the distance lies between proven bounds.
void prove_hausdorff(const Mesh& measured, const Mesh& truth, double diagonal_m,
                     std::vector<Measurement>& figures) {
  const DistanceBounds bounds =
      hausdorff_distance(measured, truth, {.least_m = least_share * diagonal_m});
  for (Measurement& m : figures) {
    if (m.name != "hausdorff") continue;
    m.value = bounds.low_m;
    m.interval = Interval{bounds.low_m, bounds.high_m};
    m.over = "both surfaces, by branch and bound; the interval is certain";
    m.count = measured.triangles.size() + truth.triangles.size();
  }
}

// Whether the means of both ways are known to `widest_share` of themselves, or of what matters.
bool is_settled(const std::vector<Measurement>& figures, double diagonal_m) {
  return std::none_of(figures.begin(), figures.end(), [&](const Measurement& m) {
    const bool is_mean = m.name == "accuracy_mean" || m.name == "completeness_mean";
    const double matters_m = std::max(std::abs(m.value), least_share * diagonal_m);
    return is_mean && m.interval &&
           m.interval->high - m.interval->low > 2 * widest_share * matters_m;
  });
}

void check_options(const SurfaceErrorOptions& options) {
  if (options.samples == 0) throw Error(Trouble::usage, "surface error: samples is 0");
  if (!options.seen_points.empty() && !(options.seen_distance_m > 0))
    throw Error(Trouble::usage, "surface error: seen_distance_m is " +
                                    std::to_string(options.seen_distance_m) +
                                    ", must be positive when seen points are given");
}

}  // namespace

std::vector<Measurement> surface_error(const Mesh& mesh, const TrueSurface& truth,
                                       const SurfaceErrorOptions& options) {
  check_options(options);
  check(mesh);
  if (mesh.empty()) throw Error(Trouble::input, "measured surface: no triangles");
  const MeshSearch search(mesh);
  const Bounds bounds = bounds_of(mesh.vertices);
  const Distances to_mesh = [&](const std::vector<Eigen::Vector3d>& places) {
    std::vector<double> distances_m;
    distances_m.reserve(places.size());
    for (const ClosestPoint& closest : closest_of_each(search, places))
      distances_m.push_back(closest.distance_m);
    return distances_m;
  };
  const auto with_samples = [&](std::size_t samples) {
    Measured measured{.distances_m = to_mesh,
                      .over = "samples of the measured surface, uniform by area",
                      .values = Values::drawn,
                      .bounds = bounds};
    for (const SurfaceSample& sample : sample_surface(mesh, samples, options.seed)) {
      measured.points.push_back(sample.point);
      measured.normals.push_back(sample.normal);
    }
    SurfaceErrorOptions with = options;
    with.samples = samples;
    return compare(measured, truth, with);
  };
  auto figures = with_samples(options.samples);
  const double diagonal_m = bounds.diagonal().norm();
  for (std::size_t k = 1; k <= most_doublings && !is_settled(figures, diagonal_m); ++k)
    figures = with_samples(options.samples << k);
  if (truth.shapes.empty() && truth.meshes.size() == 1 && options.seen_points.empty())
    prove_hausdorff(mesh, truth.meshes.front(), diagonal_m, figures);
  return figures;
}

std::vector<Measurement> cloud_error(const PointCloud& cloud, const TrueSurface& truth,
                                     const SurfaceErrorOptions& options) {
  check_options(options);
  check(cloud);
  const PointCloud finite = subset(cloud, finite_points(cloud));
  if (finite.empty()) throw Error(Trouble::input, "measured cloud: no finite point");
  const KdTree search(finite.points);
  const Distances to_points = [&](const std::vector<Eigen::Vector3d>& places) {
    std::vector<Neighbour> found;
    nearest_of_each(search, places, unlimited_m, curve_order(places), found);
    std::vector<double> distances_m;
    distances_m.reserve(found.size());
    for (const Neighbour& neighbour : found)
      distances_m.push_back(std::sqrt(neighbour.distance2_m2));
    return distances_m;
  };
  return compare({.points = finite.points,
                  .normals = finite.normals,
                  .distances_m = to_points,
                  .over = "measured points",
                  .bounds = bounds_of(finite.points)},
                 truth, options);
}

}  // namespace scan
