// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_pairs.h"

#include <algorithm>
#include <cmath>

#include "libscan/align/loss.h"
#include "libscan/align/pose_step.h"

namespace scan {
namespace {

// The loss's scale in median residuals. The last one keeps 95 % of the efficiency of least squares
// on normal noise, 2.11 sigma (Holland and Welsch 1977): what has no partner the pairs have
// settled.
constexpr double first_scale = 3, last_scale = 1.5;
constexpr double narrowing = 0.7;
constexpr std::size_t least_pairs = 6;

std::vector<std::uint32_t> sample_of(const JointCouple& couple, const PreparedCloud& source) {
  std::vector<std::uint32_t> sample;
  for (std::uint32_t i = 0; i < source.size(); ++i)
    if (source.index[i] % couple.stride == couple.first) sample.push_back(i);
  return sample;
}

double last_scale_m(double median_m, const PreparedCloud& target) {
  return std::max(last_scale * median_m, 1e-15 * target.radius_m + 1e-150);
}

// Of the couple's form, on the way to the last one.
double scale_m(const JointCouple& couple, double last_m) {
  if (couple.scale_m == unlimited_m)
    return std::max(first_scale / last_scale * last_m, couple.first_m);
  return std::min(std::max(last_m, narrowing * couple.scale_m), couple.scale_m);
}

// The last scale is that many sigmas of normal noise.
double squared_size_in_sigmas(const DataFrame& frame, const WelschLoss& loss) {
  const double sigma_m = sigma_from_median / last_scale * loss.scale_m;
  return frame.size_m * frame.size_m / (sigma_m * sigma_m);
}

// From the target's local axes to the world's.
Matrix6 turned(const Pose& world_from_target) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = world_from_target.linear();
  return turn;
}

std::array<std::int64_t, 3> place_of(const Eigen::Vector3d& point, double side_m) {
  std::array<std::int64_t, 3> place;
  for (int i = 0; i < 3; ++i)
    place[std::size_t(i)] = static_cast<std::int64_t>(std::floor(point[i] / side_m));
  return place;
}

JointDetail detail_of(const PairFinder& finder, const Pose& pose, const Pose& world_from_target,
                      std::span<const Couple> couples, const WelschLoss& loss,
                      const DataFrame& local, double patch_m) {
  JointDetail detail;
  const Matrix6 turn = turned(world_from_target);
  const double unit = squared_size_in_sigmas(local, loss);
  for (const Couple& couple : couples) {
    const Pull pull = pull_of(finder, pose, couple, loss, local);
    detail.curvature += unit * pull.curvature;
    const Eigen::Vector3d point = world_from_target * finder.target().points[couple.target];
    detail.pulls.push_back({place_of(point, patch_m), unit * turn * pull.gradient});
    detail.paired.push_back(couple.source);
  }
  detail.curvature *= finder.shown_share(pose, couples, loss);
  detail.curvature = (turn * detail.curvature * turn.transpose()).eval();
  std::stable_sort(detail.pulls.begin(), detail.pulls.end(),
                   [](const PatchPull& a, const PatchPull& b) { return a.place < b.place; });
  std::vector<PatchPull> merged;
  for (const PatchPull& pull : detail.pulls) {
    if (merged.empty() || merged.back().place != pull.place)
      merged.push_back(pull);
    else
      merged.back().gradient += pull.gradient;
  }
  detail.pulls = std::move(merged);
  return detail;
}

}  // namespace

std::vector<JointCouple> joint_couples(
    std::span<const std::pair<std::size_t, std::size_t>> overlapping, std::size_t scans,
    std::size_t most_partners) {
  std::vector<std::size_t> partners(scans, 0), rank(scans, 0);
  for (const auto& [i, j] : overlapping) ++partners[i], ++partners[j];
  std::vector<JointCouple> couples;
  const auto add = [&](std::size_t source, std::size_t target) {
    const std::size_t stride = (partners[source] + most_partners - 1) / most_partners;
    couples.push_back(
        {.source = source, .target = target, .stride = stride, .first = rank[source]++ % stride});
  };
  for (const auto& [i, j] : overlapping) add(i, j), add(j, i);
  return couples;
}

JointForm joint_form(const JointCouple& couple, const PreparedCloud& source,
                     const PreparedCloud& target, const Pose& world_from_source,
                     const Pose& world_from_target, const IcpOptions& options, double patch_m,
                     JointDetail* detail, const std::vector<bool>& target_rim) {
  const Pose pose = world_from_target.inverse() * world_from_source;
  const std::vector<std::uint32_t> sample = sample_of(couple, source);
  JointForm form{.source = couple.source, .target = couple.target, .asked = sample.size()};
  const PairFinder finder(source, target, options);
  std::vector<Match> matches;
  finder.find(pose, sample, matches);
  const double last_m = last_scale_m(finder.median_residual_m(matches), target);
  const WelschLoss loss{scale_m(couple, last_m)};
  form.scale_m = loss.scale_m;
  form.narrowing = loss.scale_m > last_m;
  std::vector<Couple> couples = finder.kept(sample, matches, {.loss = loss});
  if (!target_rim.empty())
    std::erase_if(couples, [&](const Couple& one) { return target_rim[one.target]; });
  const auto least = std::max<double>(least_pairs, options.min_overlap * double(sample.size()));
  if (static_cast<double>(couples.size()) < least) return form;
  form.pairs = couples.size();
  form.rms_m = rms_m(couples, loss);
  const DataFrame local = frame_of(finder, pose, couples);
  form.frame = {world_from_target * local.centre, local.size_m};
  const NormalEquations sums = normal_equations(finder, pose, couples, loss, local);
  // By the mean of both normals, which errs the least.
  IcpOptions by_mean = options;
  by_mean.method = IcpMethod::symmetric;
  const MotionInformation planes = motion_information(PairFinder(source, target, by_mean), pose,
                                                      couples, local, NormalErrors::between_scans);
  const Matrix6 turn = turned(world_from_target);
  const double unit = squared_size_in_sigmas(local, loss);
  form.a = unit * turn * sums.a * turn.transpose();
  form.b = unit * turn * sums.b;
  form.apparent = turn * planes.apparent() * turn.transpose();
  form.noise = turn * planes.noise() * turn.transpose();
  if (detail) *detail = detail_of(finder, pose, world_from_target, couples, loss, local, patch_m);
  return form;
}

}  // namespace scan
