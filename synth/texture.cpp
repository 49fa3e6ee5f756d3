// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/texture.h"

#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "libscan/core/shortest.h"

namespace scan::synth {
namespace {

void check_range(const std::string& field, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(Trouble::input, field + " is " + shortest(value) + ", must be from " + shortest(low) +
                                  " to " + shortest(high));
}

void check_period(const std::string& place, double period_m) {
  if (std::isfinite(period_m) && period_m > 0) return;
  throw Error(Trouble::input, place + "/period_m is " + shortest(period_m) + ", must be positive");
}

void check_factors(const Image<float>& factors, const std::string& place) {
  if (factors.empty()) throw Error(Trouble::input, place + "/image has no pixels");
  for (const float value : factors.pixels) check_range(place + "/image", value, 0, 1);
}

void check_texture(const PlainTexture&, const std::string&) {}
void check_texture(const CheckerTexture& checker, const std::string& place) {
  check_period(place, checker.period_m);
  check_range(place + "/contrast", checker.contrast, 0, 1);
}
void check_texture(const NoiseTexture& noise, const std::string& place) {
  check_period(place, noise.period_m);
  check_range(place + "/octaves", noise.octaves, 1, 16);
  check_range(place + "/contrast", noise.contrast, 0, 1);
}

void check_texture(const ImageTexture& image, const std::string& place) {
  if (!(std::isfinite(image.width_m) && image.width_m > 0))
    throw Error(Trouble::input,
                place + "/width_m is " + shortest(image.width_m) + ", must be positive");
  check_factors(image.factors, place);
}

void check_texture(const MeshTexture& picture, const std::string& place) {
  check_factors(picture.factors, place);
}

double lattice_value(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto word = [](std::int64_t v) { return static_cast<std::uint32_t>(v); };
  return philox4x32({word(x), word(y), word(z), 0}, {0x6c696273u, 0x63616e21u})[0] * 0x1p-32;
}

double blend(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

double factor(const PlainTexture&, const TexturePoint&) {
  return 1;
}

double factor(const CheckerTexture& checker, const TexturePoint& at) {
  const Eigen::Vector3d cell =
      (at.x_in_object * (2 / checker.period_m)).array().round();  // dark and light: a period
  return std::fmod(std::abs(cell.sum()), 2) == 0 ? 1 : 1 - checker.contrast;
}

double factor(const NoiseTexture& noise, const TexturePoint& at) {
  double sum = 0, weights = 0, weight = 1;
  Eigen::Vector3d place = at.x_in_object / noise.period_m;
  for (int octave = 0; octave < noise.octaves; ++octave) {
    sum += weight * value_noise(place);
    weights += weight;
    weight /= 2;
    // doubled, and moved off the coarser lattice, whose corners would all coincide at the origin
    place = 2 * place + Eigen::Vector3d(17.31, 5.77, 29.13);
  }
  return 1 - noise.contrast * (1 - sum / weights);
}

int wrapped(double index, int count) {
  return static_cast<int>(index - std::floor(index / count) * count) % count;
}

// Between the centres of pixels, (0, 0) that of the first; columns and rows repeat.
double bilinear(const Image<float>& factors, double across, double down) {
  const double column = std::floor(across), row = std::floor(down);
  const int left = wrapped(column, factors.width), right = wrapped(column + 1, factors.width);
  const int top = wrapped(row, factors.height), bottom = wrapped(row + 1, factors.height);
  const double u = across - column, v = down - row;
  return (1 - v) * ((1 - u) * factors(left, top) + u * factors(right, top)) +
         v * ((1 - u) * factors(left, bottom) + u * factors(right, bottom));
}

double factor(const ImageTexture& image, const TexturePoint& at) {
  const Eigen::Vector3d& x = at.x_in_object;
  const Image<float>& factors = image.factors;
  const double pixels_per_m = factors.width / image.width_m;
  return bilinear(factors, x.x() * pixels_per_m + (factors.width - 1) / 2.0,
                  (factors.height - 1) / 2.0 - x.y() * pixels_per_m);
}

double factor(const MeshTexture& picture, const TexturePoint& at) {
  return bilinear(picture.factors, at.place.x() * picture.factors.width - 0.5,
                  at.place.y() * picture.factors.height - 0.5);
}

}  // namespace

void check(const Texture& texture, const std::string& place) {
  std::visit([&](const auto& t) { check_texture(t, place); }, texture);
}

TexturePoint texture_point(const Object& object, std::uint32_t triangle,
                           const Eigen::Vector3d& x_in_object) {
  TexturePoint at{x_in_object};
  if (object.texture_corners.empty()) return at;
  const Mesh& mesh = std::get<Mesh>(object.geometry);
  const auto& [ia, ib, ic] = mesh.triangles[triangle];
  const Eigen::Vector3d &a = mesh.vertices[ia], &b = mesh.vertices[ib], &c = mesh.vertices[ic];
  const Eigen::Vector3d twice_area = area_vector(mesh, mesh.triangles[triangle]);
  const auto share = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (to - from).cross(x_in_object - from).dot(twice_area) / twice_area.squaredNorm();
  };
  const TextureCorners& corners = object.texture_corners[triangle];
  at.place = share(b, c) * corners[0] + share(c, a) * corners[1] + share(a, b) * corners[2];
  return at;
}

double texture_factor(const Texture& texture, const TexturePoint& at) {
  return std::visit([&](const auto& t) { return factor(t, at); }, texture);
}

double value_noise(const Eigen::Vector3d& x) {
  const Eigen::Vector3d cell = x.array().floor();
  const Eigen::Vector3d weight = (x - cell).unaryExpr(&blend);
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Eigen::Vector3d at = cell + step;
    const double share =
        (step.array() * weight.array() + (1 - step.array()) * (1 - weight.array())).prod();
    value +=
        share * lattice_value(static_cast<std::int64_t>(at.x()), static_cast<std::int64_t>(at.y()),
                              static_cast<std::int64_t>(at.z()));
  }
  return value;
}

}  // namespace scan::synth
