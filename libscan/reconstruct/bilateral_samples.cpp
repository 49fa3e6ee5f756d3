// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bilateral_samples.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/grains.h"
#include "libscan/reconstruct/local_smoothing.h"
#include "libscan/search/batch.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

// In two dimensions a biweight of reach R passes 48 J_3(k R) / (k R)^3 of a wave of number k: half
// at k R = 3.2, as the fit at k length = 1 (local_smoothing.h). Lengths are short along creases,
// where an average that stops there need not be: the upper quartile of all speaks for the flanks.
constexpr double reach_in_lengths = 3.2, quantile = 0.75;
// Shorter ones leave a thin plate's sheets rough. On curved faces a longer one is farther off: 5, 6
// and 8 leave a bunny with 0.1 % noise 23, 26 and 32e-5 of its diagonal, a sharp-edged part 17.2,
// 15.4 and 13.1.
constexpr double least_reach_spacings = 6;
constexpr double least_scatter = 0.1, most_scatter = 2;  // in spacings
constexpr double normal_reach = 0.4;                     // difference of unit normals
constexpr int rounds_of_normals = 2;
// Gains of single samples scatter by 0.2 sigma^2: of 4,000 this is three standard errors. Parts
// with creases gain 6 to 74 %, smooth ones with 0.1 % noise lose.
constexpr double least_share_lowered = 0.01;
// The fit's leverage is half that of a continuum (local_smoothing.h).
constexpr double leverage_share = 0.5;

double biweight(double share2) {
  const double t = 1 - share2;
  return t > 0 ? t * t : 0;
}

double reach_in_spacings(const Samples& samples, const FittedSamples& fit) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < fit.length.size(); ++i)
    lengths.push_back(fit.length[i] / std::sqrt(samples.area[i]));
  const auto at = lengths.begin() +
                  static_cast<std::ptrdiff_t>(quantile * static_cast<double>(lengths.size() - 1));
  std::nth_element(lengths.begin(), at, lengths.end());
  return std::max(least_reach_spacings, reach_in_lengths * *at);
}

class BilateralFilter {
 public:
  BilateralFilter(const Samples& samples, const FittedSamples& fit)
      : samples_(samples),
        feet_(fit.feet),
        trust_(fit.trust),
        normals_(fit.normals),
        order_(curve_order(fit.feet)) {
    const double reach = reach_in_spacings(samples, fit);
    for (const double area : samples.area) reach_.push_back(reach * std::sqrt(area));
    grain_of_ = grains_of(feet_, normals_, reach_);
    std::vector<Eigen::Vector3d> centres;
    for (const Grain& grain : grains()) centres.push_back(grain.foot());
    tree_.emplace(centres);
    for (int round = 0; round < rounds_of_normals; ++round) smooth_normals();
    average();
  }

  // Mallows' and Stein's, as in local_smoothing.h.
  double risk_of_average(std::size_t i) const {
    return trust_[i] *
           (shift_[i] * shift_[i] + 2 * samples_.sigma[i] * samples_.sigma[i] * own_share_[i]);
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
  // Calls body(i, grain, weight) for the grains around each i, and end(i) after the last.
  template <class Body, class End>
  void for_grains(const std::vector<Grain>& grains, Body&& body, End&& end) const {
    std::vector<Eigen::Vector3d> normals;
    for (const Grain& grain : grains) normals.push_back(grain.normal());
    parallel_chunks(order_.size(), queries_per_task, [&](std::size_t first, std::size_t last) {
      std::vector<Neighbour> near;
      for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t i = order_[k];
        tree_->within(feet_[i], reach_[i], near);
        for (const Neighbour& n : near) {
          const double apart2 = (normals[n.index] - normals_[i]).squaredNorm();
          body(i, grains[n.index],
               biweight(n.distance2_m2 / (reach_[i] * reach_[i])) *
                   biweight(apart2 / (normal_reach * normal_reach)));
        }
        end(i);
      }
    });
  }

  std::vector<Grain> grains() const {
    return summed_grains(grain_of_, {samples_.points, feet_, normals_, trust_});
  }

  void smooth_normals() {
    std::vector<Eigen::Vector3d> sums(normals_.size(), Eigen::Vector3d::Zero());
    for_grains(
        grains(),
        [&](std::size_t i, const Grain& g, double weight) { sums[i] += weight * g.normals; },
        [&](std::size_t i) { sums[i] = sums[i].norm() > 0 ? sums[i].normalized() : normals_[i]; });
    normals_ = std::move(sums);
  }

  void average() {
    std::vector<double> sum(normals_.size(), 0.0);
    shift_ = own_share_ = sum;
    for_grains(
        grains(),
        [&](std::size_t i, const Grain& g, double weight) {
          const Eigen::Vector3d& n = normals_[i];
          const Eigen::Vector3d& p = samples_.points[i];
          shift_[i] += weight / 2 *
                       (n.dot(g.points - g.trust * p) + g.points_along_normals - g.normals.dot(p));
          sum[i] += weight * g.trust;
        },
        [&](std::size_t i) {
          // Its share is told as if it stood in the middle of its grain, a little too large.
          shift_[i] = sum[i] > 0 ? shift_[i] / sum[i] : 0;
          own_share_[i] = sum[i] > 0 ? std::min(1.0, trust_[i] / sum[i]) : 1;
        });
  }

  const Samples& samples_;
  const std::vector<Eigen::Vector3d>& feet_;
  const std::vector<double>& trust_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<std::uint32_t> order_;
  std::vector<double> reach_;
  std::vector<std::uint32_t> grain_of_;
  std::optional<KdTree> tree_;  // of the grains' feet
  std::vector<double> shift_, own_share_;
};

double risk_of_fit(std::size_t i, const FittedSamples& fit, const Samples& samples) {
  const double own_share = leverage_share * leverage(samples.area[i], fit.length[i]);
  return fit.trust[i] * ((samples.points[i] - fit.feet[i]).squaredNorm() +
                         2 * samples.sigma[i] * samples.sigma[i] * own_share);
}

}  // namespace

std::optional<Samples> bilateral_samples(const Samples& samples, const FittedSamples& fit) {
  const double scatter = median(samples.sigma) / std::sqrt(median(samples.area));
  if (scatter < least_scatter || scatter > most_scatter) return std::nullopt;
  const BilateralFilter filter(samples, fit);
  double of_averages = 0, of_fits = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    of_averages += filter.risk_of_average(i);
    of_fits += risk_of_fit(i, fit, samples);
  }
  if (of_averages > (1 - least_share_lowered) * of_fits) return std::nullopt;
  return filter.moved();
}

}  // namespace scan
