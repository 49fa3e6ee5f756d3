// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/triangle.h"

#include <cmath>

namespace scan::synth {
namespace {

struct Corner {
  double x, y, z;  // across the ray twice, along its largest axis
};

Corner in_ray_frame(const ShearedRay& ray, const Eigen::Vector3d& v) {
  const auto [x, y, z] = ray.axis;
  const double height = v[z] - ray.origin[z];
  return {v[x] - ray.origin[x] - ray.shear_x * height, v[y] - ray.origin[y] - ray.shear_y * height,
          height};
}

struct Sum {
  double high, low;  // unevaluated
};

// Dekker 1971, "A floating-point technique for extending the available precision".
Sum product(double a, double b) {
  const auto split = [](double x) {
    const double scaled = 134217729.0 * x;  // 2^27 + 1
    const double high = scaled - (scaled - x);
    return Sum{high, x - high};
  };
  const Sum p = split(a), q = split(b);
  const double high = a * b;
  return {high, ((p.high * q.high - high) + p.high * q.low + p.low * q.high) + p.low * q.low};
}

// a d - b c to a few roundings of itself, whatever cancels; swapped pairs give the negative.
double exact_difference(double a, double d, double b, double c) {
  const Sum p = product(a, d), q = product(b, c);
  return (p.high - q.high) + (p.low - q.low);
}

// Edge functions across the ray: of one sign where it crosses the triangle, and then the weights of
// the opposite corners.
struct Weights {
  double u, v, w;

  bool differ() const { return (u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0); }
};

}  // namespace

std::optional<double> line_distance(const ShearedRay& ray, const Eigen::Vector3d& a_in_world,
                                    const Eigen::Vector3d& b_in_world,
                                    const Eigen::Vector3d& c_in_world) {
  const Corner a = in_ray_frame(ray, a_in_world);
  const Corner b = in_ray_frame(ray, b_in_world);
  const Corner c = in_ray_frame(ray, c_in_world);
  const double bc = c.x * b.y, cb = c.y * b.x, ca = a.x * c.y, ac = a.y * c.x, ab = b.x * a.y,
               ba = b.y * a.x;
  Weights weights{bc - cb, ca - ac, ab - ba};
  if (weights.differ()) return std::nullopt;
  double area = weights.u + weights.v + weights.w;
  const double terms =
      std::abs(bc) + std::abs(cb) + std::abs(ca) + std::abs(ac) + std::abs(ab) + std::abs(ba);
  // Nearly edge-on or thin: in twice the precision.
  if (std::abs(area) < 0x1p-5 * terms) {
    weights = {exact_difference(c.x, b.y, c.y, b.x), exact_difference(a.x, c.y, a.y, c.x),
               exact_difference(b.x, a.y, b.y, a.x)};
    if (weights.differ()) return std::nullopt;
    area = weights.u + weights.v + weights.w;
    if (area == 0) return std::nullopt;
  }
  return (weights.u * a.z + weights.v * b.z + weights.w * c.z) / area * ray.scale_z;
}

}  // namespace scan::synth
