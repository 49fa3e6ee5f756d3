// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera at its limits: full wells, empty space, fields that cannot be.
#include "synth/scanners/phase_camera.h"
#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

TEST(PhaseCamera, SaturatesAtTheFullWell) {
  PhaseCamera camera = small_camera();
  camera.sensor.full_well_e = 3000;
  const Scene scene{.objects = {plane_at(0.5)}, .materials = {plain(0.9)}};
  const PhaseTaps frames = taps_of(camera, scene, noise_free);
  for (const auto& tap : frames.taps[0])
    EXPECT_LE(*std::max_element(tap.pixels.begin(), tap.pixels.end()), 3000);
}

TEST(PhaseCamera, SeesNothingInTheVoid) {
  PhaseCamera camera = small_camera();
  camera.ambient_electrons = 500;
  camera.sensor.offset_dn = 7;
  for (const auto& set : taps_of(camera, Scene{}, noise_free).taps)
    for (const auto& tap : set)
      for (const std::uint16_t dn : tap.pixels) EXPECT_EQ(dn, 7);
  for (const RayTruth& ray : true_rays(camera, RayCaster(Scene{}), Pose::Identity()))
    EXPECT_EQ(ray.object, -1);
}

TEST(PhaseCamera, NamesTheFieldThatIsWrong) {
  EXPECT_EQ(complaint(small_camera()), "");
  const auto with = [](auto change) {
    PhaseCamera camera = small_camera();
    change(camera);
    return complaint(camera);
  };
  EXPECT_EQ(with([](auto& c) { c.frequencies_hz = {}; }),
            "phase_camera/frequencies_hz (count): 0, must be positive and finite");
  EXPECT_EQ(with([](auto& c) {
              c.frequencies_hz = {80e6, -1};
            }),
            "phase_camera/frequencies_hz: -1, must be positive and finite");
  EXPECT_EQ(with([](auto& c) { c.contrast = 1.5; }),
            "phase_camera/contrast: 1.5, must be from 0 to 1");
  EXPECT_EQ(with([](auto& c) { c.sub_rays = 100; }),
            "phase_camera/sub_rays: 100, must be from 1 to 64");
  EXPECT_EQ(with([](auto& c) { c.sensor.gain_e_per_dn = 0; }),
            "phase_camera/sensor.gain_e_per_dn: 0, must be positive and finite");
  EXPECT_EQ(with([](auto& c) { c.emitter_offset_m = std::nan(""); }),
            "phase_camera/emitter_offset_m: nan, must be finite");
  EXPECT_EQ(with([](auto& c) {
              c.harmonics = {0.3, -0.3};
            }),
            "phase_camera/harmonics (sum of absolute values): 0.6, must be from 0 to 0.5");
  EXPECT_EQ(with([](auto& c) { c.tap_interval_s = -1; }),
            "phase_camera/tap_interval_s: -1, must be from 0 to 1");
  EXPECT_EQ(with([](auto& c) { c.velocity_m_s.y() = INFINITY; }),
            "phase_camera/velocity_m_s: inf, must be finite");
  EXPECT_EQ(with([](auto& c) { c.angular_velocity_rad_s.x() = NAN; }),
            "phase_camera/angular_velocity_rad_s: nan, must be finite");
  EXPECT_EQ(with([](auto& c) { c.vignetting = 2; }),
            "phase_camera/vignetting: 2, must be from 0 to 1");
  EXPECT_EQ(with([](auto& c) { c.aperture_m = -0.1; }),
            "phase_camera/aperture_m: -0.1, must be from 0 to 1");
  EXPECT_EQ(with([](auto& c) { c.focus_m = 0; }),
            "phase_camera/focus_m: 0, must be positive and finite");
  EXPECT_EQ(with([](auto& c) { c.range_offset_m = NAN; }),
            "phase_camera/range_offset_m: nan, must be finite");
  EXPECT_EQ(with([](auto& c) { c.pixel_offset_m = 2; }),
            "phase_camera/pixel_offset_m: 2, must be from 0 to 1");
  EXPECT_EQ(with([](auto& c) { c.electrons_per_w_m2 = -1; }),
            "phase_camera/electrons_per_w_m2: -1, must be from 0 to 1e+09");
  EXPECT_NE(with([](auto& c) { c.camera.fx_px = 0; }).find("fx_px"), std::string::npos);
  EXPECT_NE(with([](auto& c) { c.max_range_m = 0; }).find("max_range_m: 0"), std::string::npos);
  EXPECT_NE(with([](auto& c) { c.electrons_at_1m = -5; }).find("electrons_at_1m: -5"),
            std::string::npos);
}

}  // namespace
}  // namespace scan::synth
