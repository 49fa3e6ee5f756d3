// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/scan_pairs.h"

#include <algorithm>
#include <cmath>

#include "libscan/align/loss.h"
#include "libscan/align/residual.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

// One direction: partners in `target` for the points of `source`.
struct DirectedPairs {
  std::size_t source = 0, target = 0;
  std::vector<std::uint32_t> from, to;
};

DirectedPairs find_partners(const PreparedScan& source, const Pose& from_source,
                            const PreparedScan& target, const Pose& from_target,
                            const JointGates& gates) {
  const Pose target_from_source = from_target.inverse() * from_source;
  DirectedPairs pairs;
  for (std::uint32_t i = 0; i < source.cloud.size(); ++i) {
    const auto found =
        target.search.nearest(target_from_source * source.cloud.points[i], gates.distance_m);
    if (!found) continue;
    const Eigen::Vector3d& normal = target.cloud.normals[found->index];
    const Eigen::Vector3d turned = target_from_source.linear() * source.cloud.normals[i];
    if (normal.isZero() || (!turned.isZero() && turned.dot(normal) < gates.least_cosine)) continue;
    pairs.from.push_back(i);
    pairs.to.push_back(found->index);
  }
  return pairs;
}

class Round {
 public:
  Round(const std::vector<std::unique_ptr<PreparedScan>>& scans, const std::vector<Pose>& poses,
        const DataFrame& frame, const JointGates& gates)
      : scans_(scans), poses_(poses), frame_(frame), gates_(gates) {}

  JointPairs run(const std::vector<ScanCouple>& couples);

 private:
  void find_all(const std::vector<ScanCouple>& couples);
  std::vector<ScanCouple> drop_small_overlaps();
  PointPair pair(const DirectedPairs& pairs, std::size_t k) const;
  double median_residual_m() const;
  ScanPairForm form_of(const DirectedPairs& pairs, double tukey_limit_m) const;
  void withhold_weak(const DirectedPairs& pairs, ScanPairForm& form) const;
  void summarise(JointPairs& result) const;

  const std::vector<std::unique_ptr<PreparedScan>>& scans_;
  const std::vector<Pose>& poses_;
  const DataFrame& frame_;
  const JointGates& gates_;
  std::vector<DirectedPairs> directed_;  // (i, j) and (j, i) side by side
};

void Round::find_all(const std::vector<ScanCouple>& couples) {
  for (const auto& [i, j] : couples) {
    directed_.push_back({i, j, {}, {}});
    directed_.push_back({j, i, {}, {}});
  }
  parallel_for(
      directed_.size(),
      [&](std::size_t k) {
        const auto [source, target] = std::pair(directed_[k].source, directed_[k].target);
        directed_[k] =
            find_partners(*scans_[source], poses_[source], *scans_[target], poses_[target], gates_);
        directed_[k].source = source;
        directed_[k].target = target;
      },
      1);
}

// Returns the couples with at least half of the least overlap.
std::vector<ScanCouple> Round::drop_small_overlaps() {
  std::vector<DirectedPairs> kept;
  std::vector<ScanCouple> hopeful;
  const auto share = [&](const DirectedPairs& pairs) {
    return static_cast<double>(pairs.from.size()) /
           static_cast<double>(scans_[pairs.source]->cloud.size());
  };
  for (std::size_t k = 0; k < directed_.size(); k += 2) {
    const double overlap = std::max(share(directed_[k]), share(directed_[k + 1]));
    if (overlap >= gates_.min_overlap / 2)
      hopeful.emplace_back(directed_[k].source, directed_[k].target);
    if (overlap < gates_.min_overlap) continue;
    kept.push_back(std::move(directed_[k]));
    kept.push_back(std::move(directed_[k + 1]));
  }
  directed_ = std::move(kept);
  return hopeful;
}

PointPair Round::pair(const DirectedPairs& pairs, std::size_t k) const {
  const PointCloud& source = scans_[pairs.source]->cloud;
  const PointCloud& target = scans_[pairs.target]->cloud;
  return {poses_[pairs.source] * source.points[pairs.from[k]],
          poses_[pairs.target] * target.points[pairs.to[k]],
          poses_[pairs.target].linear() * target.normals[pairs.to[k]]};
}

double Round::median_residual_m() const {
  std::vector<double> residuals;
  for (const DirectedPairs& pairs : directed_)
    for (std::size_t k = 0; k < pairs.from.size(); ++k)
      residuals.push_back(std::abs(PointToPlane::value(pair(pairs, k))));
  if (residuals.empty()) return 0;
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return *middle;
}

ScanPairForm Round::form_of(const DirectedPairs& pairs, double tukey_limit_m) const {
  ScanPairForm form{.source = pairs.source, .target = pairs.target, .pairs = pairs.from.size()};
  const TukeyLoss loss{tukey_limit_m};
  for (std::size_t k = 0; k < pairs.from.size(); ++k) {
    const PointPair points = pair(pairs, k);
    const double residual_m = PointToPlane::value(points);
    const double weight = loss.weight(residual_m);
    Vector6 row = PointToPlane::jacobian(points, frame_.centre).transpose();
    row.head<3>() /= frame_.size_m;
    form.a += weight * row * row.transpose();
    form.b -= weight * row * (residual_m / frame_.size_m);
    form.squares_m2 += weight * residual_m * residual_m;
    form.weights += weight;
  }
  return form;
}

void Round::withhold_weak(const DirectedPairs& pairs, ScanPairForm& form) const {
  const PreparedScan& target = *scans_[pairs.target];
  // In the target's own frame, where its fits are kept; then carried over to the shared frame.
  const Pose& pose = poses_[pairs.target];
  const DataFrame own{pose.inverse() * frame_.centre, frame_.size_m};
  TwistBasis weak =
      weak_motions(pairs.to, target.cloud.points, target.cloud.normals, target.fits, own);
  if (weak.cols() == 0) return;
  weak.topRows<3>() = (pose.linear() * weak.topRows<3>()).eval();
  weak.bottomRows<3>() = (pose.linear() * weak.bottomRows<3>()).eval();
  const Matrix6 projector = complement_projector(weak);
  form.a = (projector * form.a * projector).eval();
  form.b = (projector * form.b).eval();
}

void Round::summarise(JointPairs& result) const {
  std::vector<double> squares(scans_.size(), 0), weights(scans_.size(), 0);
  std::vector<std::vector<bool>> paired;
  for (const auto& scan : scans_) paired.emplace_back(scan->cloud.size(), false);
  for (std::size_t k = 0; k < directed_.size(); ++k) {
    for (const std::size_t scan : {directed_[k].source, directed_[k].target}) {
      squares[scan] += result.forms[k].squares_m2;
      weights[scan] += result.forms[k].weights;
    }
    for (const std::uint32_t i : directed_[k].from) paired[directed_[k].source][i] = true;
  }
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const auto count = static_cast<double>(std::count(paired[i].begin(), paired[i].end(), true));
    result.paired_fraction.push_back(
        paired[i].empty() ? 0 : count / static_cast<double>(paired[i].size()));
    result.rms_m.push_back(weights[i] > 0 ? std::sqrt(squares[i] / weights[i]) : 0);
  }
}

JointPairs Round::run(const std::vector<ScanCouple>& couples) {
  find_all(couples);
  JointPairs result;
  result.couples = drop_small_overlaps();
  const double fresh_m = tukey_limit_in_sigmas * sigma_from_median * median_residual_m();
  result.tukey_limit_m =
      std::max(gates_.tukey_limit_m > 0 ? std::min(fresh_m, gates_.tukey_limit_m) : fresh_m,
               1e-14 * frame_.size_m);
  result.forms.resize(directed_.size());
  parallel_for(
      directed_.size(),
      [&](std::size_t k) { result.forms[k] = form_of(directed_[k], result.tukey_limit_m); }, 1);
  for (std::size_t k = 0; k < directed_.size(); ++k) withhold_weak(directed_[k], result.forms[k]);
  summarise(result);
  return result;
}

}  // namespace

PreparedScan::PreparedScan(PointCloud thinned)
    : cloud(std::move(thinned)),
      search(cloud.points),
      fits(local_fits(cloud.points, search, 16)),
      spacing_m(scan::spacing_m(cloud.points, search)) {}

JointPairs pair_scans(const std::vector<std::unique_ptr<PreparedScan>>& scans,
                      const std::vector<Pose>& poses, const std::vector<ScanCouple>& couples,
                      const DataFrame& frame, const JointGates& gates) {
  return Round(scans, poses, frame, gates).run(couples);
}

}  // namespace scan
