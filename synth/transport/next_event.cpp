// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/next_event.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {

double share_that_arrives(Path& path, const Vertex& vertex, const Connection& way,
                          const Eigen::Vector3d& light) {
  const Medium* outside = path.outside();
  if (!outside) return 1;
  if (std::holds_alternative<Homogeneous>(outside->density))
    return std::exp(-extinction_per_m(*outside) * way.open_m);
  double share = 1;
  Eigen::Vector3d from = vertex.hit.point;
  for (int i = 0; i <= way.bounces; ++i) {
    const Eigen::Vector3d& to = i < way.bounces ? way.bends[i] : light;
    share *= transmittance(*outside, from, to, path.random);
    from = to;
  }
  return share;
}

double chance_to_connect(const Path& path, const Vertex& vertex, const Eigen::Vector3d& light) {
  const Eigen::Vector3d to_light = light - vertex.hit.point;
  const double length_m = to_light.norm();
  const Eigen::Vector3d direction = to_light / length_m;
  const auto exit = path.caster().closest(vertex.hit.point, direction, 0, length_m);
  const ObjectOptics& body = *path.around.body();
  if (!exit || &path.transport.optics(exit->object) != &body) return 1;
  if (!body.is_smooth) return 0;  // its surface is reached by walking
  // as if the surface were flat there: the way out is refracted towards its normal
  const double cosine = std::abs(exit->normal.dot(direction));
  const double sine = std::sqrt(1 - std::min(1.0, cosine * cosine)) / body.index;
  const double way_m = exit->distance_m * cosine / std::sqrt(1 - std::min(0.99, sine * sine));
  return std::clamp(4 * std::exp(-extinction_per_m(*body.interior) * way_m), 0.01, 1.0);
}

}  // namespace scan::synth
