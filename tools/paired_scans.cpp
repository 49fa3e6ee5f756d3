// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/paired_scans.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libscan/verify/statistics.h"

namespace scan {
namespace {

constexpr double false_alarm = 0.01;  // that any point of a scan is blamed by chance
constexpr double looks = 3;           // at the repeats so far
constexpr double jump_px = 1;
constexpr double finest_m = 1e-9;  // that decoders' arithmetic resolves

std::size_t ray_count(const Scan& scan) {
  std::size_t rays = scan.ray.size();
  for (const auto& [reason, count] : scan.misses) rays += count;
  return rays;
}

// Index of each ray's point.
std::vector<std::optional<std::size_t>> points_of(const Scan& scan, std::size_t rays) {
  std::vector<std::optional<std::size_t>> points(rays);
  for (std::size_t i = 0; i < scan.ray.size(); ++i) points[scan.ray[i]] = i;
  return points;
}

// Along the ray: a point stays on it, or on the laser's plane, where farther is positive.
double change_m(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  const Eigen::Vector3d change = after - before;
  return std::copysign(change.norm(), change.dot(before));
}

void judge_point(const MedianInterval& interval, double sigma_m, double slack_sigma,
                 EffectComparison& result) {
  const double bound_m = std::min(result.bound.range_m, result.bound.sigmas * sigma_m) +
                         slack_sigma * sigma_m + finest_m;
  const double least_m = std::max({0.0, interval.low, -interval.high});
  const double most_m = std::max(interval.high, -interval.low);
  const bool beyond = least_m > bound_m;
  ++result.points;
  result.beyond += beyond;
  result.undecided += !beyond && most_m > bound_m + matters_sigma * sigma_m;
  result.moved_sigma = std::max(result.moved_sigma, least_m / sigma_m);
  const double moved_m = std::abs(interval.median), excess_m = moved_m - bound_m;
  if (!(excess_m > 0)) return;
  const double error_m = std::max((moved_m - least_m) / result.limit_errors, finest_m);
  if (excess_m / error_m < result.excess_errors) return;
  result.excess_errors = excess_m / error_m;
  result.excess_m = excess_m;
}

}  // namespace

PairedScans::PairedScans(std::vector<char> at_edge, const StereoCalibration* stereo)
    : at_edge_(std::move(at_edge)), stereo_(stereo) {}

void PairedScans::add(const Scan& planned, const Scan& fuller) {
  const std::size_t rays = ray_count(planned);
  rays_.resize(rays);
  once_.resize(rays);
  const auto before = points_of(planned, rays), after = points_of(fuller, rays);
  double bias = 0;
  std::size_t pairs = 0;
  for (std::size_t ray = 0; ray < rays; ++ray) {
    if (before[ray].has_value() != after[ray].has_value()) once_[ray] = 1, identical_ = false;
    if (!before[ray] || !after[ray]) continue;
    RayChanges& changes = rays_[ray];
    const Eigen::Vector3d& x = planned.cloud.points[*before[ray]];
    const Eigen::Vector3d& y = fuller.cloud.points[*after[ray]];
    if (changes.change_m.empty()) changes.sigma_m = planned.cloud.sigma_m[*before[ray]];
    const double moved_m = change_m(x, y);
    changes.change_m.push_back(moved_m);
    if (stereo_)
      changes.jumps |=
          std::abs(stereo_->focal_px * stereo_->baseline_m * (1 / x.z() - 1 / y.z())) > jump_px;
    identical_ = identical_ && moved_m == 0;
    if (changes.jumps && at_edge_[ray]) continue;
    bias += moved_m / changes.sigma_m;
    ++pairs;
  }
  bias_sigma_.push_back(pairs > 0 ? bias / static_cast<double>(pairs) : 0);
  ++repeats_;
}

double PairedScans::false_alarm_of_point() const {
  const auto points = std::count_if(rays_.begin(), rays_.end(),
                                    [](const RayChanges& ray) { return !ray.change_m.empty(); });
  return false_alarm / looks / std::max(1.0, static_cast<double>(points));
}

int PairedScans::least_repeats() const {
  return least_count(false_alarm_of_point());
}

std::optional<MedianInterval> PairedScans::interval_of(const RayChanges& ray, bool is_exact) const {
  std::vector<double> changes = ray.change_m;
  if (is_exact) return MedianInterval{changes[0], changes[0], changes[0]};
  return median_interval(changes, false_alarm_of_point());
}

EffectComparison PairedScans::judge(const std::string& effect, const EffectBound& bound,
                                    double slack_sigma, bool is_exact) const {
  EffectComparison result{.effect = effect, .bound = bound, .repeats = repeats_};
  result.limit_errors = normal_limit(false_alarm_of_point());
  std::vector<double> half_widths_sigma;
  for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
    if (rays_[ray].change_m.empty()) {
      result.lost += once_[ray];
    } else if (rays_[ray].jumps && at_edge_[ray]) {
      ++result.at_edges;
    } else if (const auto interval = interval_of(rays_[ray], is_exact)) {
      const double sigma_m = rays_[ray].sigma_m;
      judge_point(*interval, sigma_m, slack_sigma, result);
      half_widths_sigma.push_back((interval->high - interval->low) / 2 / sigma_m);
    } else {
      ++result.unsteady;
    }
  }
  if (!half_widths_sigma.empty()) result.resolution_sigma = quantile(half_widths_sigma, 0.95);
  std::vector<double> means = bias_sigma_;
  const auto bias = is_exact ? MedianInterval{means[0], means[0], means[0]}
                             : median_interval(means, false_alarm / looks);
  if (bias) {
    result.bias_sigma = bias->median;
    result.bias_low_sigma = bias->low;
    result.bias_high_sigma = bias->high;
  }
  const bool biased =
      result.bias_low_sigma > matters_sigma || result.bias_high_sigma < -matters_sigma;
  result.pass = result.beyond == 0 && !biased;
  return result;
}

}  // namespace scan
