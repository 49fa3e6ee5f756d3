// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How much an effect can move a range: what the planner asks each scanner.
//
// For each scanner two functions, in synth/effects/pilot_<scanner>.cpp and weigh_<scanner>.cpp:
//   pilot(): a few thousand of the scanner's rays, spread over a view, with what they meet;
//   weigh(): the bound of one effect, from closed forms of the scanner's physics at those rays.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "synth/effects/effect.h"
#include "synth/scanner.h"

namespace scan::synth {

// An effect is included if it can move some pilot ray by this share of the scanner's own sigma:
// five effects left out together stay below a tenth of it.
inline constexpr double negligible_sigma = 0.02;

struct PilotRay {
  double range_m = 0;
  double sigma_m = 0;         // the scanner's own 1 sigma there: shot, read and rounding noise
  double signal_e = 0;        // peak reading by the device's light, direct
  double incidence_rad = 0;   // between ray and normal
  double range_spread_m = 0;  // largest minus smallest range within the footprint
  // Light of the device over two or more scatterings or over smooth surfaces, by a few paths: its
  // share of the direct light with three standard errors added, and the mean one-way extra length.
  double indirect_share = 0;
  double indirect_extra_m = 0;
  bool met_smooth = false;  // a mirror or clear body stands in the way of ray or light
  // Range error if an effect is left out, where the pilot itself found it.
  std::array<double, effect_count> left_out_m{};
};

std::vector<PilotRay> pilot(const LaserLine& scanner, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays);
std::vector<PilotRay> pilot(const StereoPair& scanner, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays);
std::vector<PilotRay> pilot(const PhaseCamera& scanner, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays);
std::vector<PilotRay> pilot(const PulsedLidar& scanner, const RayCaster& caster,
                            const Pose& world_from_scanner, int rays);

struct Weight {
  double bound_m = 0;      // range error at most, over all pilot rays, if the effect is left out
  double bound_sigma = 0;  // largest of bound over the ray's own sigma
  std::string why;         // half a sentence with the figures: "the beam is 0.3 mm wide at 12 m"
};

// None if the scanner or the scene has nothing of the kind: then `why_absent` says so in half a
// sentence ("the light plane is exactly plane").
struct Weighed {
  std::optional<Weight> weight;
  std::string why_absent;
};
Weighed weigh(const LaserLine& scanner, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays);
Weighed weigh(const StereoPair& scanner, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays);
Weighed weigh(const PhaseCamera& scanner, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays);
Weighed weigh(const PulsedLidar& scanner, const Scene& scene, Effect effect,
              std::span<const PilotRay> rays);

}  // namespace scan::synth
