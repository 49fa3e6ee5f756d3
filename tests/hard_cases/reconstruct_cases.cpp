// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/hard_cases/reconstruct_cases.h"

#include <cmath>
#include <limits>

#include "tests/reconstruct/solids.h"

namespace scan {
namespace {

double from_torus(const Eigen::Vector3d& x) {
  return std::abs(std::hypot(std::hypot(x[0], x[1]) - 1, x[2]) - 0.35);
}

PointCloud moved(PointCloud cloud, double scale, const Eigen::Vector3d& offset) {
  for (auto& x : cloud.points) x = scale * x + offset;
  return cloud;
}

PointCloud plane_cloud(double height_m, double side) {
  PointCloud cloud;
  RandomStream random(7, 0, side > 0 ? 1 : 2);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(), y = random.uniform();
    cloud.points.push_back({x, y, height_m});
    cloud.normals.push_back(side * Eigen::Vector3d::UnitZ());
  }
  return cloud;
}

PointCloud two_sheets() {
  PointCloud cloud = plane_cloud(0.04, 1);
  append(cloud, plane_cloud(0, -1));
  return cloud;
}

PointCloud line_cloud() {
  PointCloud cloud;
  for (int i = 0; i < 200; ++i) cloud.points.push_back({0.01 * i, 0.02 * i, -0.01 * i});
  return cloud;
}

PointCloud with_broken_entries(PointCloud cloud) {
  for (std::size_t i = 0; i < 30; ++i) {
    cloud.points[10 * i][i % 3] = std::numeric_limits<double>::quiet_NaN();
    cloud.normals[10 * i + 1][i % 3] = std::numeric_limits<double>::infinity();
    cloud.normals[10 * i + 2].setZero();
    cloud.normals[10 * i + 3] *= 1e3;
  }
  return cloud;
}

PointCloud without_normals(PointCloud cloud) {
  cloud.normals.clear();
  return cloud;
}

template <class Keep>
PointCloud part_of(const PointCloud& cloud, Keep keep) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (keep(cloud.points[i], cloud.normals[i])) kept.push_back(i);
  return subset(cloud, kept);
}

// Every point twice, facing both ways.
PointCloud contradictory(PointCloud cloud) {
  const PointCloud once = cloud;
  for (auto& n : cloud.normals) n = -n;
  append(cloud, once);
  return cloud;
}

double from_sphere(const Eigen::Vector3d& x) {
  return std::abs(x.norm() - 1);
}

// The sphere, a million times as dense at its north pole as at its south pole.
PointCloud uneven_sphere() {
  RandomStream random(8, 0, 0);
  return part_of(sphere_cloud(40'000), [&](const Eigen::Vector3d& x, const Eigen::Vector3d&) {
    return random.uniform() < std::pow(1e6, (x[2] - 1) / 2);
  });
}

// A ball of radius 1 m squeezed to 4 cm across, one cell of SSD at the depth given below; samples
// even on the ball.
constexpr double needle_width = 0.04;

PointCloud needle() {
  PointCloud cloud = sphere_cloud(2000);
  const Eigen::Vector3d size(1, needle_width, needle_width);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.points[i] = cloud.points[i].cwiseProduct(size);
    cloud.normals[i] = cloud.normals[i].cwiseQuotient(size).normalized();
  }
  return cloud;
}

// To first order, from the ellipsoid's equation.
double from_needle(const Eigen::Vector3d& x) {
  const Eigen::Vector3d size(1, needle_width, needle_width);
  const Eigen::Vector3d q = x.cwiseQuotient(size), gradient = q.cwiseQuotient(size) / q.norm();
  return std::abs(q.norm() - 1) / gradient.norm();
}

// A lattice on a cube's faces, one spacing short of the edges, which may be rounded by as much: its
// middle lines lie on corners of cells at every depth.
PointCloud lattice() {
  PointCloud cloud;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5})
      for (int i = 1; i < 16; ++i)
        for (int j = 1; j < 16; ++j) {
          Eigen::Vector3d x;
          x[axis] = side;
          x[(axis + 1) % 3] = i / 16.0 - 0.5;
          x[(axis + 2) % 3] = j / 16.0 - 0.5;
          cloud.points.push_back(x);
          cloud.normals.push_back(2 * side * Eigen::Vector3d::Unit(axis));
        }
  return cloud;
}

// Samples of the torus lie 0.083 apart: surfaces within a third of that are right.
constexpr double near = 0.083 / 3;

std::vector<HardCase> cases_of_one_torus(const PointCloud& torus) {
  const Eigen::Vector3d far(1e7, -1e7, 1e7);
  return {
      {"plain", torus, Answer::surface, from_torus, near},
      {"no normals", without_normals(torus), Answer::surface, from_torus, near},
      {"broken entries", with_broken_entries(torus), Answer::surface, from_torus, near},
      {"1e-6 m small", moved(torus, 1e-6, Eigen::Vector3d::Zero()), Answer::surface,
       [](const Eigen::Vector3d& x) { return 1e-6 * from_torus(1e6 * x); }, 1e-6 * near},
      {"1e6 m large", moved(torus, 1e6, Eigen::Vector3d::Zero()), Answer::surface,
       [](const Eigen::Vector3d& x) { return 1e6 * from_torus(1e-6 * x); }, 1e6 * near},
      {"1e7 m away", moved(torus, 1, far), Answer::surface,
       [far](const Eigen::Vector3d& x) { return from_torus(x - far); }, near},
  };
}

std::vector<HardCase> cases_of_shapes(const PointCloud& torus) {
  const auto from_plane = [](const Eigen::Vector3d& x) { return std::abs(x[2]); };
  return {
      {"coplanar", plane_cloud(0, 1), Answer::either, from_plane, 0.01},
      {"two sheets", two_sheets(), Answer::either,
       [](const Eigen::Vector3d& x) { return std::min(std::abs(x[2]), std::abs(x[2] - 0.04)); },
       0.03},
      {"one scan",
       part_of(torus, [](const auto& x,
                         const auto& n) { return n.dot(Eigen::Vector3d(0, 0, 8) - x) > 0; }),
       Answer::surface, from_torus, near},
      {"disc",
       part_of(plane_cloud(0, 1),
               [](const auto& x, const auto&) {
                 return (x - Eigen::Vector3d(0.5, 0.5, 0)).norm() < 0.5;
               }),
       Answer::either, from_plane, 0.01},
      {"half-sphere",
       part_of(sphere_cloud(4000), [](const auto& x, const auto&) { return x[2] > 0; }),
       Answer::surface, from_sphere, 0.056 / 3},
      {"density ratio 1e6", uneven_sphere(), Answer::surface, from_sphere, 0.05},
      {"needle", needle(), Answer::surface, from_needle, needle_width / 2},
      {"points on cell corners", lattice(), Answer::surface,
       [](const auto& x) { return std::abs(from_cube(x)); }, 1.0 / 16},
      {"contradictory normals", contradictory(torus), Answer::either, from_torus, near},
  };
}

std::vector<HardCase> cases_without_a_surface(const PointCloud& torus) {
  PointCloud one_place;
  one_place.points.assign(100, Eigen::Vector3d(1, 2, 3));
  one_place.normals.assign(100, Eigen::Vector3d::UnitX());
  return {
      {"collinear", line_cloud(), Answer::error, {}, 0},
      {"identical", one_place, Answer::error, {}, 0},
      {"three points", subset(torus, std::vector<std::uint32_t>{1, 2, 3}), Answer::error, {}, 0},
      {"empty", {}, Answer::error, {}, 0},
  };
}

}  // namespace

std::vector<HardCase> hard_cases() {
  const PointCloud torus = torus_cloud(2000);
  std::vector<HardCase> cases;
  for (const auto& some :
       {cases_of_one_torus(torus), cases_of_shapes(torus), cases_without_a_surface(torus)})
    cases.insert(cases.end(), some.begin(), some.end());
  return cases;
}

std::vector<Eigen::Vector3d> scanners_of(const PointCloud& cloud) {
  const Bounds box = bounds_of(cloud.points);
  const double size = box.isEmpty() ? 1 : box.sizes().maxCoeff();
  const bool is_torus = !box.isEmpty() && std::abs(box.sizes()[2] / size - 0.26) < 0.02;
  std::vector<Eigen::Vector3d> scanners;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3d normal = i < cloud.normals.size() ? cloud.normals[i] : Eigen::Vector3d::UnitZ();
    if (is_torus) {
      const Eigen::Vector3d x = (cloud.points[i] - box.center()) * (2.7 / size);
      const Eigen::Vector3d ring(x[0], x[1], 0);
      normal = (x - ring.normalized()).normalized();
    }
    scanners.push_back(cloud.points[i] + 0.1 * size * normal);
  }
  return scanners;
}

}  // namespace scan
