// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Acceptance figures of scanners whose errors are known: an ideal one's, and those of a device
// whose calibration says something else than its optics do.
#include "libscan/core/units.h"
#include "libscan/verify/artefacts.h"
#include "synth/artefacts.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

PhaseCamera phase_camera() {
  PhaseCamera camera;
  camera.camera = {
      .width_px = 160, .height_px = 120, .fx_px = 200, .fy_px = 200, .cx_px = 79.5, .cy_px = 59.5};
  camera.frequencies_hz = {16e6, 80e6, 120e6};
  return camera;
}

Artefacts bench() {
  return with_sizes(
      {.volume_m = {0.6, 0.4, 0.4}, .centre_m = {0, 0, 1.2}, .ball_diameter_m = 0.15});
}

// Points of each body of one place that face the scanner within 60 degrees.
std::vector<Points> bodies_of(const RawFrames& frames, const std::vector<RayTruth>& truth) {
  const Scan scan = acquire(frames);
  std::vector<Points> bodies(2);
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const RayTruth& at = truth[scan.ray[i]];
    if (at.object < 0 || -at.point_in_scanner.normalized().dot(at.normal_in_scanner) < 0.5)
      continue;
    bodies[static_cast<std::size_t>(at.object)].push_back(scan.cloud.points[i]);
  }
  return bodies;
}

double value(const std::vector<Measurement>& figures, const std::string& name) {
  for (const Measurement& m : figures)
    if (m.name == name) return m.value;
  ADD_FAILURE() << name;
  return NAN;
}

struct Figures {
  double size_m, spacing_m, form_m;
};

// A ball bar's figures when the frames are decoded with the calibration that `change` makes.
template <class Device>
Figures bar_figures(
    const Device& device, const Material& material,
    const std::function<void(RawFrames&)>& change = [](RawFrames&) {}) {
  const Scene scene{.objects = bar_places(bench(), Pose::Identity()).front(),
                    .materials = {material}};
  const RayCaster caster(scene);
  RawFrames frames = render(device, caster, Pose::Identity(), {}, no_effects).frames;
  change(frames);
  const auto bodies = bodies_of(frames, true_rays(device, caster, Pose::Identity()));
  EXPECT_GT(bodies[0].size(), 100u);
  EXPECT_GT(bodies[1].size(), 100u);
  const auto probing = probing_errors(bodies, bench().ball_diameter_m);
  return {value(probing, "probing_size"),
          value(spacing_errors(std::vector{BallBar{bodies[0], bodies[1]}}, bench().bar_length_m),
                "sphere_spacing_error"),
          value(probing, "probing_form")};
}

const Material grey{.name = "grey", .bsdf = Lambert{0.5}, .texture = {}};

// Noise-free taps are rounded to the finest steps the device can deliver; at an amplitude of some
// hundred such steps the phase at 120 MHz is known to about 1e-3 rad, that is 0.2 mm: what the form
// may show, and a tenth of it the fits, which average a thousand points.
TEST(Acceptance, OfAnIdealPhaseCameraIsRounding) {
  const Figures figures = bar_figures(phase_camera(), grey);
  EXPECT_LT(figures.form_m, 2e-4);
  EXPECT_LT(std::abs(figures.size_m), 2e-5);
  EXPECT_LT(std::abs(figures.spacing_m), 2e-5);
}

// A clock that runs 100 ppm fast, so that the device believes in a frequency 100 ppm too low, makes
// every range, and with it every length, 100 ppm too long (d = c phi / 4 pi f). The frames are the
// same, so rounding cancels in the difference but for its share of 1e-4.
TEST(Acceptance, AFastClockLengthensEveryLength) {
  const Figures ideal = bar_figures(phase_camera(), grey);
  const Figures fast = bar_figures(phase_camera(), grey, [](RawFrames& frames) {
    for (double& f : std::get<PhaseTaps>(frames).calibration.frequencies_hz) f /= 1.0001;
  });
  EXPECT_NEAR(fast.spacing_m - ideal.spacing_m, 1e-4 * bench().bar_length_m, 1e-8);
  EXPECT_NEAR(fast.size_m - ideal.size_m, 1e-4 * bench().ball_diameter_m, 1e-8);
}

StereoPair stereo_pair() {
  StereoPair pair;
  pair.calibration = {.width_px = 320,
                      .height_px = 240,
                      .focal_px = 400,
                      .cx_px = 159.5,
                      .cy_px = 119.5,
                      .baseline_m = 0.1,
                      .disparities_px = 64};
  return pair;
}

// A baseline that is believed 0.1 % too long scales every point by as much (Z = f B / d, and X, Y
// with Z). Matching errs by fractions of a pixel, which changes neither figure's difference.
TEST(Acceptance, ALongBaselineLengthensEveryLength) {
  const Material noisy{
      .name = "noise", .bsdf = Lambert{0.9}, .texture = NoiseTexture{0.012, 1, 0.9}};
  const Figures ideal = bar_figures(stereo_pair(), noisy);
  const Figures longer = bar_figures(stereo_pair(), noisy, [](RawFrames& frames) {
    std::get<ImagePair>(frames).calibration.baseline_m *= 1.001;
  });
  const double length_m = bench().bar_length_m + ideal.spacing_m;
  EXPECT_NEAR(longer.spacing_m - ideal.spacing_m, 1e-3 * length_m, 1e-9);
  EXPECT_NEAR(longer.size_m - ideal.size_m, 1e-3 * (bench().ball_diameter_m + ideal.size_m), 1e-9);
}

// Of the face of a plane at the distance z_m, all that the sweep sees.
Points scanned_plane(const LaserLine& device, double z_m, const EffectSet& effects) {
  const Scene scene{.objects = {plane_at(z_m)}, .materials = {grey}};
  return acquire(render(device, RayCaster(scene), Pose::Identity(), {}, effects).frames)
      .cloud.points;
}

// The real light plane leaves the laser at a larger angle, x = B - z tan(a + t), and is decoded as
// x = B - z' tan(a): 1 / z' = 1 / z - (tan(a + t) - tan(a)) / B, whatever x. The step between two
// such planes is what the sheet shows. The stripe's own bias, some 5 um here
// (laser_line_range_test), is the same with and without the tilt but for its change over the
// stripe's move, a tenth.
TEST(Acceptance, ATiltedLightPlaneShowsInTheStep) {
  LaserLine device;
  device.camera = {
      .width_px = 160, .height_px = 20, .fx_px = 400, .fy_px = 400, .cx_px = 79.5, .cy_px = 9.5};
  device.beam_radius_m = 4e-4;
  device.steps = 11;
  device.step_m = 2e-3;
  device.plane_turn_rad = 2e-3;
  const double near_m = 0.175, far_m = 0.19;
  const auto step_error_m = [&](const EffectSet& effects) {
    const Step step{scanned_plane(device, far_m, effects), scanned_plane(device, near_m, effects)};
    return value(step_errors(std::vector{step}, far_m - near_m), "step_error");
  };
  const auto seen_m = [&](double z_m) {
    const double turn = std::tan(device.triangulation_rad + device.plane_turn_rad) -
                        std::tan(device.triangulation_rad);
    return 1 / (1 / z_m - turn / device.baseline_m);
  };
  const double predicted_m = (seen_m(far_m) - seen_m(near_m)) - (far_m - near_m);
  EXPECT_GT(predicted_m, 1e-4);
  const double tilted_m = step_error_m({Effect::footprint, Effect::miscalibration});
  EXPECT_NEAR(tilted_m - step_error_m(no_effects), predicted_m, 1e-6);
}

}  // namespace
}  // namespace scan::synth
