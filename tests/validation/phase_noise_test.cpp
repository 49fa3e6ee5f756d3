// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Noise of a phase camera from scene over taps to ranges, against the law of shot noise and a
// published camera.
#include <algorithm>

#include "libscan/acquire/phase.h"
#include "libscan/core/units.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// All pixels look along the axis to 1e-6 of the range.
PhaseCamera narrow_camera(double frequency_hz, int width_px, int height_px) {
  PhaseCamera s;
  s.camera = {.width_px = width_px,
              .height_px = height_px,
              .fx_px = 1e6,
              .fy_px = 1e6,
              .cx_px = (width_px - 1) / 2.0,
              .cy_px = (height_px - 1) / 2.0};
  s.frequencies_hz = {frequency_hz};
  s.max_range_m = 100;
  s.sensor.gain_e_per_dn = 0.5;
  return s;
}

Scene white_wall(double z_m, double albedo = 1) {
  Material white{.name = "white", .bsdf = Lambert{albedo}, .texture = {}};
  Object wall = plane_target(z_m, white).scene.objects[0];
  const Eigen::AngleAxisd facing(pi, Eigen::Vector3d::UnitY());
  wall.world_from_object = make_pose(facing.toRotationMatrix(), {0, 0, z_m});
  return {.objects = {wall}, .materials = {white}};
}

// Amplitude A and constant part B, electrons, of a wall at 1 m: the rest of B is ambient light.
PhaseTaps wall_taps(double frequency_hz, double amplitude_e, double constant_e) {
  PhaseCamera s = narrow_camera(frequency_hz, 640, 500);
  s.electrons_at_1m = std::min(2 * amplitude_e, constant_e);
  s.contrast = amplitude_e / s.electrons_at_1m;
  s.ambient_electrons = constant_e - s.electrons_at_1m;
  return std::get<PhaseTaps>(
      render(s, RayCaster(white_wall(1)), Pose::Identity(), {.seed = 23, .scan = 2}, sensor_effects)
          .frames);
}

std::vector<double> ranges_m(double frequency_hz, double amplitude_e, double constant_e) {
  const Scan scan = acquire_phase(wall_taps(frequency_hz, amplitude_e, constant_e));
  std::vector<double> ranges;
  for (const auto& point : scan.cloud.points) ranges.push_back(point.norm());
  return ranges;
}

double law_m(double frequency_hz, double amplitude_e, double constant_e) {
  return speed_of_light_m_s / (4 * std::sqrt(2) * pi * frequency_hz) * std::sqrt(constant_e) /
         amplitude_e;
}

// Lange 2000: sigma = c / (4 sqrt(2) pi f) sqrt(B) / A, golden values in mm. 320,000 pixels: sigma
// of a sample has a standard error of 1 / sqrt(2 n) = 0.125 %, five of them are 0.63 %. The law is
// linear in the noise: tan(phi) adds sigma_phi^2 = B / (2 A^2) of it, 0.1 % here (physics 7.5: SNR
// above 20 dB); rounding to steps of q = 0.5 e adds q^2 / (24 B) = 5e-6.
TEST(PhaseNoise, FollowsTheShotNoiseLaw) {
  struct Case {
    double frequency_hz, amplitude_e, constant_e, golden_mm;
  };
  for (const Case& c :
       {Case{20e6, 1000, 2000, 37.7}, {80e6, 1000, 2000, 9.430}, {120e6, 1000, 2000, 6.29}}) {
    const double law = law_m(c.frequency_hz, c.amplitude_e, c.constant_e);
    EXPECT_NEAR(law * 1e3, c.golden_mm, 0.005 * c.golden_mm / 9.43 + 0.05 * (c.golden_mm > 30));
    const std::vector<double> ranges = ranges_m(c.frequency_hz, c.amplitude_e, c.constant_e);
    ASSERT_EQ(ranges.size(), 320000u);
    double mean = 0, square = 0;
    for (const double r : ranges) mean += r / 320000;
    for (const double r : ranges) square += (r - mean) * (r - mean) / 319999;
    std::printf("phase noise %3.0f MHz: sigma %.3f mm, law %.3f mm\n", c.frequency_hz * 1e-6,
                std::sqrt(square) * 1e3, law * 1e3);
    EXPECT_NEAR(std::sqrt(square) / law, 1, 0.0063 + 0.001);
    EXPECT_NEAR(mean, 1, 5 * law / std::sqrt(320000.0));
  }
}

// E cos(theta) of the angle theta of a plane normal vector of mean A and deviation s in each
// component: sqrt(pi / 8) r exp(-r^2 / 4) (I0(r^2 / 4) + I1(r^2 / 4)), r = A / s (Middleton 1960).
double mean_cosine(double r) {
  const double x = r * r / 4;
  return std::sqrt(pi / 8) * r * std::exp(-x) *
         (std::cyl_bessel_i(0.0, x) + std::cyl_bessel_i(1.0, x));
}

// Strong sun, A 100 and B 20,000: sigma_phi is 1 rad, the law's 298 mm no longer hold, ranges fold.
// The mean of exp(i phi) does not mind. Against the closed form for normal noise of variance B / 2,
// and against taps drawn here. Its standard error is below 1 / sqrt(n) in each component.
TEST(PhaseNoise, LosesThePhaseInStrongSunAsPhysicsSays) {
  const double phase = 4 * pi * 80e6 / speed_of_light_m_s;
  const auto turned = [&](const std::array<double, 4>& tap) {
    return std::polar(1.0 / 320000, std::atan2(tap[3] - tap[1], tap[0] - tap[2]) - phase);
  };
  const PhaseTaps frames = wall_taps(80e6, 100, 20000);
  RandomStream random(77, 0, 0);
  std::complex<double> mean = 0, drawn = 0;
  for (std::size_t i = 0; i < 320000; ++i) {
    std::array<double, 4> rendered, tap;
    for (int k = 0; k < 4; ++k) {
      rendered[k] = frames.taps[0][k].pixels[i];
      tap[k] = static_cast<double>(random.poisson(20000 + 100 * std::cos(phase + k * pi / 2)));
    }
    mean += turned(rendered);
    drawn += turned(tap);
  }
  const double closed = mean_cosine(100 / std::sqrt(20000 / 2.0));
  std::printf("strong sun: mean cosine %.4f, closed form %.4f, Monte Carlo %.4f\n", mean.real(),
              closed, drawn.real());
  const double error = 5 / std::sqrt(320000.0);
  EXPECT_NEAR(mean.real(), closed, error);
  EXPECT_NEAR(mean.imag(), 0, error);
  EXPECT_NEAR(drawn.real(), closed, error);
}

// Amplitudes of 100 e on 200 e, 17 dB: the law's next order is sigma_phi^2 = 1 %.
TEST(PhaseNoise, FollowsTheLawInDimLight) {
  const std::vector<double> ranges = ranges_m(80e6, 100, 200);
  double square = 0;
  for (const double r : ranges) square += (r - 1) * (r - 1) / static_cast<double>(ranges.size());
  EXPECT_NEAR(law_m(80e6, 100, 200) * 1e3, 29.8, 0.05);
  EXPECT_NEAR(std::sqrt(square) / law_m(80e6, 100, 200), 1, 0.0063 + 0.02);
}

// A camera of the kind of the Kinect v2. Published (data sheets and Bamji et al. 2015; taken from
// memory of them): 512 x 424 px of 10 um, 365 px of focal length, F/1.07, 16/80/120 MHz,
// responsivity 0.14 A/W with the fill factor, contrast about 0.6. Assumed: 1.5 W mean optical power
// over the field of 70 x 60 deg (1.2 sr), lens transmission 0.9, 0.8 ms per tap, 20 e of read
// noise. Electrons per tap of a white wall at 1 m: irradiance 1.5 / 1.2 W/m^2, on the sensor 0.9 /
// (4 1.07^2) of it (Lambert), 1e-10 m^2, 0.14 A/W, 0.8 ms, over 1.6e-19 C: 1.7e4.
PhaseCamera kinect_v2() {
  PhaseCamera s = narrow_camera(80e6, 100, 100);
  s.frequencies_hz = {16e6, 80e6, 120e6};
  s.electrons_at_1m = 1.5 / 1.2 * 0.9 / (4 * 1.07 * 1.07) * 1e-10 * 0.14 * 0.8e-3 / 1.602e-19;
  s.contrast = 0.6;
  s.sensor.read_noise_e = 20;
  s.max_range_m = 18.7;
  return s;
}

// Fankhauser et al. 2015, axial noise at normal incidence: 1.5 - 0.5 z + 0.3 z^2 mm, from memory.
// That is a device whose driver filters phases over 3 x 3 px, which divides white noise by 3 at
// most; ours reads a wall of albedo 0.5 tap by tap: between 1 and 3 times the published noise. Its
// growth is between that of light alone, as z, and that of read noise alone, as z^2; the published
// one grows less, with a floor that no noise of light or reading explains.
TEST(PhaseNoise, ComesNearTheKinectV2) {
  const PhaseCamera s = kinect_v2();
  std::vector<double> sigmas_m;
  for (const double z : {1.0, 2.0, 3.0, 4.0}) {
    const Scene scene = white_wall(z, 0.5);
    const Scan scan = acquire(
        render(s, RayCaster(scene), Pose::Identity(), {.seed = 4, .scan = 0}, sensor_effects)
            .frames);
    ASSERT_GE(scan.cloud.size(), 9990u);  // some differ by 4 sigmas between frequencies
    double square = 0;
    for (const auto& point : scan.cloud.points)
      square += (point.z() - z) * (point.z() - z) / static_cast<double>(scan.cloud.size());
    const double published_m = (1.5 - 0.5 * z + 0.3 * z * z) * 1e-3;
    const double ratio = std::sqrt(square) / published_m;
    std::printf("Kinect v2 at %.0f m: %.2f mm, published %.2f mm, ratio %.2f\n", z,
                std::sqrt(square) * 1e3, published_m * 1e3, ratio);
    EXPECT_GT(ratio, 1);
    EXPECT_LT(ratio, 3);
    sigmas_m.push_back(std::sqrt(square));
  }
  EXPECT_GT(sigmas_m.back() / sigmas_m.front(), 4);
  EXPECT_LT(sigmas_m.back() / sigmas_m.front(), 16);
}

}  // namespace
}  // namespace scan::synth
