// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bilateral_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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
constexpr double reach_in_lengths = 3.2, upper = 0.75;
// Shorter ones leave a thin plate's sheets rough.
constexpr double least_reach_spacings = 6;
// Curved faces want shorter ones. With 0.1 % noise the full reach, its 1/sqrt(2) and half of it
// leave the samples of a bunny 0.36, 0.31 and 0.33 sigma off (root mean square; the fit 0.34), of
// one with a fifth of the points 0.79, 0.57 and 0.47 (0.54), those of a sharp-edged part 0.22, 0.25
// and 0.32 (0.42).
constexpr double shortened = 0.7071067811865476;
constexpr int most_shortened = 2;
// Risks count scatter in height. Above a spacing, a short average takes its neighbours by where
// scatter has put them: the faces of a sharp-edged part with 0.5 % noise would be 11 % farther off.
constexpr double most_scatter_shortened = 1;  // in spacings
// A short average that is its own sample for the most part is scatter, and pulls handles out: the
// fit's foot is better.
constexpr double most_own_share = 0.5;
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
  return std::max(least_reach_spacings, reach_in_lengths * quantile(std::move(lengths), upper));
}

class BilateralFilter {
 public:
  // The reach is `share` of the usual one.
  BilateralFilter(const Samples& samples, const FittedSamples& fit, double share)
      : samples_(samples),
        fit_(fit),
        feet_(fit.feet),
        trust_(fit.trust),
        normals_(fit.normals),
        order_(curve_order(fit.feet)),
        is_at_foot_(fit.feet.size(), 0) {
    const double reach = share * reach_in_spacings(samples, fit);
    for (const double area : samples.area) reach_.push_back(reach * std::sqrt(area));
    grain_of_ = grains_of(feet_, normals_, reach_);
    std::vector<Eigen::Vector3d> centres;
    for (const Grain& grain : grains()) centres.push_back(grain.foot());
    tree_.emplace(centres);
    for (int round = 0; round < rounds_of_normals; ++round) smooth_normals();
    average();
  }

  // Mallows' and Stein's, as in local_smoothing.h.
  std::vector<double> risks() const {
    std::vector<double> risks;
    for (std::size_t i = 0; i < shift_.size(); ++i) {
      const double sigma2 = samples_.sigma[i] * samples_.sigma[i];
      risks.push_back(trust_[i] * (shift_[i] * shift_[i] + 2 * sigma2 * own_share_[i]));
    }
    return risks;
  }

  void take_marked(const std::vector<char>& marked, const BilateralFilter& other) {
    for (std::size_t i = 0; i < shift_.size(); ++i) {
      if (!marked[i]) continue;
      normals_[i] = other.normals_[i];
      shift_[i] = other.shift_[i];
      own_share_[i] = other.own_share_[i];
      is_at_foot_[i] = own_share_[i] > most_own_share;
    }
  }

  Samples moved() const {
    Samples result = samples_;
    result.normals = normals_;
    for (std::size_t i = 0; i < shift_.size(); ++i) {
      const Eigen::Vector3d average = samples_.points[i] + shift_[i] * normals_[i];
      result.points[i] = (is_at_foot_[i] ? feet_[i] : average).cwiseMax(0).cwiseMin(1);
      if (is_at_foot_[i]) result.normals[i] = fit_.normals[i];
    }
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
  const FittedSamples& fit_;
  const std::vector<Eigen::Vector3d>& feet_;
  const std::vector<double>& trust_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<std::uint32_t> order_;
  std::vector<double> reach_;
  std::vector<std::uint32_t> grain_of_;
  std::optional<KdTree> tree_;  // of the grains' feet
  std::vector<double> shift_, own_share_;
  std::vector<char> is_at_foot_;
};

double risk_of_fit(const Samples& samples, const FittedSamples& fit) {
  double sum = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const double own_share = leverage_share * leverage(samples.area[i], fit.length[i]);
    sum += fit.trust[i] * ((samples.points[i] - fit.feet[i]).squaredNorm() +
                           2 * samples.sigma[i] * samples.sigma[i] * own_share);
  }
  return sum;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

bool is_lower(double risk, double than) {
  return risk <= (1 - least_share_lowered) * than;
}

// Step by step, as long as that lowers the risk of all; and then in the regions where it does. The
// sum of the regions' choices would fall by chance alone.
void shorten_where_better(const Samples& samples, const FittedSamples& fit, BilateralFilter& best) {
  const LocalSmoothing regions(samples);
  double share = 1;
  for (int step = 0; step < most_shortened; ++step) {
    share *= shortened;
    const BilateralFilter shorter(samples, fit, share);
    std::vector<double> gain = best.risks();
    const std::vector<double> risks = shorter.risks();
    if (!is_lower(sum_of(risks), sum_of(gain))) return;
    for (std::size_t i = 0; i < gain.size(); ++i) gain[i] -= risks[i];
    best.take_marked(regions.are_positive_around(gain), shorter);
  }
}

}  // namespace

std::optional<Samples> bilateral_samples(const Samples& samples, const FittedSamples& fit) {
  const double scatter = median(samples.sigma) / std::sqrt(median(samples.area));
  if (scatter < least_scatter || scatter > most_scatter) return std::nullopt;
  BilateralFilter best(samples, fit, 1);
  if (scatter <= most_scatter_shortened) shorten_where_better(samples, fit, best);
  if (!is_lower(sum_of(best.risks()), risk_of_fit(samples, fit))) return std::nullopt;
  return best.moved();
}

}  // namespace scan
