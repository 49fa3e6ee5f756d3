// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A small laser-line scanner before white targets.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "synth/scanners/laser_line_optics.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

inline constexpr double theta = 0.5;

inline LaserLine small_laser() {
  return {.camera = {160, 120, 300, 300, 79.5, 59.5},
          .baseline_m = 0.1,
          .triangulation_rad = theta,
          .fan_rad = 0.8,
          .steps = 1,
          .sensor = {}};
}

inline double focus_z(const LaserLine& s) {
  return s.baseline_m / std::tan(s.triangulation_rad);
}

inline Scene white_scene(std::vector<Object> objects) {
  return {std::move(objects), {plain(1)}};
}

// Of a scanner at the world's origin.
inline Image<std::uint16_t> first_image(const LaserLine& s, const RayCaster& caster,
                                        const EffectSet& effects) {
  const Rendering rendering = render(s, caster, Pose::Identity(), {}, effects);
  return std::get<StripeImages>(rendering.frames).images[0];
}

// A camera at the world's origin with its sheet.
struct Bench {
  LaserLine scanner;
  LaserSheet sheet;
  RayCaster caster;
  LaserView view;
  Bench(const LaserLine& s, const Scene& scene)
      : scanner(s),
        sheet(laser_sheet(scanner)),
        caster(scene),
        view{scanner, sheet, caster, Pose::Identity()} {}
  double electrons(double column, double row) const {
    return view.light({.direction = ray_through(scanner.camera, {column, row})->normalized()})
        .laser_e;
  }
};

}  // namespace scan::synth
