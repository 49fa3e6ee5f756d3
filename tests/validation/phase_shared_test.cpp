// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Indirect light that neighbours share, against the two-bounce integral at each pixel.
#include "synth/scanners/phase_shared.h"

#include "tests/validation/matt_corner.h"

namespace scan::synth {
namespace {

using Phasor = std::complex<double>;

// 24 x 24 pixels, 7 mm each, about the point 0.35 m from the edge of the left wall.
PhaseCamera corner_camera() {
  const Eigen::Vector3d middle = on(left, 0.35, 0);
  PhaseCamera s;
  s.camera = {.width_px = 24, .height_px = 24, .fx_px = 250, .fy_px = 250};
  s.camera.cx_px = 11.5 - 250 * middle.x() / middle.z();
  s.camera.cy_px = 11.5;
  s.frequencies_hz = {80e6, 20e6};
  s.electrons_at_1m = 60000;
  s.sensor.full_well_e = 200000;
  return s;
}

struct Pixel {                     // by frequency
  std::array<Phasor, 2> direct;    // of the device's light, with the way
  std::array<Phasor, 2> indirect;  // by quadrature
  double constant_e = 0, indirect_constant_e = 0;
};

// By the intersection of the pixel's ray with the plane of the left wall.
std::vector<Pixel> corner_pixels(const PhaseCamera& s, double albedo) {
  std::vector<Pixel> pixels;
  for (std::size_t i = 0; i < 24 * 24; ++i) {
    const auto [column, row] = place_of(i, 24);
    const Eigen::Vector3d toward((column - s.camera.cx_px) / 250, (row - s.camera.cy_px) / 250, 1);
    const Eigen::Vector3d x = toward * left.normal.dot(edge) / left.normal.dot(toward);
    const double u_m = (x - edge).dot(left.along);
    Pixel pixel{.constant_e =
                    albedo * s.electrons_at_1m * -left.normal.dot(x) / std::pow(x.norm(), 3)};
    for (std::size_t f = 0; f < 2; ++f) {
      const double frequency_hz = s.frequencies_hz[f];
      pixel.direct[f] =
          s.contrast * pixel.constant_e * std::polar(1.0, per_m(frequency_hz) * x.norm());
      pixel.indirect[f] = corner_phasor(s, frequency_hz, albedo, u_m, x.y()) - pixel.direct[f];
    }
    // a phasor at frequency 0 is all the light, times the contrast
    pixel.indirect_constant_e =
        corner_phasor(s, 0, albedo, u_m, x.y()).real() / s.contrast - pixel.constant_e;
    pixels.push_back(pixel);
  }
  return pixels;
}

struct Errors {
  double square = 0;          // of a phasor, over a tap's variance
  double square_of_mean = 0;  // of the mean over all repetitions
  double constant = 0;        // square of the constant part's
  double stated = 0;          // of taps
  double paths = 0;           // per pixel
};

// The pixels' light after the shared light is added to the direct one.
struct Found {
  std::vector<double> constant_e;
  std::vector<Phasor> phasor;  // [2 * pixel + frequency]
  std::vector<SharedPixel> done;
};

Found find(const PathView& view, const std::vector<Pixel>& pixels) {
  Found found;
  for (const Pixel& pixel : pixels) {
    found.constant_e.push_back(pixel.constant_e);
    found.phasor.insert(found.phasor.end(), pixel.direct.begin(), pixel.direct.end());
  }
  const LightOf light_of = [&](const PixelPlace& place) {
    const std::size_t i = index_of(place, 24);
    return LightSum{found.constant_e[i], std::span(found.phasor).subspan(2 * i, 2)};
  };
  const RayOf ray = [](const PixelPlace& place) { return index_of(place, 24); };
  const auto patches = patches_of(view, {0, 0}, [](const PixelPlace&) { return true; });
  found.done = add_shared_light(view, tones_of(view.scanner), patches.at(0), ray, light_of);
  EXPECT_EQ(found.done.size(), pixels.size());
  return found;
}

Errors errors_over(int repetitions) {
  const double albedo = 0.7;
  const PhaseCamera s = corner_camera();
  const RayCaster caster(corner(albedo));
  const LightTransport transport(caster, {.most_scatterings = 2});
  const std::vector<Pixel> pixels = corner_pixels(s, albedo);
  std::vector<Phasor> mean(2 * pixels.size());
  Errors errors;
  const double share = 1.0 / (repetitions * 576);
  for (int seed = 0; seed < repetitions; ++seed) {
    const RenderAddress address{.seed = static_cast<std::uint64_t>(seed), .scan = 0};
    const Found found = find({s, transport, Pose::Identity(), {}, address}, pixels);
    for (const SharedPixel& one : found.done) {
      const std::size_t i = index_of(one.place, 24);
      const Pixel& pixel = pixels[i];
      const double variance_e2 = tap_variance_e2(s.sensor, found.constant_e[i]);
      const double constant_error_e =
          found.constant_e[i] - pixel.constant_e - pixel.indirect_constant_e;
      errors.constant += share * std::pow(constant_error_e, 2) / variance_e2;
      for (std::size_t f = 0; f < 2; ++f) {
        const Phasor error_e = found.phasor[2 * i + f] - pixel.direct[f] - pixel.indirect[f];
        mean[2 * i + f] += error_e / std::sqrt(variance_e2) / (1.0 * repetitions);
        errors.square += share / 2 * std::norm(error_e) / variance_e2;
      }
      errors.stated += share * std::pow(one.taps.standard_error[0], 2) / variance_e2;
      errors.paths += share * one.taps.samples;
    }
  }
  for (const Phasor& error : mean) errors.square_of_mean += std::norm(error) / 1152;
  return errors;
}

// A tap is constant plus or minus a component of the phasor; both follow the same light, so a
// phasor's error is at most contrast times sqrt(2) of what a tap's is stated as: 0.71 of it, and
// half of the square. 16 repetitions of at least six coefficients: their mean square scatters by
// sqrt(2 / 96 + 2 / 288) = 0.17; four times that. Without a bias the mean over 16 is 16 times
// better in the square. The constant part's error is no more than a tap's. The goal, 0.5 of a tap's
// noise, is met in the root mean square.
TEST(SharedLight, IsTheTwoBounceIntegralWithinItsStatedError) {
  constexpr int repetitions = 16;
  const Errors errors = errors_over(repetitions);
  std::printf(
      "shared light: error %.3f, of the mean of 16 %.4f; stated %.3f of a tap's noise, "
      "%.0f paths a pixel\n",
      std::sqrt(errors.square), std::sqrt(errors.square_of_mean), std::sqrt(errors.stated),
      errors.paths);
  EXPECT_LT(errors.square, 0.5 * errors.stated * (1 + 4 * 0.17));
  EXPECT_LT(errors.square_of_mean, 0.5 * errors.stated * (1 + 4 * 0.17) / repetitions);
  EXPECT_LT(errors.constant, errors.stated * (1 + 4 * 0.17));
  EXPECT_LT(errors.stated, 0.25);
}

}  // namespace
}  // namespace scan::synth
