// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The planner's bounds for the laser line's noises against the scatter of decoded ranges.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/validation/effect_bounds.h"
#include "tests/validation/laser_scans.h"

namespace scan::synth {
namespace {

// Noises are bounded by three sigma of the weakest row; so is their root mean square over 3600
// rows, uncertain by 1.2 %.
class LaserNoiseBound : public testing::TestWithParam<Effect> {};

TEST_P(LaserNoiseBound, IsThreeSigma) {
  LaserLine s = small_laser();
  s.steps = 30;
  s.step_m = 1e-3;
  s.stage_direction = {0, 1, 0};
  s.beam_radius_m = 2e-3;
  s.sensor = {
      .gain_e_per_dn = 0.2, .offset_dn = 2000, .read_noise_e = 30, .full_well_e = 1e9, .bits = 16};
  s.aperture_m = 2e-3;
  s.speckle_contrast = 0.5;
  s.ambient_electrons = 400;
  const Scene scene = white_scene({plane_at(focus_z(s))});
  EffectSet others = noise_free;
  if (GetParam() == Effect::scene_lights) others.set(Effect::shot_noise);
  const auto clean = decoded(s, scene, noise_free).range_m;
  const Differences with =
      differences(decoded(s, scene, EffectSet(others).set(GetParam())).range_m, clean);
  const double without = differences(decoded(s, scene, others).range_m, clean).rms;
  ASSERT_GT(with.count, 3000);
  const double three_m = 3 * std::sqrt(with.rms * with.rms - without * without);
  expect_met(std::string(name(GetParam())).c_str(),
             {three_m * 0.95, three_m * 1.05, static_cast<int>(with.count)},
             bound_m(s, scene, GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, LaserNoiseBound,
                         testing::Values(Effect::shot_noise, Effect::read_noise, Effect::speckle,
                                         Effect::scene_lights),
                         [](const auto& effect) {
                           std::string word(name(effect.param));
                           std::replace(word.begin(), word.end(), ' ', '_');
                           return word;
                         });

}  // namespace
}  // namespace scan::synth
