// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/sampling/warp.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace scan::synth {
namespace {

using std::numbers::pi;

Eigen::Vector3d polar(double cosine, double sine, double angle) {
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

double square(double x) {
  return x * x;
}

// Two unit vectors at right angles to the unit vector z (z.z >= 0) and to each other, the first
// level.
std::pair<Eigen::Vector3d, Eigen::Vector3d> level_frame(const Eigen::Vector3d& z) {
  const double length2 = square(z.x()) + square(z.y());
  const Eigen::Vector3d x =
      length2 > 0 ? Eigen::Vector3d(Eigen::Vector3d(-z.y(), z.x(), 0) / std::sqrt(length2))
                  : Eigen::Vector3d::UnitX();
  return {x, z.cross(x)};
}

}  // namespace

Eigen::Vector2d to_disk(const Eigen::Vector2d& u) {
  const double x = 2 * u.x() - 1, y = 2 * u.y() - 1;
  if (x == 0 && y == 0) return {0, 0};
  const bool wide = std::abs(x) > std::abs(y);
  const double radius = wide ? x : y;
  const double angle = wide ? pi / 4 * (y / x) : pi / 2 - pi / 4 * (x / y);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

double disk_density(const Eigen::Vector2d& point) {
  return point.squaredNorm() <= 1 ? 1 / pi : 0;
}

Eigen::Vector3d to_sphere(const Eigen::Vector2d& u) {
  const double z = 1 - 2 * u.x();
  return polar(z, std::sqrt(std::max(0.0, 1 - z * z)), 2 * pi * u.y());
}

double sphere_density() {
  return 1 / (4 * pi);
}

Eigen::Vector3d to_hemisphere(const Eigen::Vector2d& u) {
  const double z = 1 - u.x();
  return polar(z, std::sqrt(std::max(0.0, 1 - z * z)), 2 * pi * u.y());
}

double hemisphere_density(const Eigen::Vector3d& direction) {
  return direction.z() >= 0 ? 1 / (2 * pi) : 0;
}

Eigen::Vector3d to_cosine_hemisphere(const Eigen::Vector2d& u) {
  // Malley: what is uniform on the disk is cosine-weighted on the hemisphere above it
  const Eigen::Vector2d base = to_disk(u);
  return {base.x(), base.y(), std::sqrt(std::max(0.0, 1 - base.squaredNorm()))};
}

double cosine_hemisphere_density(const Eigen::Vector3d& direction) {
  return std::max(0.0, direction.z()) / pi;
}

Eigen::Vector3d to_beckmann_normal(const Eigen::Vector2d& u, double roughness) {
  const double tangent2 = -square(roughness) * std::log1p(-u.x());
  const double cosine = 1 / std::sqrt(1 + tangent2);
  return polar(cosine, std::sqrt(tangent2) * cosine, 2 * pi * u.y());
}

double beckmann_normal_density(const Eigen::Vector3d& normal, double roughness) {
  const double z = normal.z();
  if (!(z > 0)) return 0;
  const double tangent2 = (square(normal.x()) + square(normal.y())) / square(z);
  return std::exp(-tangent2 / square(roughness)) / (pi * square(roughness) * z * z * z);
}

Eigen::Vector3d to_ggx_visible_normal(const Eigen::Vector2d& u, const Eigen::Vector3d& out,
                                      double roughness) {
  // Heitz 2018, "Sampling the GGX Distribution of Visible Normals", listing's steps: stretch the
  // ellipsoid to a sphere, project a half disk each of its lit and its upper part, stretch back.
  const Eigen::Vector3d view =
      Eigen::Vector3d(roughness * out.x(), roughness * out.y(), out.z()).normalized();
  const auto [x, y] = level_frame(view);
  const double radius = std::sqrt(u.x()), angle = 2 * pi * u.y();
  const double a = radius * std::cos(angle);
  const double share = (1 + view.z()) / 2;
  const double b =
      (1 - share) * std::sqrt(std::max(0.0, 1 - a * a)) + share * radius * std::sin(angle);
  const double c = std::sqrt(std::max(0.0, 1 - a * a - b * b));
  const Eigen::Vector3d normal = a * x + b * y + c * view;
  return Eigen::Vector3d(roughness * normal.x(), roughness * normal.y(), std::max(0.0, normal.z()))
      .normalized();
}

double ggx_visible_normal_density(const Eigen::Vector3d& normal, const Eigen::Vector3d& out,
                                  double roughness) {
  const double cosine = out.dot(normal);
  if (!(out.z() > 0 && normal.z() > 0 && cosine > 0)) return 0;
  const double alpha2 = square(roughness);
  const double sine2 = square(normal.x()) + square(normal.y());
  // D(h) = alpha^2 / (pi (alpha^2 cos^2 + sin^2)^2)
  const double distribution = alpha2 / (pi * square(alpha2 * square(normal.z()) + sine2));
  // G1(out) / out.z = 2 / (out.z + sqrt(out.z^2 + alpha^2 sin^2)): finite at grazing angles
  const double reach2 = square(out.z()) + alpha2 * (square(out.x()) + square(out.y()));
  return 2 * distribution * cosine / (out.z() + std::sqrt(reach2));
}

}  // namespace scan::synth
