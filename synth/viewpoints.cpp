// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/viewpoints.h"

#include <cmath>
#include <numbers>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/mesh.h"
#include "libscan/core/random.h"
#include "libscan/core/shortest.h"

namespace scan::synth {
namespace {

constexpr double full_turn_rad = 2 * std::numbers::pi;

void require(bool fulfilled, const std::string& field, double value, const char* limit) {
  if (fulfilled) return;
  throw Error(Trouble::input, "viewpoints/" + field + " is " + shortest(value) + ", " + limit);
}

void check_circle(int count, double radius_m, const Eigen::Vector3d& centre_m) {
  require(count >= 1, "count", count, "must be at least 1");
  require(std::isfinite(radius_m) && radius_m > 0, "radius_m", radius_m, "must be positive");
  require(centre_m.allFinite(), "centre_m", centre_m.sum(), "must be finite");
}

void check_layout(const Turntable& turntable) {
  check_circle(turntable.count, turntable.radius_m, turntable.centre_m);
  require(std::isfinite(turntable.height_m), "height_m", turntable.height_m, "must be finite");
}

void check_layout(const Ring& ring) {
  check_circle(ring.count, ring.radius_m, ring.centre_m);
  require(std::isfinite(ring.height_m), "height_m", ring.height_m, "must be finite");
  require(std::isfinite(ring.start_rad), "start_rad", ring.start_rad, "must be finite");
  require(std::abs(ring.sweep_rad) <= full_turn_rad * (1 + 1e-9), "sweep_rad", ring.sweep_rad,
          "must be a turn at most");
}

void check_layout(const Dome& dome) {
  check_circle(dome.count, dome.radius_m, dome.centre_m);
  require(dome.lowest_rad >= -std::numbers::pi / 2 && dome.lowest_rad < std::numbers::pi / 2,
          "lowest_rad", dome.lowest_rad, "must be from -pi/2 to below pi/2");
}

void check_layout(const PoseList& list) {
  require(!list.world_from_scanner.empty(), "poses", 0, "must be at least 1");
  for (std::size_t i = 0; i < list.world_from_scanner.size(); ++i) {
    const Pose& pose = list.world_from_scanner[i];
    const Eigen::Matrix3d r = pose.linear();
    const double error = (r.transpose() * r - Eigen::Matrix3d::Identity()).norm();
    require(pose.matrix().allFinite() && error < 1e-9 && r.determinant() > 0,
            "poses/" + std::to_string(i) + "/deviation from a rotation", error,
            "must be below 1e-9 (and no reflection)");
  }
}

Pose on_circle(const Eigen::Vector3d& centre, double radius_m, double height_m, double angle_rad) {
  const Eigen::Vector3d eye = centre + Eigen::Vector3d(radius_m * std::cos(angle_rad),
                                                       radius_m * std::sin(angle_rad), height_m);
  return look_at(eye, centre, Eigen::Vector3d::UnitZ());
}

std::vector<Pose> poses_of(const Ring& ring) {
  const bool closed = std::abs(ring.sweep_rad) > full_turn_rad * (1 - 1e-9);
  const int intervals = closed ? ring.count : std::max(1, ring.count - 1);
  std::vector<Pose> poses;
  poses.reserve(ring.count);
  for (int i = 0; i < ring.count; ++i)
    poses.push_back(on_circle(ring.centre_m, ring.radius_m, ring.height_m,
                              ring.start_rad + ring.sweep_rad * i / intervals));
  return poses;
}

std::vector<Pose> poses_of(const Turntable& t) {
  return poses_of(Ring{t.count, t.radius_m, t.height_m, 0, full_turn_rad, t.centre_m});
}

// Points of equal area along a spiral (Gonzalez 2010, "Measurement of areas on a sphere using
// Fibonacci and latitude-longitude lattices").
std::vector<Pose> poses_of(const Dome& dome) {
  const double golden_rad = std::numbers::pi * (3 - std::sqrt(5.0));
  const double height = 1 - std::sin(dome.lowest_rad);
  std::vector<Pose> poses;
  for (int i = 0; i < dome.count; ++i) {
    const double z = 1 - height * (i + 0.5) / dome.count;
    const double radius = std::sqrt(1 - z * z);
    poses.push_back(
        on_circle(dome.centre_m, dome.radius_m * radius, dome.radius_m * z, golden_rad * i));
  }
  return poses;
}

std::vector<Pose> poses_of(const PoseList& list) {
  return list.world_from_scanner;
}

Eigen::Vector3d random_direction(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(x, y, z).normalized();
}

// The solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983, eq. 8).
double solid_angle_sr(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double above = a.dot(b.cross(c));
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(above, below);
}

bool is_inside(const Shape& shape, const Eigen::Vector3d& x) {
  return field(shape, x).value_m < 0;
}

bool is_inside(const Mesh& mesh, const Eigen::Vector3d& x) {
  double whole_sr = 0;
  for (const auto& [i, j, k] : mesh.triangles)
    whole_sr += solid_angle_sr(mesh.vertices[i] - x, mesh.vertices[j] - x, mesh.vertices[k] - x);
  return whole_sr > 2 * std::numbers::pi && edge_census(mesh).boundary_edges == 0;
}

}  // namespace

void check(const Viewpoints& viewpoints) {
  std::visit([](const auto& layout) { check_layout(layout); }, viewpoints.layout);
  const auto& [rotation_rad, translation_m] = viewpoints.pose_noise;
  require(std::isfinite(rotation_rad) && rotation_rad >= 0, "pose_noise/rotation_rad", rotation_rad,
          "must not be negative");
  require(std::isfinite(translation_m) && translation_m >= 0, "pose_noise/translation_m",
          translation_m, "must not be negative");
}

std::vector<Pose> true_poses(const Viewpoints& viewpoints) {
  check(viewpoints);
  return std::visit([](const auto& layout) { return poses_of(layout); }, viewpoints.layout);
}

std::vector<Pose> guessed_poses(const Viewpoints& viewpoints, std::uint64_t seed) {
  constexpr std::uint64_t address = ~std::uint64_t{0};  // of no ray
  std::vector<Pose> poses = true_poses(viewpoints);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    RandomStream random(seed, static_cast<std::uint32_t>(i), address);
    const Eigen::Vector3d axis = random_direction(random), shift = random_direction(random);
    const double angle_rad = viewpoints.pose_noise.rotation_rad * random.normal();
    const double distance_m = viewpoints.pose_noise.translation_m * random.normal();
    poses[i].linear() = Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix() * poses[i].linear();
    poses[i].translation() += distance_m * shift;
  }
  return poses;
}

void check_standing(const Scene& scene, std::span<const Pose> world_from_scanner) {
  for (std::size_t i = 0; i < world_from_scanner.size(); ++i)
    for (const Object& object : scene.objects) {
      if (std::holds_alternative<Dielectric>(scene.materials[object.material].bsdf)) continue;
      const Eigen::Vector3d x_in_object =
          object.world_from_object.inverse() * world_from_scanner[i].translation();
      if (std::visit([&](const auto& geometry) { return is_inside(geometry, x_in_object); },
                     object.geometry))
        throw Error(Trouble::input, "viewpoints: scanner " + std::to_string(i) +
                                        " stands inside the object '" + object.name +
                                        "', must be outside");
    }
}

}  // namespace scan::synth
