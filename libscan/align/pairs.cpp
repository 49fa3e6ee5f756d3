// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pairs.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

// Points off the overlap take several times as long to find a partner for as others, and follow one
// another: small chunks share them out.
constexpr std::size_t chunk = 128;
// Losses are a few nanoseconds each: below this many, handing them over costs more than it saves.
constexpr std::size_t light_chunk = 4096;
// Beyond three scales the loss weighs a residual with 1 % and its slope falls.
constexpr double most_scales = 3;
// Thickness of the planes of generalised ICP in units of their extent, where the scan does not tell
// its noise: the root of the 1e-3 of Segal et al., section IV.
constexpr double usual_thickness = 0.0316;
// Pairs that tell how much of a motion shows: each within some half, their mean within 2 %.
constexpr std::size_t most_probed = 512, probe_chunk = 128;

// Median over the cloud of the standard deviation along the normal; 0: not told.
double noise_across_m(const PreparedCloud& cloud) {
  std::vector<double> sigmas_m;
  for (std::size_t i = 0; i < cloud.covariances.size(); ++i)
    if (!cloud.normals[i].isZero(0))
      sigmas_m.push_back(std::sqrt(cloud.normals[i].dot(cloud.covariances[i] * cloud.normals[i])));
  return median(std::move(sigmas_m));
}

// Inverse of the covariances' sum of two planes, each spread^2 (1 - n n^T) + noise^2 n n^T: of unit
// normals the sum p and the difference q are orthogonal, so that with k = spread^2 - noise^2 it is
// 2 spread^2 - k (p p^T + q q^T) / 2, whose third principal axis is p x q.
Eigen::Matrix3d information_of_planes(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                      double spread_m, double noise_m) {
  const Eigen::Vector3d p = a + b, q = a - b;
  const double along_m2 = 2 * spread_m * spread_m, k = 0.5 * along_m2 - noise_m * noise_m;
  const double of_p = k / (2 * along_m2 * (along_m2 - 0.5 * k * p.squaredNorm()));
  const double of_q = k / (2 * along_m2 * (along_m2 - 0.5 * k * q.squaredNorm()));
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity() / along_m2;
  information.noalias() += of_p * p * p.transpose();
  information.noalias() += of_q * q * q.transpose();
  return information;
}

// Finds the nearest points of a target to queries that follow one another closely.
template <class S>
class NearestFinder {
 public:
  NearestFinder(const S& search, const PreparedCloud& target) : search_(search), target_(target) {}

  // Brings the match's target up to date with the point's place. Returns its distance, metres.
  double find(const Eigen::Vector3d& moved, Match& match) {
    const std::uint32_t guess = match.target != no_point ? match.target : last_;
    const double gone_m = (moved - match.searched_at.cast<double>()).norm();
    if (match.target != no_point) {
      const double distance_m = (moved - target_.points[match.target]).norm();
      // Kept as float, the place is off by some 2^-24 of its coordinates.
      const double off_m = 0x1p-22 * moved.norm() + 1e-37;
      if ((distance_m + gone_m) * (1 + 1e-12) + off_m < match.others_m) return distance_m;
    }
    if (match.target == no_point || gone_m < target_.spacing_m) {
      search_.k_nearest(moved, 2, found_, guess);
    } else {
      found_.clear();
      if (const auto nearest = search_.nearest(moved, unlimited_m, guess))
        found_.push_back(*nearest);
    }
    if (found_.empty()) {
      match.target = no_point;
      return unlimited_m;
    }
    match.target = last_ = found_[0].index;
    match.searched_at = moved.cast<float>();
    match.others_m = found_.size() > 1 ? as_bound(std::sqrt(found_[1].distance2_m2)) : 0;
    return std::sqrt(found_[0].distance2_m2);
  }

 private:
  static float as_bound(double distance_m) {
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::min((1 - 0x1p-23) * distance_m, largest));
  }

  const S& search_;
  const PreparedCloud& target_;
  std::vector<Neighbour> found_;
  std::uint32_t last_ = no_point;
};

}  // namespace

PairFinder::PairFinder(const PreparedCloud& source, const PreparedCloud& target,
                       const IcpOptions& options)
    : source_(source), target_(target), options_(options) {
  if (options.method != IcpMethod::plane_to_plane) return;
  spread_m_ = std::max(source.spacing_m, target.spacing_m);
  if (!(spread_m_ > 0)) spread_m_ = 1;  // all the same point: any unit will do
  noise_m_ =
      std::max({noise_across_m(source), noise_across_m(target), usual_thickness * spread_m_});
}

void PairFinder::find(const Pose& pose, std::span<const std::uint32_t> sample,
                      std::vector<Match>& matches) const {
  matches.resize(sample.size());
  const double most_m =
      options_.max_pair_distance_m > 0 ? options_.max_pair_distance_m : unlimited_m;
  const double least_cosine = std::cos(options_.max_normal_angle_rad);
  const bool signs = source_.oriented && target_.oriented;
  const bool planes =
      options_.method == IcpMethod::point_to_plane || options_.method == IcpMethod::symmetric;
  const double reach_share =
      options_.method == IcpMethod::point_to_point ? 1 : plane_share_of_reach;
  const auto passes = [&](std::uint32_t i, std::uint32_t j, const Eigen::Vector3d& apart) {
    const Eigen::Vector3d& there = target_.normals[j];
    if (there.isZero(0)) return !planes;
    const Eigen::Vector3d& here = source_.normals[i];
    const double cosine = here.isZero(0) ? 1 : (pose.linear() * here).dot(there);
    if (apart.squaredNorm() < open_m_ * open_m_) return !signs || cosine > 0;
    const double across_m = apart.dot(there), reach_m = reach_share * target_.fits[j].reach_m;
    if (apart.squaredNorm() - across_m * across_m > reach_m * reach_m) return false;
    return (signs ? cosine : std::abs(cosine)) >= least_cosine;
  };
  const auto find_all = [&](const auto& search) {
    parallel_chunks(sample.size(), chunk, [&](std::size_t begin, std::size_t end) {
      NearestFinder finder(search, target_);
      for (std::size_t k = begin; k < end; ++k) {
        const std::uint32_t i = sample[k];
        Match& match = matches[k];
        const Eigen::Vector3d moved = pose * source_.points[i];
        const double distance_m = finder.find(moved, match);
        match.residual_m = unlimited_m;
        if (distance_m <= most_m && match.target != no_point &&
            passes(i, match.target, moved - target_.points[match.target]))
          match.residual_m = residual_m(pose, {i, match.target});
      }
    });
  };
  std::visit(find_all, target_.search);
}

double PairFinder::residual_m(const Pose& pose, const Couple& couple) const {
  const PointPair points = pair(pose, couple);
  switch (options_.method) {
    case IcpMethod::point_to_point:
      return PointToPoint::value(points).norm();
    case IcpMethod::point_to_plane:
      return std::abs(PointToPlane::value(points));
    case IcpMethod::symmetric:
      return std::abs(Symmetric::value(points));
    case IcpMethod::plane_to_plane:
      break;
  }
  const Eigen::Vector3d apart = points.moved - points.target;
  return std::sqrt(apart.dot(metric(pose, couple) * apart));
}

PointPair PairFinder::pair(const Pose& pose, const Couple& couple) const {
  const Eigen::Vector3d& normal = target_.normals[couple.target];
  Eigen::Vector3d own = pose.linear() * source_.normals[couple.source];
  if (own.isZero(0)) own = normal;
  return {pose * source_.points[couple.source], target_.points[couple.target], normal,
          own.dot(normal) < 0 ? Eigen::Vector3d(-own) : own};
}

// Segal et al. 2009, section III.B: known across the surface as the scan tells, along it only that
// the partner is some point nearby. A point without a surface is uncertain to all sides.
Eigen::Matrix3d PairFinder::covariance_m2(const PreparedCloud& cloud, std::uint32_t i) const {
  const Eigen::Vector3d& n = cloud.normals[i];
  Eigen::Matrix3d covariance = spread_m_ * spread_m_ * Eigen::Matrix3d::Identity();
  covariance -= spread_m_ * spread_m_ * n * n.transpose();
  if (cloud.covariances.empty()) return covariance + noise_m_ * noise_m_ * n * n.transpose();
  // Noise below a thousandth of the spacing would only make the sum singular.
  const double least_m2 = 1e-6 * spread_m_ * spread_m_;
  return covariance + cloud.covariances[i] + least_m2 * Eigen::Matrix3d::Identity();
}

// Scaled so that r is the distance where two planes of usual noise lie parallel.
Eigen::Matrix3d PairFinder::metric(const Pose& pose, const Couple& couple) const {
  const Eigen::Matrix3d& turn = pose.linear();
  const Eigen::Vector3d& there = target_.normals[couple.target];
  const Eigen::Vector3d here = turn * source_.normals[couple.source];
  const bool usual = source_.covariances.empty() && target_.covariances.empty();
  if (usual && !there.isZero(0) && !here.isZero(0))
    return 2 * noise_m_ * noise_m_ * information_of_planes(there, here, spread_m_, noise_m_);
  const Eigen::Matrix3d sum = covariance_m2(target_, couple.target) +
                              turn * covariance_m2(source_, couple.source) * turn.transpose();
  return 2 * noise_m_ * noise_m_ * sum.inverse();
}

double PairFinder::shown_share(const Pose& pose, std::span<const Couple> couples,
                               const WelschLoss& loss) const {
  struct Pulled {
    double shown_m = 0, whole_m = 0;
    Pulled& operator+=(const Pulled& other) {
      shown_m += other.shown_m, whole_m += other.whole_m;
      return *this;
    }
  };
  // A loss without a scale is that of squares, which any step tells.
  const double step_m = 0.3 * std::min(loss.scale_m, target_.radius_m);
  const auto pull_m = [&](double residual_m) { return loss.weight(residual_m) * residual_m; };
  const std::size_t stride = std::max<std::size_t>(1, couples.size() / most_probed);
  const auto probe = [&](const auto& search) {
    return [&](std::size_t begin, std::size_t end) {
      Pulled part;
      for (std::size_t k = begin; k < end; ++k) {
        const Couple& couple = couples[k * stride];
        const PointPair points = pair(pose, couple);
        const double across_m = points.normal.dot(points.moved - points.target);
        for (const double off_m : {-step_m, step_m}) {
          const Eigen::Vector3d there = points.moved + off_m * points.normal;
          const auto found = search.nearest(there, unlimited_m, couple.target);
          const double sign = off_m < 0 ? -1 : 1;
          part.shown_m += sign * pull_m(points.normal.dot(there - target_.points[found->index]));
          part.whole_m += sign * pull_m(across_m + off_m);
        }
      }
      return part;
    };
  };
  const std::size_t probed = (couples.size() + stride - 1) / stride;
  const auto sum_by = [&](const auto& search) {
    return ordered_sum(probed, probe_chunk, Pulled{}, probe(search));
  };
  const Pulled sum = std::visit(sum_by, target_.search);
  return sum.whole_m > 0 ? std::clamp(sum.shown_m / sum.whole_m, 0.1, 1.0) : 1;
}

double PairFinder::median_residual_m(std::span<const Match> matches) const {
  std::vector<double> residuals_m;
  residuals_m.reserve(matches.size());
  for (const Match& match : matches)
    if (match.residual_m < unlimited_m) residuals_m.push_back(match.residual_m);
  return median(std::move(residuals_m));
}

double PairFinder::objective_m2(std::span<const Match> matches, const Weighing& weighing) const {
  const double sum_m2 =
      ordered_sum(matches.size(), light_chunk, 0.0, [&](std::size_t begin, std::size_t end) {
        double part_m2 = 0;
        for (std::size_t k = begin; k < end; ++k)
          part_m2 += weighing.loss.rho_m2(std::min(matches[k].residual_m, weighing.limit_m));
        return part_m2;
      });
  return sum_m2 / static_cast<double>(matches.size());
}

std::vector<Couple> PairFinder::kept(std::span<const std::uint32_t> sample,
                                     std::span<const Match> matches,
                                     const Weighing& weighing) const {
  const double most_m = std::min(most_scales * weighing.loss.scale_m, weighing.limit_m);
  std::vector<Couple> couples;
  couples.reserve(matches.size());
  for (std::size_t k = 0; k < matches.size(); ++k)
    if (matches[k].residual_m <= most_m && matches[k].residual_m < unlimited_m)
      couples.push_back({sample[k], matches[k].target, matches[k].residual_m});
  return couples;
}

}  // namespace scan
