// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Orthogonal-distance fits of surfaces of revolution: cylinder, cone and torus.
//
// With the axis turned to +z and through the origin, the distance of a point to such a surface is a
// function d of its distance rho from the axis, its height z and a few sizes. All that depends on
// the place of the axis is common (Forbes 1989, NPL report DITC 140/89): moving it by (u, v, w) and
// tilting it to (a, b, 1) changes d by
//   -d_rho (x u + y v) / rho - d_z w + (x a + y b) (d_z - d_rho z / rho).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "libscan/core/error.h"
#include "libscan/verify/fit.h"
#include "libscan/verify/fit_points.h"

namespace scan {
namespace {

// d at (rho, z), its slopes, and its derivatives by the sizes.
struct Profile {
  double d = 0, d_rho = 0, d_z = 0;
  Eigen::Vector2d by_size = Eigen::Vector2d::Zero();
};

struct CylinderProfile {  // size: radius
  static constexpr int sizes = 1;
  static constexpr bool has_height = false;  // moving it along the axis changes something
  static constexpr const char* name = "cylinder";
  static Profile at(double rho, double /*z*/, const Eigen::Vector2d& size) {
    return {rho - size(0), 1, 0, {-1, 0}};
  }
};

struct ConeProfile {  // sizes: half-angle, and the radius at z = 0 times its cosine
  static constexpr int sizes = 2;
  static constexpr bool has_height = false;  // the second size does that
  static constexpr const char* name = "cone";
  static Profile at(double rho, double z, const Eigen::Vector2d& size) {
    const double c = std::cos(size(0)), s = std::sin(size(0));
    return {rho * c - z * s - size(1), c, -s, {-rho * s - z * c, -1}};
  }
};

struct TorusProfile {  // sizes: major and minor radius
  static constexpr int sizes = 2;
  static constexpr bool has_height = true;
  static constexpr const char* name = "torus";
  static Profile at(double rho, double z, const Eigen::Vector2d& size) {
    const double from_ring = std::max(std::hypot(rho - size(0), z), 1e-300);
    const double out = (rho - size(0)) / from_ring, up = z / from_ring;
    return {from_ring - size(1), out, up, {-out, -1}};
  }
};

struct Placed {
  Eigen::Matrix3d axis_from_world = Eigen::Matrix3d::Identity();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Zero();

  Eigen::MatrixX3d in_axis(const Eigen::MatrixX3d& x) const {
    return (x.rowwise() - point.transpose()) * axis_from_world.transpose();
  }
  Eigen::Vector3d direction() const { return axis_from_world.row(2).transpose(); }
};

template <class Surface>
Eigen::VectorXd distances(const Eigen::MatrixX3d& x, const Placed& placed) {
  const Eigen::MatrixX3d in_axis = placed.in_axis(x);
  Eigen::VectorXd d(x.rows());
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    d(i) = Surface::at(std::hypot(in_axis(i, 0), in_axis(i, 1)), in_axis(i, 2), placed.size).d;
  return d;
}

// Columns: u, v, a, b, the sizes, and w if it acts.
template <class Surface>
Eigen::MatrixXd jacobian(const Eigen::MatrixX3d& x, const Placed& placed) {
  const Eigen::MatrixX3d in_axis = placed.in_axis(x);
  Eigen::MatrixXd j(x.rows(), 4 + Surface::sizes + (Surface::has_height ? 1 : 0));
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double z = in_axis(i, 2);
    const double rho = std::max(std::hypot(in_axis(i, 0), in_axis(i, 1)), 1e-300);
    const Eigen::RowVector2d out = in_axis.row(i).head<2>() / rho;
    const Profile p = Surface::at(rho, z, placed.size);
    j.row(i).head<2>() = -p.d_rho * out;
    j.row(i).segment<2>(2) = out * (rho * p.d_z - z * p.d_rho);
    j.row(i).template segment<Surface::sizes>(4) = p.by_size.head<Surface::sizes>().transpose();
    if (Surface::has_height) j(i, 4 + Surface::sizes) = -p.d_z;
  }
  return j;
}

template <class Surface>
Placed moved(const Placed& from, const Eigen::VectorXd& step) {
  Placed to = from;
  Eigen::Vector3d shift(step(0), step(1), 0);
  if (Surface::has_height) shift.z() = step(4 + Surface::sizes);
  to.point += from.axis_from_world.transpose() * shift;
  const Eigen::Vector3d tilted = Eigen::Vector3d(step(2), step(3), 1).normalized();
  to.axis_from_world =
      Eigen::Quaterniond::FromTwoVectors(tilted, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
      from.axis_from_world;
  to.size.head<Surface::sizes>() += step.segment<Surface::sizes>(4);
  return to;
}

// Gauss-Newton with halved steps while a step does not lower the sum of squares; rounding alone
// may raise it once the steps are as small.
template <class Surface>
Placed minimise(const Eigen::MatrixX3d& x, Placed placed) {
  Eigen::VectorXd d = distances<Surface>(x, placed);
  for (int iteration = 0; iteration < 200; ++iteration) {
    Eigen::VectorXd step = fit_step(jacobian<Surface>(x, placed), -d, Surface::name);
    if (step.norm() < 1e-12) return moved<Surface>(placed, step);
    Placed next = moved<Surface>(placed, step);
    Eigen::VectorXd next_d = distances<Surface>(x, next);
    while (step.norm() > 1e-9 && !(next_d.squaredNorm() < d.squaredNorm())) {
      step /= 2;
      next = moved<Surface>(placed, step);
      next_d = distances<Surface>(x, next);
    }
    placed = next;
    d = next_d;
  }
  throw Error(Trouble::computation,
              std::string(Surface::name) + " fit: no minimum found from the guess of the axis");
}

// The guess in the scaled frame, its point moved beside the centroid (not for a torus).
Placed placed_at(const Axis& guess, const FitPoints& scaled, bool beside_centroid,
                 const char* shape) {
  const double length = guess.direction.norm();
  if (!(length > 0) || !std::isfinite(length) || !guess.point_m.allFinite())
    throw Error(Trouble::computation, std::string(shape) + " fit: the guess is no axis");
  const Eigen::Vector3d direction = guess.direction / length;
  Placed placed;
  placed.axis_from_world =
      Eigen::Quaterniond::FromTwoVectors(direction, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  placed.point = (guess.point_m - scaled.centroid_m) / scaled.scale_m;
  if (beside_centroid) placed.point -= direction * direction.dot(placed.point);
  return placed;
}

template <class Surface>
double rms_m(const FitPoints& scaled, const Placed& placed) {
  const Eigen::VectorXd d = distances<Surface>(scaled.points, placed);
  return scaled.scale_m * std::sqrt(d.squaredNorm() / static_cast<double>(d.size()));
}

Eigen::VectorXd radii(const Eigen::MatrixX3d& in_axis) {
  return in_axis.leftCols<2>().rowwise().norm();
}

// The centre line's radius and the tube's, from a circle through the points' profiles (rho, z).
Eigen::Vector2d guessed_torus(const Eigen::MatrixX3d& in_axis) {
  const Eigen::VectorXd rho = radii(in_axis);
  Eigen::MatrixXd a(in_axis.rows(), 2);
  a << 2 * rho, Eigen::VectorXd::Ones(in_axis.rows());
  const Eigen::VectorXd squares = rho.array().square() + in_axis.col(2).array().square();
  const Eigen::Vector2d ring = fit_step(a, squares, "torus");
  return {ring(0), std::sqrt(std::max(ring(1) + ring(0) * ring(0), 1e-6))};
}

// Of the points on the axis the one nearest to the centroid, which is the origin.
Eigen::Vector3d nearest_to_origin(const Placed& placed) {
  return placed.point - placed.direction() * placed.direction().dot(placed.point);
}

}  // namespace

CylinderFit fit_cylinder(std::span<const Eigen::Vector3d> points, const Axis& guess) {
  const FitPoints scaled = fit_points(points, 5, "cylinder");
  Placed placed = placed_at(guess, scaled, true, "cylinder");
  placed.size(0) = radii(placed.in_axis(scaled.points)).mean();
  placed = minimise<CylinderProfile>(scaled.points, placed);
  if (!(placed.size(0) > 0)) throw_undetermined("cylinder");
  return {{scaled.centroid_m + scaled.scale_m * nearest_to_origin(placed), placed.direction()},
          scaled.scale_m * placed.size(0),
          rms_m<CylinderProfile>(scaled, placed)};
}

ConeFit fit_cone(std::span<const Eigen::Vector3d> points, const Axis& guess) {
  const FitPoints scaled = fit_points(points, 6, "cone");
  Placed placed = placed_at(guess, scaled, true, "cone");
  const Eigen::MatrixX3d in_axis = placed.in_axis(scaled.points);
  Eigen::MatrixXd line(in_axis.rows(), 2);
  line << in_axis.col(2), Eigen::VectorXd::Ones(in_axis.rows());
  const Eigen::Vector2d slope = fit_step(line, radii(in_axis), "cone");
  placed.size = Eigen::Vector2d(std::atan(slope(0)), slope(1) * std::cos(std::atan(slope(0))));
  placed = minimise<ConeProfile>(scaled.points, placed);
  const double angle = placed.size(0);
  if (!(std::abs(angle) < std::numbers::pi / 2)) throw_undetermined("cone");
  const Eigen::Vector3d point = nearest_to_origin(placed);
  const double height = placed.direction().dot(point - placed.point);
  const double radius = placed.size(1) / std::cos(angle) + height * std::tan(angle);
  const double way = angle < 0 ? -1 : 1;
  return {{scaled.centroid_m + scaled.scale_m * point, way * placed.direction()},
          way * angle,
          scaled.scale_m * radius,
          rms_m<ConeProfile>(scaled, placed)};
}

TorusFit fit_torus(std::span<const Eigen::Vector3d> points, const Axis& guess) {
  const FitPoints scaled = fit_points(points, 7, "torus");
  Placed placed = placed_at(guess, scaled, false, "torus");
  placed.size = guessed_torus(placed.in_axis(scaled.points));
  placed = minimise<TorusProfile>(scaled.points, placed);
  if (!(placed.size.minCoeff() > 0)) throw_undetermined("torus");
  return {{scaled.centroid_m + scaled.scale_m * placed.point, placed.direction()},
          scaled.scale_m * placed.size(0),
          scaled.scale_m * placed.size(1),
          rms_m<TorusProfile>(scaled, placed)};
}

}  // namespace scan
