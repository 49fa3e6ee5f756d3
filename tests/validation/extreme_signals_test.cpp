// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Almost no light, far too much of it, and images of one pixel or one row.
#include "libscan/acquire/reason.h"
#include "tests/synth/scanner_scenes.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

PhaseCamera phase_camera() {
  PhaseCamera s;
  s.camera = {
      .width_px = 60, .height_px = 40, .fx_px = 80, .fy_px = 80, .cx_px = 29.5, .cy_px = 19.5};
  s.frequencies_hz = {16e6, 80e6, 120e6};
  return s;
}

PulsedLidar lidar() {
  PulsedLidar s;
  s.pattern = RasterPattern{.rows = 40, .columns = 60, .height_rad = 0.3, .width_rad = 0.4};
  s.max_range_m = 20;
  return s;
}

Scene facing(double z_m) {
  return {.objects = {plane_at(z_m)}, .materials = {plain(0.5)}};
}

template <class Device>
Scan scan_of(const Device& device, const Scene& scene, const EffectSet& effects = sensor_effects) {
  return acquire(
      render(device, RayCaster(scene), Pose::Identity(), {.seed = 3, .scan = 0}, effects).frames);
}

std::size_t missed(const Scan& scan, std::string_view why) {
  const auto found = scan.misses.find(std::string(why));
  return found == scan.misses.end() ? 0 : found->second;
}

// Every ray is a finite point with a positive sigma or is counted under a reason.
void expect_complete(const Scan& scan, std::size_t rays) {
  std::size_t misses = 0;
  for (const auto& [why, count] : scan.misses) misses += count;
  EXPECT_EQ(scan.cloud.size() + misses, rays);
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    EXPECT_TRUE(scan.cloud.points[i].allFinite());
    EXPECT_GT(scan.cloud.sigma_m[i], 0);
    EXPECT_TRUE(std::isfinite(scan.cloud.sigma_m[i]));
  }
}

// 0, 1 or 2 electrons in a tap: a phase exists now and then, confidence in it hardly ever. One
// pixel passes if each of its three amplitudes exceeds 5 of its sigmas, which a few electrons
// cannot.
TEST(FewPhotons, GiveNoSignalToThePhaseCamera) {
  for (const double electrons : {0.0, 0.1, 1.0, 2.0}) {
    PhaseCamera s = phase_camera();
    s.electrons_at_1m = 2 * electrons;  // of a grey target
    const Scan scan = scan_of(s, facing(1));
    expect_complete(scan, 60 * 40);
    EXPECT_EQ(missed(scan, reason::no_signal), 60u * 40u) << electrons;
  }
}

// An echo of a few electrons, no ambient light: rejected or a point with an honest sigma.
TEST(FewPhotons, GiveTheLidarNothingOrAnHonestPoint) {
  for (const double electrons : {0.0, 1.0, 3.0}) {
    PulsedLidar s = lidar();
    s.electrons_at_10m = 2 * electrons;
    s.ambient_electrons = 0;
    const Scan scan = scan_of(s, facing(10));
    expect_complete(scan, 60 * 40);
    if (electrons == 0) {
      EXPECT_TRUE(scan.cloud.empty());
    }
    // A single electron places the pulse within its sigma, c / 2 * 1.5 ns = 0.22 m; 5 of them.
    for (const auto& point : scan.cloud.points)
      EXPECT_NEAR(point.norm(), 10 / point.normalized().z(), 1.1);
  }
}

// Ten times the full well: no biased peak passes as a measurement.
TEST(Saturation, IsReportedInsteadOfARange) {
  PhaseCamera phase = phase_camera();
  phase.electrons_at_1m = 40000;
  phase.sensor.full_well_e = 2000;
  EXPECT_EQ(missed(scan_of(phase, facing(1)), reason::saturated), 60u * 40u);

  PulsedLidar pulsed = lidar();
  pulsed.sensor.full_well_e = 100;  // of a pulse whose peak is near 2500 * 0.27 = 660 per sample
  EXPECT_EQ(missed(scan_of(pulsed, facing(10)), reason::saturated), 60u * 40u);

  LaserLine line;
  line.camera = {
      .width_px = 160, .height_px = 20, .fx_px = 400, .fy_px = 400, .cx_px = 79.5, .cy_px = 9.5};
  line.beam_radius_m = 8e-4;
  line.steps = 3;
  line.sensor.full_well_e = 250;
  EXPECT_EQ(missed(scan_of(line, facing(0.18)), reason::saturated), 60u);
}

TEST(ImageSize, MayBeOnePixelOrOneRow) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(100000, 1), std::pair(1, 3000)}) {
    PhaseCamera s;
    s.camera = {.width_px = width,
                .height_px = height,
                .fx_px = 1e5,
                .fy_px = 1e5,
                .cx_px = (width - 1) / 2.0,
                .cy_px = (height - 1) / 2.0};
    s.frequencies_hz = {80e6};
    s.max_range_m = 1.8;
    const RawFrames frames =
        render(s, RayCaster(facing(1)), Pose::Identity(), {}, no_effects).frames;
    const Scan scan = acquire_phase(std::get<PhaseTaps>(frames));
    EXPECT_EQ(scan.cloud.size(), static_cast<std::size_t>(width) * height);
    expect_complete(scan, static_cast<std::size_t>(width) * height);
  }
}

}  // namespace
}  // namespace scan::synth
