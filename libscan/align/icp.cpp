// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/icp.h"

#include <algorithm>

#include "libscan/align/icp_iteration.h"
#include "libscan/core/error.h"

namespace scan {
namespace {

void check_guess(const Pose& guess) {
  if (!guess.matrix().allFinite())
    throw Error(Trouble::input, "icp: target_from_source_guess is not finite");
}

}  // namespace

IcpResult icp(const PreparedCloud& source, const PreparedCloud& target,
              const Pose& target_from_source_guess, const IcpOptions& options) {
  const Stopwatch watch;
  check(options);
  check_guess(target_from_source_guess);
  IcpResult result;
  const Eigen::Matrix3d& given = target_from_source_guess.linear();
  result.target_from_source = with_proper_rotation(target_from_source_guess);
  result.guess_off_rotation = (given - result.target_from_source.linear()).norm();
  result.invalid_points = source.invalid_points + target.invalid_points;
  if (std::min(source.size(), target.size()) >= least_pairs)
    IcpIteration(source, target, options).run(result.target_from_source, result);
  result.cost.seconds = watch.seconds();
  return result;
}

IcpResult icp(const PointCloud& source, const PointCloud& target,
              const Pose& target_from_source_guess, const IcpOptions& options) {
  const Stopwatch watch;
  check(options);
  check_guess(target_from_source_guess);
  const PrepareOptions preparation{.search = options.search};
  const auto [prepared_source, prepared_target] = prepare_pair(source, target, preparation);
  IcpResult result = icp(prepared_source, prepared_target, target_from_source_guess, options);
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
