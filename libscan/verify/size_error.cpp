// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/size_error.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include "libscan/core/shape.h"
#include "libscan/verify/solid_size.h"

namespace scan {
namespace {

constexpr double pi = std::numbers::pi;

// Exact ones are intervals without a length.
struct Size {
  Interval area_m2;
  std::optional<Interval> volume_m3 = {};  // none for an open surface
};

Size exactly(double area_m2, double volume_m3) {
  return {{area_m2, area_m2}, Interval{volume_m3, volume_m3}};
}

struct SizeOf {
  const Pose& parent_from_shape;

  std::optional<Size> operator()(const PlaneShape&) const { return std::nullopt; }
  std::optional<Size> operator()(const SphereShape& s) const {
    return exactly(4 * pi * s.radius_m * s.radius_m, 4 * pi / 3 * std::pow(s.radius_m, 3));
  }
  std::optional<Size> operator()(const CylinderShape& s) const {
    return exactly(2 * pi * s.radius_m * (s.radius_m + s.height_m),
                   pi * s.radius_m * s.radius_m * s.height_m);
  }
  // A box of size l, rounded by r, is the box l - 2 r grown by a ball (Steiner's formula).
  std::optional<Size> operator()(const BoxShape& s) const {
    const double r = s.rounding_m;
    const Eigen::Vector3d l = s.size_m - Eigen::Vector3d::Constant(2 * r);
    const double faces = 2 * (l.x() * l.y() + l.y() * l.z() + l.z() * l.x());
    return exactly(faces + 2 * pi * r * l.sum() + 4 * pi * r * r,
                   l.prod() + r * faces + pi * r * r * l.sum() + 4 * pi / 3 * r * r * r);
  }
  // Pappus.
  std::optional<Size> operator()(const TorusShape& s) const {
    return exactly(4 * pi * pi * s.major_radius_m * s.minor_radius_m,
                   2 * pi * pi * s.major_radius_m * s.minor_radius_m * s.minor_radius_m);
  }
  std::optional<Size> operator()(const CombinedShape& s) const {
    const PlacedShape solid{parent_from_shape, s};
    if (!bounds_of(solid).sizes().allFinite()) return std::nullopt;
    const SolidSize size = solid_size(solid);
    return Size{size.area_m2, size.volume_m3};
  }
};

Size size_of(const Mesh& mesh) {
  const EdgeCensus census = edge_census(mesh);
  const bool closed = census.watertight && census.non_manifold_vertices == 0;
  const double area = area_m2(mesh), volume = volume_m3(mesh);
  return {{area, area}, closed ? std::optional(Interval{volume, volume}) : std::nullopt};
}

std::optional<Size> size_of(const TrueSurface& truth) {
  if (truth.shapes.size() + truth.meshes.size() != 1) return std::nullopt;
  if (!truth.meshes.empty()) return size_of(truth.meshes.front());
  const PlacedShape& solid = truth.shapes.front();
  return std::visit(SizeOf{solid.parent_from_shape}, solid.shape);
}

}  // namespace

std::vector<Measurement> size_error(const Mesh& measured, const TrueSurface& truth) {
  check(measured);
  const std::optional<Size> whole = size_of(truth);
  if (!whole) return {};
  const Size found = size_of(measured);
  std::vector<Measurement> errors;
  const auto add = [&](const char* name, double is, const Interval& should, const char* over) {
    const double middle = (should.low + should.high) / 2;
    errors.push_back({.name = name,
                      .value = is / middle - 1,
                      .unit = "1",
                      .over = over,
                      .count = measured.triangles.size()});
    if (should.low < should.high)
      errors.back().interval = Interval{is / should.high - 1, is / should.low - 1};
  };
  add("area_error", found.area_m2.low, whole->area_m2, "the true area");
  if (found.volume_m3 && whole->volume_m3)
    add("volume_error", found.volume_m3->low, *whole->volume_m3, "the true volume");
  return errors;
}

}  // namespace scan
