// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "synth/bsdf/kinds.h"
#include "synth/sampling/warp.h"

namespace scan::synth {

double evaluate(const Lambert& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  return is_above(out, in) ? bsdf.albedo / std::numbers::pi : 0;
}

double density(const Lambert& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  return is_above(out, in) && bsdf.albedo > 0 ? cosine_hemisphere_density(in) : 0;
}

std::optional<BsdfSample> sample(const Lambert& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u) {
  const Eigen::Vector3d in = to_cosine_hemisphere(u.tail<2>());
  if (!is_above(out, in) || !(bsdf.albedo > 0)) return std::nullopt;
  return BsdfSample{.in = in, .weight = bsdf.albedo, .density = cosine_hemisphere_density(in)};
}

double albedo(const Lambert& bsdf, const Eigen::Vector3d& in) {
  return is_above(in) ? bsdf.albedo : 0;
}

}  // namespace scan::synth
