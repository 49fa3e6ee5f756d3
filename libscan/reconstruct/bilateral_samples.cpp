// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bilateral_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

// In spacings.
constexpr std::array filter_reaches = {3.5, 6.0};
constexpr double normal_reach = 0.4;  // difference of unit normals
constexpr int rounds_of_normals = 2;
constexpr double proven = 2.326;  // standard errors: one-sided, 1 %
constexpr double least_moved = 0.1;
// The fit's leverage is half that of a continuum (local_smoothing.h).
constexpr double leverage_share = 0.5;
// exp(-2 t^2), like the biweight, halves a ripple of wave number k at k reach = 2 sqrt(2 log 2).
const double lengths_per_reach = 1 / (2 * std::sqrt(2 * std::numbers::ln2));

double biweight(double share2) {
  const double t = 1 - share2;
  return t > 0 ? t * t : 0;
}

struct Candidate {
  std::vector<Eigen::Vector3d> points, normals;
  std::vector<double> risk;
};

class BilateralFilter {
 public:
  BilateralFilter(const Samples& samples, const FittedSamples& fit)
      : samples_(samples), fit_(fit), order_(curve_order(samples.points)) {
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      feet_.push_back(samples.points[i] - fit.residuals[i] * fit.normals[i]);
      scale_.push_back(std::sqrt(samples.area[i]));
    }
    tree_.emplace(feet_);
  }

  std::vector<double> risk_of_fit() const {
    std::vector<double> result;
    for (std::size_t i = 0; i < feet_.size(); ++i)
      result.push_back(
          risk(i, fit_.residuals[i], leverage_share * leverage(samples_.area[i], fit_.length[i])));
    return result;
  }

  // By each reach.
  std::array<Candidate, filter_reaches.size()> filtered() const {
    Candidate start{samples_.points, fit_.normals, {}};
    for (int round = 0; round < rounds_of_normals; ++round) smooth(start.normals);
    start.risk.resize(feet_.size());
    std::array<Candidate, filter_reaches.size()> results;
    results.fill(start);
    for_neighbours(filter_reaches.back(), [&](std::size_t i, std::span<const Neighbour> near) {
      for (std::size_t r = 0; r < results.size(); ++r)
        average(i, near, std::pow(filter_reaches[r] * scale_[i], 2), results[r]);
    });
    return results;
  }

 private:
  void average(std::size_t i, std::span<const Neighbour> near, double reach2, Candidate& to) const {
    double shift = 0, sum = 0, own = 0;
    for (const Neighbour& n : near) {
      const double w = weight(to.normals, i, n, reach2);
      if (!(w > 0)) continue;
      shift +=
          w *
          (to.normals[i] + to.normals[n.index]).dot(samples_.points[n.index] - samples_.points[i]);
      sum += w;
      if (n.index == i) own = w;
    }
    shift *= 0.5 / sum;
    to.points[i] += shift * to.normals[i];
    to.risk[i] = risk(i, shift, own / sum);
  }

  // Mallows' and Stein's, as in local_smoothing.h.
  double risk(std::size_t i, double residual, double share) const {
    return fit_.trust[i] *
           (residual * residual + 2 * samples_.sigma[i] * samples_.sigma[i] * share);
  }

  double weight(const std::vector<Eigen::Vector3d>& normals, std::size_t i, const Neighbour& n,
                double reach2) const {
    const double apart2 = (normals[n.index] - normals[i]).squaredNorm();
    return fit_.trust[n.index] * biweight(n.distance2_m2 / reach2) *
           biweight(apart2 / (normal_reach * normal_reach));
  }

  template <class Body>
  void for_neighbours(double reach, Body&& body) const {
    parallel_chunks(order_.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
      std::vector<Neighbour> near;
      for (std::size_t k = begin; k < end; ++k) {
        const std::uint32_t i = order_[k];
        tree_->within(feet_[i], reach * scale_[i], near);
        body(i, near);
      }
    });
  }

  void smooth(std::vector<Eigen::Vector3d>& normals) const {
    std::vector<Eigen::Vector3d> smoothed(normals.size());
    for_neighbours(filter_reaches[0], [&](std::size_t i, std::span<const Neighbour> near) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Neighbour& n : near)
        sum += weight(normals, i, n, std::pow(filter_reaches[0] * scale_[i], 2)) * normals[n.index];
      smoothed[i] = sum.normalized();
    });
    normals = std::move(smoothed);
  }

  const Samples& samples_;
  const FittedSamples& fit_;
  std::vector<std::uint32_t> order_;
  std::vector<Eigen::Vector3d> feet_;
  std::vector<double> scale_;
  std::optional<KdTree> tree_;
};

bool in_cube(const Eigen::Vector3d& u) {
  return u.minCoeff() >= 0 && u.maxCoeff() <= 1;
}

}  // namespace

std::optional<BilateralSamples> bilateral_samples(const Samples& samples, const FittedSamples& fit,
                                                  const LocalSmoothing& regions,
                                                  double least_length) {
  if (median(samples.sigma) > std::sqrt(median(samples.area))) return std::nullopt;
  const BilateralFilter filter(samples, fit);
  const std::vector<double> before = filter.risk_of_fit();
  const auto candidates = filter.filtered();
  const std::size_t count = samples.points.size();
  std::vector<double> gained(count, 0.0);
  BilateralSamples result{samples, fit.length};
  for (std::size_t r = 0; r < candidates.size(); ++r) {
    const Candidate& other = candidates[r];
    std::vector<double> gain(count);
    for (std::size_t i = 0; i < count; ++i) gain[i] = before[i] - other.risk[i];
    const std::vector<MeanAround> around = regions.mean_with_error(gain);
    for (std::size_t i = 0; i < count; ++i) {
      const double best = std::max(gained[i], proven * around[i].standard_error);
      const double smooths = lengths_per_reach * filter_reaches[r] * std::sqrt(samples.area[i]);
      if (smooths < least_length || !(around[i].mean > best) || !in_cube(other.points[i])) continue;
      gained[i] = around[i].mean;
      result.samples.points[i] = other.points[i];
      result.samples.normals[i] = other.normals[i];
      result.samples.sigma[i] = result.length[i] = 0;
    }
  }
  const auto moved = std::count_if(gained.begin(), gained.end(), [](double g) { return g > 0; });
  if (static_cast<double>(moved) < least_moved * static_cast<double>(count)) return std::nullopt;
  return result;
}

}  // namespace scan
