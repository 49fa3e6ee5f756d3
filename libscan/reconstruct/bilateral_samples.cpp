// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bilateral_samples.h"

#include <cmath>
#include <span>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/local_smoothing.h"
#include "libscan/search/batch.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

// In spacings. A longer reach is nearer on flat faces and farther on curved ones: 5, 6 and 8 leave
// a sharp-edged part 17.2, 15.4 and 13.1e-5 of the diagonal off, a bunny 23, 26 and 32.
constexpr double reach_spacings = 6;
constexpr double least_scatter = 0.1, most_scatter = 1;
constexpr double normal_reach = 0.4;  // difference of unit normals
constexpr int rounds_of_normals = 2;
// Gains of single samples scatter by 0.2 sigma^2: of 1,000 this is three standard errors. Parts
// with creases gain 9 to 49 %, smooth ones lose.
constexpr double least_share_lowered = 0.02;
// The fit's leverage is half that of a continuum (local_smoothing.h).
constexpr double leverage_share = 0.5;

double biweight(double share2) {
  const double t = 1 - share2;
  return t > 0 ? t * t : 0;
}

class BilateralFilter {
 public:
  BilateralFilter(const Samples& samples, const FittedSamples& fit)
      : samples_(samples),
        trust_(fit.trust),
        normals_(fit.normals),
        order_(curve_order(samples.points)) {
    for (std::size_t i = 0; i < samples.points.size(); ++i)
      feet_.push_back(samples.points[i] - fit.residuals[i] * fit.normals[i]);
    tree_.emplace(feet_);
    for (int round = 0; round < rounds_of_normals; ++round) smooth_normals();
    average();
  }

  // Mallows' and Stein's, as in local_smoothing.h: the sum over all samples.
  double risk() const {
    double sum = 0;
    for (std::size_t i = 0; i < shift_.size(); ++i)
      sum +=
          trust_[i] * (shift_[i] * shift_[i] + 2 * std::pow(samples_.sigma[i], 2) * own_share_[i]);
    return sum;
  }

  Samples moved() const {
    Samples result = samples_;
    for (std::size_t i = 0; i < shift_.size(); ++i)
      result.points[i] = (samples_.points[i] + shift_[i] * normals_[i]).cwiseMax(0).cwiseMin(1);
    result.normals = normals_;
    result.sigma.assign(shift_.size(), 0.0);
    return result;
  }

 private:
  // Calls body(i, j, weight) for the neighbours j of each i, and end(i) after the last.
  template <class Body, class End>
  void for_neighbours(Body&& body, End&& end) const {
    parallel_chunks(order_.size(), queries_per_task, [&](std::size_t first, std::size_t last) {
      std::vector<Neighbour> near;
      for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t i = order_[k];
        const double reach = reach_spacings * std::sqrt(samples_.area[i]);
        tree_->within(feet_[i], reach, near);
        for (const Neighbour& n : near) {
          const double apart2 = (normals_[n.index] - normals_[i]).squaredNorm();
          body(i, n.index,
               trust_[n.index] * biweight(n.distance2_m2 / (reach * reach)) *
                   biweight(apart2 / (normal_reach * normal_reach)));
        }
        end(i);
      }
    });
  }

  void smooth_normals() {
    std::vector<Eigen::Vector3d> sums(normals_.size(), Eigen::Vector3d::Zero());
    for_neighbours([&](std::size_t i, std::size_t j, double w) { sums[i] += w * normals_[j]; },
                   [&](std::size_t i) { sums[i].normalize(); });
    normals_ = std::move(sums);
  }

  void average() {
    std::vector<double> sum(normals_.size(), 0.0);
    shift_ = own_share_ = sum;
    const auto& points = samples_.points;
    for_neighbours(
        [&](std::size_t i, std::size_t j, double w) {
          shift_[i] += w * (normals_[i] + normals_[j]).dot(points[j] - points[i]) / 2;
          sum[i] += w;
        },
        [&](std::size_t i) {
          shift_[i] /= sum[i];
          own_share_[i] = trust_[i] / sum[i];
        });
  }

  const Samples& samples_;
  const std::vector<double>& trust_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<std::uint32_t> order_;
  std::vector<Eigen::Vector3d> feet_;
  std::optional<KdTree> tree_;
  std::vector<double> shift_, own_share_;
};

double risk_of(const FittedSamples& fit, const Samples& samples) {
  double sum = 0;
  for (std::size_t i = 0; i < fit.residuals.size(); ++i)
    sum += fit.trust[i] *
           (std::pow(fit.residuals[i], 2) + 2 * std::pow(samples.sigma[i], 2) * leverage_share *
                                                leverage(samples.area[i], fit.length[i]));
  return sum;
}

}  // namespace

std::optional<Samples> bilateral_samples(const Samples& samples, const FittedSamples& fit) {
  const double scatter = median(samples.sigma) / std::sqrt(median(samples.area));
  if (scatter < least_scatter || scatter > most_scatter) return std::nullopt;
  const BilateralFilter filter(samples, fit);
  if (filter.risk() > (1 - least_share_lowered) * risk_of(fit, samples)) return std::nullopt;
  return filter.moved();
}

}  // namespace scan
