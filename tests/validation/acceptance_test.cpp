// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Acceptance figures of scanners whose errors are known: an ideal one's, and those of a device
// whose calibration says something else than its optics do.
#include <numbers>

#include "libscan/core/random.h"
#include "libscan/core/units.h"
#include "libscan/verify/structural_resolution.h"
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

// Larger balls, since what windows see of a rim is dropped.
Artefacts stereo_bench() {
  return with_sizes({.volume_m = {0.7, 0.5, 0.3},
                     .centre_m = {0, 0, 1},
                     .ball_diameter_m = 0.25,
                     .bar_length_m = 0.3});
}

// Points of each body of one place that face the scanner within 60 degrees.
std::vector<Points> bodies_of(const Scan& scan, const std::vector<RayTruth>& truth) {
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

Figures bar_figures(const Scan& scan, const std::vector<RayTruth>& truth, const Artefacts& sized) {
  const auto bodies = bodies_of(scan, truth);
  EXPECT_GT(bodies[0].size(), 100u);
  EXPECT_GT(bodies[1].size(), 100u);
  const auto probing = probing_errors(bodies, sized.ball_diameter_m);
  return {value(probing, "probing_size"),
          value(spacing_errors(std::vector{BallBar{bodies[0], bodies[1]}}, sized.bar_length_m),
                "sphere_spacing_error"),
          value(probing, "probing_form")};
}

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
  return bar_figures(acquire(frames), true_rays(device, caster, Pose::Identity()), bench());
}

const Material grey{.name = "grey", .bsdf = Lambert{0.5}, .texture = {}};
const Material printed{
    .name = "printed", .bsdf = Lambert{0.9}, .texture = NoiseTexture{0.012, 1, 0.9}};

// Noise-free taps are rounded to the finest steps the device can deliver; at an amplitude of some
// hundred such steps the phase at 120 MHz is known to about 1e-3 rad, that is 0.2 mm: what the form
// may show, and a tenth of it the fits, which average a thousand points.
TEST(Acceptance, OfAnIdealPhaseCameraIsRounding) {
  const Figures figures = bar_figures(phase_camera(), grey);
  EXPECT_LT(figures.form_m, 2e-4);
  EXPECT_LT(std::abs(figures.size_m), 2e-5);
  EXPECT_LT(std::abs(figures.spacing_m), 2e-5);
}

// Each pixel's ray ends on the wave itself, so two of them show it: at 1.2 m they lie 1.2 / 200 m
// apart. Between 1.866 and 2.136 times that (structural_resolution_test), 1 % less to more for the
// wave's nearness and the fields that jitter with it. Phase noise is none, and what rounding
// leaves, 0.2 mm, is below half the amplitude of the least wave, 0.05 * 8 mm.
TEST(Acceptance, AnIdealPhaseCameraResolvesTwoPixels) {
  std::vector<std::vector<WavePlate>> series;
  for (const WaveAxis axis : {WaveAxis::x, WaveAxis::y}) {
    series.emplace_back();
    for (int i = 0; i < 7; ++i) {
      const double period_m = 0.064 * std::pow(2, -i / 2.0);
      const Scene scene{.objects = wave_plate(bench(), Pose::Identity(), period_m, axis),
                        .materials = {grey}};
      const RayCaster caster(scene);
      const Scan scan =
          acquire(render(phase_camera(), caster, Pose::Identity(), {}, no_effects).frames);
      const Pose plate_from_scanner = scene.objects.front().world_from_object.inverse();
      series.back().push_back({.edge_m = 0.9 * bench().plate_m,
                               .period_m = period_m,
                               .amplitude_m = wave_amplitude_m(period_m)});
      for (const Eigen::Vector3d& x : scan.cloud.points)
        series.back().back().points.push_back(plate_from_scanner * x);
    }
  }
  const double points = structural_resolution(series).value / (1.2 / 200);
  EXPECT_GT(points, 1.866 * 0.99);
  EXPECT_LT(points, 2.136 * 1.01);
  EXPECT_NEAR(wave_response(series[0][0]).transfer, 1, 0.02);
}

PulsedLidar pulsed_lidar() {
  PulsedLidar lidar;
  lidar.pattern = RasterPattern{.rows = 120, .columns = 160, .height_rad = 0.55, .width_rad = 0.75};
  lidar.electrons_at_10m = 50;
  lidar.ambient_electrons = 0;
  lidar.max_range_m = 5;
  lidar.sensor = {.gain_e_per_dn = 0.05, .offset_dn = 50, .bits = 16};
  return lidar;
}

// Samples are rounded to a twentieth of an electron, 0.014 rms, where a pulse of some 200 to 500 at
// its top stands over four samples: the time is known to 1.5 ns 0.014 / 200 / sqrt(2) = 0.08 ps and
// the range to 11 um. The form of 400 points may show 6.5 of these, 72 um. Of a cap of 60 degrees
// the radius is known to 5.6 sigma / sqrt(400), since it and the depth of the centre resemble each
// other (1 and cos over the disc), the diameter to 6.2 um, four times that at most; centres across
// the sight to 2 sigma / sqrt(400), their distance to 1.6 um.
TEST(Acceptance, OfAnIdealLidarIsRounding) {
  const Figures figures = bar_figures(pulsed_lidar(), grey);
  EXPECT_LT(figures.form_m, 7.2e-5);
  EXPECT_LT(std::abs(figures.size_m), 2.5e-5);
  EXPECT_LT(std::abs(figures.spacing_m), 6.4e-6);
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

// The lidar counts its samples by the same clock: start, interval and pulse all appear longer.
TEST(Acceptance, AFastClockLengthensEveryLengthOfALidar) {
  const Figures ideal = bar_figures(pulsed_lidar(), grey);
  const Figures fast = bar_figures(pulsed_lidar(), grey, [](RawFrames& frames) {
    WaveformCalibration& clock = std::get<Waveforms>(frames).calibration;
    for (double* time_s : {&clock.sample_interval_s, &clock.window_start_s, &clock.pulse_sigma_s})
      *time_s *= 1.0001;
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

// Rounding of 8 bits is what an ideal pair's sigma states, and matches share it over windows of 7
// px. So the form is that of drawn errors of that sigma, within a factor of 1.5 for the few windows
// in it; a mean over n points is known to 7 sigma / sqrt(n), the diameter to twice 5.6 times, a
// centre across the sight to twice that (see the lidar above): at most three times as much. Rims
// are dropped, as far as windows reach.
TEST(Acceptance, OfAnIdealStereoPairIsRounding) {
  const Scene scene{.objects = bar_places(stereo_bench(), Pose::Identity()).front(),
                    .materials = {printed}};
  const RayCaster caster(scene);
  const Scan scan = acquire(render(stereo_pair(), caster, Pose::Identity(), {}, no_effects).frames,
                            {.stereo = {.edge_margin_px = 8}});
  const auto truth = true_rays(stereo_pair(), caster, Pose::Identity());
  Scan drawn = scan;
  for (std::size_t i = 0; i < drawn.cloud.size(); ++i) {
    RandomStream random(3, 0, i);
    const Eigen::Vector3d& at = truth[scan.ray[i]].point_in_scanner;
    drawn.cloud.points[i] = at + scan.cloud.sigma_m[i] * random.normal() * at.normalized();
  }
  const Figures is = bar_figures(scan, truth, stereo_bench()),
                predicted = bar_figures(drawn, truth, stereo_bench());
  EXPECT_LT(is.form_m, 1.5 * predicted.form_m);
  EXPECT_GT(is.form_m, predicted.form_m / 1.5);
  double variance_m2 = 0;
  const double points = static_cast<double>(scan.cloud.size());
  for (const double sigma_m : scan.cloud.sigma_m) variance_m2 += sigma_m * sigma_m / points;
  const double of_mean_m = 7 * std::sqrt(variance_m2 / (points / 2));  // a ball has half of them
  EXPECT_LT(std::abs(is.size_m), 3 * 2 * 5.6 * of_mean_m);
  EXPECT_LT(std::abs(is.spacing_m), 3 * 2 * std::sqrt(2) * of_mean_m);
}

// A baseline that is believed 0.1 % too long scales every point by as much (Z = f B / d, and X, Y
// with Z). Matching errs by fractions of a pixel, which changes neither figure's difference.
TEST(Acceptance, ALongBaselineLengthensEveryLength) {
  const Figures ideal = bar_figures(stereo_pair(), printed);
  const Figures longer = bar_figures(stereo_pair(), printed, [](RawFrames& frames) {
    std::get<ImagePair>(frames).calibration.baseline_m *= 1.001;
  });
  const double length_m = bench().bar_length_m + ideal.spacing_m;
  EXPECT_NEAR(longer.spacing_m - ideal.spacing_m, 1e-3 * length_m, 1e-9);
  EXPECT_NEAR(longer.size_m - ideal.size_m, 1e-3 * (bench().ball_diameter_m + ideal.size_m), 1e-9);
}

LaserLine laser_line() {
  LaserLine device;
  device.camera = {
      .width_px = 160, .height_px = 20, .fx_px = 400, .fy_px = 400, .cx_px = 79.5, .cy_px = 9.5};
  device.beam_radius_m = 4e-4;
  device.steps = 11;
  device.step_m = 2e-3;
  return device;
}

// Of the face of a plane at the distance z_m, all that the sweep sees.
Points scanned_plane(
    const LaserLine& device, double z_m, const EffectSet& effects,
    const std::function<void(RawFrames&)>& change = [](RawFrames&) {}) {
  const Scene scene{.objects = {plane_at(z_m)}, .materials = {grey}};
  RawFrames frames = render(device, RayCaster(scene), Pose::Identity(), {}, effects).frames;
  change(frames);
  return acquire(frames).cloud.points;
}

// Noise-free readings are rounded to steps of half an electron, which moves a stripe's centre by at
// most (step / 2) sum |s| / N over its window (laser_line_range_test), some 5e-4 px; along a
// camera's ray z = B / (u + tan(a)), so that is z^2 / (f B) times as much in range, 0.4 um. The
// stripe's bias on a plane that faces the scanner is none.
TEST(Acceptance, OfAnIdealLaserLineIsRounding) {
  LaserLine device = laser_line();
  device.sensor = {.gain_e_per_dn = 0.5, .offset_dn = 8, .bits = 16};
  const double near_m = 0.175, far_m = 0.19;
  const auto rounding_m = [&](double z_m) {
    const double f_px = device.camera.fx_px;
    const double sigma_px =
        f_px * device.beam_radius_m / (2 * z_m * std::cos(device.triangulation_rad));
    const double window_px = 9 * sigma_px * sigma_px + 3 * sigma_px + 1;
    const double height_e = 0.5 * device.peak_electrons * 0.8;  // light falls off by less than that
    const double electrons = std::sqrt(2 * std::numbers::pi) * sigma_px * height_e;
    return 0.25 * window_px / electrons * z_m * z_m / (f_px * device.baseline_m);
  };
  const Points near = scanned_plane(device, near_m, no_effects),
               far = scanned_plane(device, far_m, no_effects);
  EXPECT_LT(value(flatness_errors(std::vector{near, far}), "flatness"), 2 * rounding_m(far_m));
  EXPECT_LT(
      std::abs(value(step_errors(std::vector{Step{far, near}}, far_m - near_m), "step_error")),
      rounding_m(near_m) + rounding_m(far_m));
}

// A baseline that is believed 0.1 % too long puts the light plane, whose offset is B cos(a), as
// much farther from the camera, and every range in it with it: a step of faces across the sight
// grows by 0.1 %.
TEST(Acceptance, ALongBaselineShowsInTheLasersStep) {
  const double near_m = 0.175, far_m = 0.19;
  const auto height_m = [&](double factor) {
    const auto change = [&](RawFrames& frames) {
      std::get<StripeImages>(frames).calibration.plane_offset_m *= factor;
    };
    const Step step{scanned_plane(laser_line(), far_m, no_effects, change),
                    scanned_plane(laser_line(), near_m, no_effects, change)};
    return far_m - near_m + value(step_errors(std::vector{step}, far_m - near_m), "step_error");
  };
  EXPECT_NEAR(height_m(1.001) / height_m(1), 1.001, 1e-9);
}

// The real light plane leaves the laser at a larger angle, x = B - z tan(a + t), and is decoded as
// x = B - z' tan(a): 1 / z' = 1 / z - (tan(a + t) - tan(a)) / B, whatever x. The step between two
// such planes is what the sheet shows. The stripe's own bias, some 5 um here
// (laser_line_range_test), is the same with and without the tilt but for its change over the
// stripe's move, a tenth.
TEST(Acceptance, ATiltedLightPlaneShowsInTheStep) {
  LaserLine device = laser_line();
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
