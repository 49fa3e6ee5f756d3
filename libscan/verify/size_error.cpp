// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/size_error.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include "libscan/core/shape.h"

namespace scan {
namespace {

constexpr double pi = std::numbers::pi;

struct Size {
  double area_m2 = 0;
  std::optional<double> volume_m3 = {};  // none for an open surface
};

struct SizeOf {
  std::optional<Size> operator()(const PlaneShape&) const { return std::nullopt; }
  std::optional<Size> operator()(const SphereShape& s) const {
    return Size{4 * pi * s.radius_m * s.radius_m, 4 * pi / 3 * std::pow(s.radius_m, 3)};
  }
  std::optional<Size> operator()(const CylinderShape& s) const {
    return Size{2 * pi * s.radius_m * (s.radius_m + s.height_m),
                pi * s.radius_m * s.radius_m * s.height_m};
  }
  // A box of size l, rounded by r, is the box l - 2 r grown by a ball (Steiner's formula).
  std::optional<Size> operator()(const BoxShape& s) const {
    const double r = s.rounding_m;
    const Eigen::Vector3d l = s.size_m - Eigen::Vector3d::Constant(2 * r);
    const double faces = 2 * (l.x() * l.y() + l.y() * l.z() + l.z() * l.x());
    return Size{faces + 2 * pi * r * l.sum() + 4 * pi * r * r,
                l.prod() + r * faces + pi * r * r * l.sum() + 4 * pi / 3 * r * r * r};
  }
  // Pappus.
  std::optional<Size> operator()(const TorusShape& s) const {
    return Size{4 * pi * pi * s.major_radius_m * s.minor_radius_m,
                2 * pi * pi * s.major_radius_m * s.minor_radius_m * s.minor_radius_m};
  }
  std::optional<Size> operator()(const CombinedShape&) const { return std::nullopt; }
};

Size size_of(const Mesh& mesh) {
  const EdgeCensus census = edge_census(mesh);
  const bool closed = census.watertight && census.non_manifold_vertices == 0;
  return {area_m2(mesh), closed ? std::optional(volume_m3(mesh)) : std::nullopt};
}

std::optional<Size> size_of(const TrueSurface& truth) {
  if (truth.shapes.size() + truth.meshes.size() != 1) return std::nullopt;
  if (!truth.meshes.empty()) return size_of(truth.meshes.front());
  return std::visit(SizeOf(), truth.shapes.front().shape);
}

}  // namespace

std::vector<Measurement> size_error(const Mesh& measured, const TrueSurface& truth) {
  check(measured);
  const std::optional<Size> whole = size_of(truth);
  if (!whole) return {};
  const Size found = size_of(measured);
  std::vector<Measurement> errors;
  const auto add = [&](const char* name, double ratio, const char* over) {
    errors.push_back({.name = name,
                      .value = ratio - 1,
                      .unit = "1",
                      .over = over,
                      .count = measured.triangles.size()});
  };
  add("area_error", found.area_m2 / whole->area_m2, "the true area");
  if (found.volume_m3 && whole->volume_m3)
    add("volume_error", *found.volume_m3 / *whole->volume_m3, "the true volume");
  return errors;
}

}  // namespace scan
