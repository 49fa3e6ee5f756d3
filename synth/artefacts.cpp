// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/artefacts.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "libscan/core/error.h"

namespace scan::synth {
namespace {

constexpr double deg = std::numbers::pi / 180;

void require(bool fulfilled, const std::string& field, double value, const std::string& limit) {
  if (fulfilled) return;
  throw Error(Trouble::input,
              "artefacts/" + field + " is " + std::to_string(value) + " m, " + limit);
}

// From a frame at the volume's centre with the scanner's axes, z towards the scanner, so that a
// body's +z faces it; x stays.
Pose world_from_volume(const Artefacts& artefacts, const Pose& world_from_scanner) {
  Pose pose = Pose::Identity();
  pose.linear() =
      world_from_scanner.linear() * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  pose.translation() = artefacts.centre_m;
  return pose;
}

Pose placed(const Eigen::Vector3d& at,
            const Eigen::Matrix3d& turned = Eigen::Matrix3d::Identity()) {
  Pose pose = Pose::Identity();
  pose.translation() = at;
  pose.linear() = turned;
  return pose;
}

Object body(const std::string& name, const Pose& world_from_object, Shape shape) {
  return {.name = name, .world_from_object = world_from_object, .geometry = std::move(shape)};
}

// Of the index in base 2, 3 or 5: spread over [0, 1) (Halton 1960).
double radical_inverse(int index, int base) {
  double inverse = 0, digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) inverse += digit * (index % base);
  return inverse;
}

Eigen::Matrix3d turned(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

// A flat box whose upper face is z = 0.
Object slab(const std::string& name, const Pose& world_from_face, double width_m, double height_m) {
  const double thickness_m = 0.1 * std::min(width_m, height_m);
  return body(name, world_from_face * placed({0, 0, -thickness_m / 2}),
              BoxShape{{width_m, height_m, thickness_m}, 0});
}

// A strip of two triangles per facet along x, the height constant across.
Mesh waves(double edge_m, double period_m) {
  const auto facets = static_cast<std::uint32_t>(std::ceil(32 * edge_m / period_m));
  Mesh mesh;
  for (std::uint32_t i = 0; i <= facets; ++i) {
    const double x_m = std::min(i * period_m / 32 - edge_m / 2, edge_m / 2);
    const double height_m =
        wave_amplitude_m(period_m) * std::cos(2 * std::numbers::pi * x_m / period_m);
    for (const double y_m : {-edge_m / 2, edge_m / 2})
      mesh.vertices.push_back({x_m, y_m, height_m});
    if (i == facets) break;
    mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  return mesh;
}

}  // namespace

Artefacts with_sizes(Artefacts artefacts) {
  const double diagonal_m = artefacts.volume_m.norm();
  const auto fill = [&](double& size_m, double share) {
    if (size_m == 0) size_m = share * diagonal_m;
  };
  fill(artefacts.ball_diameter_m, 0.1);
  fill(artefacts.bar_length_m, 0.35);
  fill(artefacts.plate_m, 0.5);
  fill(artefacts.cylinder_diameter_m, 0.1);
  fill(artefacts.step_m, 0.01);
  return artefacts;
}

void check(const Artefacts& artefacts) {
  require(artefacts.volume_m.allFinite() && artefacts.volume_m.minCoeff() > 0, "volume_m",
          artefacts.volume_m.minCoeff(), "its edges must be positive");
  require(artefacts.centre_m.allFinite(), "centre_m", artefacts.centre_m.sum(), "must be finite");
  const Artefacts sized = with_sizes(artefacts);
  const double least_m = artefacts.volume_m.minCoeff(), diagonal_m = artefacts.volume_m.norm();
  for (const auto& [name, size_m, most_m] :
       {std::tuple("ball_diameter_m", sized.ball_diameter_m, least_m),
        std::tuple("bar_length_m", sized.bar_length_m, diagonal_m),
        std::tuple("plate_m", sized.plate_m, diagonal_m),
        std::tuple("cylinder_diameter_m", sized.cylinder_diameter_m, least_m),
        std::tuple("step_m", sized.step_m, least_m)})
    require(size_m > 0 && size_m < most_m, name, size_m,
            "must be positive and fit into the volume: below " + std::to_string(most_m));
}

std::vector<PlacedObjects> ball_places(const Artefacts& sized, const Pose& world_from_scanner) {
  const Pose from_volume = world_from_volume(sized, world_from_scanner);
  const double radius_m = sized.ball_diameter_m / 2;
  const Eigen::Vector3d room_m = sized.volume_m - Eigen::Vector3d::Constant(sized.ball_diameter_m);
  std::vector<PlacedObjects> places;
  for (int i = 1; i <= 10; ++i) {
    const Eigen::Vector3d share(radical_inverse(i, 2), radical_inverse(i, 3),
                                radical_inverse(i, 5));
    const Eigen::Vector3d at = room_m.cwiseProduct(share - Eigen::Vector3d::Constant(0.5));
    places.push_back({body("ball", from_volume * placed(at), SphereShape{radius_m})});
  }
  return places;
}

std::vector<PlacedObjects> bar_places(const Artefacts& sized, const Pose& world_from_scanner) {
  const Pose from_volume = world_from_volume(sized, world_from_scanner);
  const SphereShape ball{sized.ball_diameter_m / 2};
  std::vector<PlacedObjects> places;
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1, 1, 0),
        Eigen::Vector3d(1, -1, 0), Eigen::Vector3d(1, 0, 0.6), Eigen::Vector3d(0, 1, 0.6),
        Eigen::Vector3d(1, 1, 0.6)}) {
    const Eigen::Vector3d half = sized.bar_length_m / 2 * direction.normalized();
    places.push_back({body("first ball", from_volume * placed(half), ball),
                      body("second ball", from_volume * placed(-half), ball)});
  }
  return places;
}

std::vector<PlacedObjects> plate_places(const Artefacts& sized, const Pose& world_from_scanner) {
  const Pose from_volume = world_from_volume(sized, world_from_scanner);
  std::vector<PlacedObjects> places;
  const auto add = [&](const Pose& volume_from_face) {
    places.push_back({slab("plate", from_volume * volume_from_face, sized.plate_m, sized.plate_m)});
  };
  for (const double share : {-0.4, 0.0, 0.4}) add(placed({0, 0, share * sized.volume_m.z()}));
  for (const double angle : {-30 * deg, 30 * deg})
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)})
      add(placed({0, 0, 0}, turned(angle, axis)));
  return places;
}

std::vector<PlacedObjects> cylinder_places(const Artefacts& sized, const Pose& world_from_scanner) {
  const Pose from_volume = world_from_volume(sized, world_from_scanner);
  const Eigen::Matrix3d upright = turned(90 * deg, Eigen::Vector3d::UnitX());
  std::vector<PlacedObjects> places;
  for (const double angle : {0.0, 45 * deg, 90 * deg})
    places.push_back(
        {body("cylinder",
              from_volume * placed({0, 0, 0}, turned(angle, Eigen::Vector3d::UnitZ()) * upright),
              CylinderShape{sized.cylinder_diameter_m / 2, 4 * sized.cylinder_diameter_m})});
  return places;
}

std::vector<PlacedObjects> step_places(const Artefacts& sized, const Pose& world_from_scanner) {
  const Pose from_volume = world_from_volume(sized, world_from_scanner);
  const double edge_m = sized.plate_m;
  std::vector<PlacedObjects> places;
  for (const double angle : {0.0, 90 * deg, 180 * deg, 270 * deg}) {
    const Pose around = from_volume * placed({0, 0, 0}, turned(angle, Eigen::Vector3d::UnitZ()));
    places.push_back(
        {slab("lower", around * placed({-edge_m / 4, 0, 0}), edge_m / 2, edge_m),
         slab("upper", around * placed({edge_m / 4, 0, sized.step_m}), edge_m / 2, edge_m)});
  }
  return places;
}

double wave_amplitude_m(double period_m) {
  return 0.05 * period_m;
}

PlacedObjects wave_plate(const Artefacts& sized, const Pose& world_from_scanner, double period_m,
                         WaveAxis axis) {
  const Pose from_volume = world_from_volume(sized, world_from_scanner);
  const double angle = axis == WaveAxis::x ? 0 : 90 * deg;
  return {{.name = "wave plate",
           .world_from_object =
               from_volume * placed({0, 0, 0}, turned(angle, Eigen::Vector3d::UnitZ())),
           .geometry = waves(sized.plate_m, period_m)}};
}

}  // namespace scan::synth
