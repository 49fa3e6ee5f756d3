// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Every kind of surface with its limits and its middle, and directions to look from.
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "libscan/core/random.h"
#include "synth/bsdf/bsdf.h"
#include "tests/synth/goodness.h"

namespace scan::synth {

inline constexpr Microfacets ggx = Microfacets::ggx, beckmann = Microfacets::beckmann;

struct Named {
  std::string name;
  Bsdf bsdf;
};

// Every kind, its limits and its middle.
inline std::vector<Named> kinds() {
  return {{"black", Lambert{0}},
          {"grey", Lambert{0.5}},
          {"white", Lambert{1}},
          {"smooth clay", OrenNayar{0.6, 0}},
          {"clay", OrenNayar{0.95, 0.3}},
          {"rubble", OrenNayar{0.5, 1.2}},
          {"mirror", Conductor{0.14, 3.7, 0}},
          {"polished", Conductor{2.9, 3.1, 0.05, ggx}},
          {"ground", Conductor{2.9, 3.1, 0.3, ggx}},
          {"blasted", Conductor{1.4, 7.4, 0.6, beckmann}},
          {"perfect", Conductor{0.001, 100, 0.5, ggx}},
          {"pane", Dielectric{1.5, 0}},
          {"no boundary", Dielectric{1, 0.3}},
          {"etched", Dielectric{1.5, 0.15, ggx}},
          {"frosted", Dielectric{1.33, 0.4, beckmann}},
          {"diamond dust", Dielectric{2.4, 0.7, ggx}},
          {"gloss", Plastic{0.7, 1.5, 0}},
          {"satin", Plastic{0.4, 1.5, 0.15, ggx}},
          {"matt", Plastic{1, 1.6, 0.5, beckmann}},
          {"coat on black", Plastic{0, 1.5, 0.3, ggx}}};
}

inline std::vector<Eigen::Vector3d> views(const Bsdf& bsdf) {
  std::vector<Eigen::Vector3d> all;
  for (const double cosine : {1.0, 0.8, 0.4, 0.1})
    for (const double side : {1.0, -1.0})
      if (side > 0 || is_transmissive(bsdf)) all.push_back(direction_at(side * cosine, 0.4));
  return all;
}

inline Eigen::Vector3d draw3(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {x, y, z};
}

inline Eigen::Vector3d draw_direction(RandomStream& random, bool below_too) {
  const double cosine = below_too ? 2 * random.uniform() - 1 : random.uniform();
  return direction_at(cosine, 2 * std::numbers::pi * random.uniform());
}
}  // namespace scan::synth
