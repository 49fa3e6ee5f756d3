// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/echo_light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace scan::synth {
namespace {

constexpr int paths_per_ray = 32;

// Sums over paths.
struct PilotLight {
  double range_m = 0, window_m = 0, known_m = 0;
  EchoLight sums = {};

  void device_light(double electrons, double path_m, int scatterings) {
    if (scatterings == 1 && path_m <= known_m) return;
    const double extra_m = std::max(path_m / 2 - range_m, 0.0);
    sums.indirect_e += electrons;
    sums.extra_e_m += electrons * extra_m;
    if (scatterings > 1 && extra_m <= window_m) sums.late_e_m += electrons * extra_m;
  }
  void other_light(double electrons) { sums.lamps_e += electrons; }
};

using Streams = std::array<PilotLight, 4>;

// Mean of one of its sums over paths with three standard errors, from the scatter of the streams.
double at_most(const Streams& streams, double EchoLight::*sum) {
  double mean = 0, scatter = 0;
  for (const PilotLight& stream : streams) mean += stream.sums.*sum / 4;
  for (const PilotLight& stream : streams) scatter += std::pow(stream.sums.*sum - mean, 2);
  return (mean + 3 * std::sqrt(scatter / 12)) / (paths_per_ray / 4.0);
}

}  // namespace

EchoLight echo_light(const PulsedLidar& scanner, const LightTransport& transport,
                     const Pose& world_from_scanner, const Eigen::Vector3d& direction,
                     std::size_t index, double range_m, double half_window_m) {
  const RayCaster& caster = transport.caster();
  const BeamLight light = beam_light(scanner, caster, world_from_scanner, direction);
  Streams streams;
  for (std::uint32_t k = 0; k < streams.size(); ++k) {
    SampleSequence random(1, 0, index, k);
    streams[k] = {.range_m = range_m, .window_m = half_window_m};
    for (int i = 0; i < paths_per_ray / 4; ++i) {
      random.start(i);
      const Ray view{.origin = light.origin, .direction = light.view(random.next_2d())};
      streams[k].known_m = straight_way_m(caster, view);
      trace_path(transport, view, light, random, streams[k]);
    }
  }
  return {.indirect_e = at_most(streams, &EchoLight::indirect_e),
          .extra_e_m = at_most(streams, &EchoLight::extra_e_m),
          .late_e_m = at_most(streams, &EchoLight::late_e_m),
          .lamps_e = at_most(streams, &EchoLight::lamps_e)};
}

}  // namespace scan::synth
