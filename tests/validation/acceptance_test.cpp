// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Acceptance figures of scanners whose errors are known: an ideal one's, and those of a device
// whose calibration says something else than its optics do.
#include <numbers>

#include "libscan/core/random.h"
#include "libscan/core/units.h"
#include "libscan/verify/structural_resolution.h"
#include "synth/artefacts.h"
#include "tests/validation/acceptance_figures.h"

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

// An encoder that shows 100 ppm too much turns every ray as much farther about the axis (y). Balls
// at the distance d from it, to either side by the angle a, are seen 2 d sin(a) apart with a 100
// ppm larger. Both are as much wider along that way, which moves a fitted centre along the sight by
// less than 1e-4 of the radius, the largest move of a point.
TEST(Acceptance, ALongEncoderLengthensWhatALidarTurnsOver) {
  const double length_m = bench().bar_length_m, depth_m = bench().centre_m.z();
  Scene scene{.objects = {}, .materials = {grey}};
  for (const double side : {-0.5, 0.5})
    scene.objects.push_back(
        {.name = "ball",
         .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {side * length_m, 0, depth_m}),
         .geometry = Shape(SphereShape{bench().ball_diameter_m / 2}),
         .material = 0});
  const RayCaster caster(scene);
  const auto truth = true_rays(pulsed_lidar(), caster, Pose::Identity());
  const auto spacing_m = [&](double factor) {
    RawFrames frames = render(pulsed_lidar(), caster, Pose::Identity(), {}, no_effects).frames;
    for (Eigen::Vector3d& way : std::get<Waveforms>(frames).directions)
      way =
          Eigen::AngleAxisd((factor - 1) * std::atan2(way.x(), way.z()), Eigen::Vector3d::UnitY()) *
          way;
    return bar_figures(acquire(frames), truth, bench()).spacing_m;
  };
  const double angle_rad = std::atan2(length_m / 2, depth_m),
               away_m = std::hypot(length_m / 2, depth_m);
  EXPECT_NEAR(spacing_m(1.0001) - spacing_m(1),
              2 * away_m * (std::sin(1.0001 * angle_rad) - std::sin(angle_rad)),
              1e-4 * bench().ball_diameter_m * std::sin(angle_rad));
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

}  // namespace
}  // namespace scan::synth
