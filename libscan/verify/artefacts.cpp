// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fits of calibrated bodies and what remains of them.
#include "libscan/verify/artefacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr double left_out = 0.003;  // of the points, at most

void check_places(std::size_t places, const char* test) {
  if (places == 0) throw Error(Trouble::input, std::string(test) + ": no place was measured");
}

double farther_from_zero(double a, double b) {
  return std::abs(b) > std::abs(a) ? b : a;
}

// Indices of the residuals without the 0.3 % that are farthest from their median.
std::vector<std::size_t> kept(std::span<const double> residuals_m) {
  std::vector<std::size_t> order(residuals_m.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto by_value = [&](std::size_t a, std::size_t b) {
    return residuals_m[a] < residuals_m[b];
  };
  std::sort(order.begin(), order.end(), by_value);
  const double middle = residuals_m[order[order.size() / 2]];
  auto drop =
      static_cast<std::size_t>(std::floor(left_out * static_cast<double>(residuals_m.size())));
  auto low = order.begin(), high = order.end();
  for (; drop > 0; --drop) {
    const bool low_is_farther = middle - residuals_m[*low] > residuals_m[*(high - 1)] - middle;
    low_is_farther ? ++low : --high;
  }
  return {low, high};
}

template <class Residual>
std::vector<double> each(const Points& points, Residual&& residual) {
  std::vector<double> residuals_m;
  residuals_m.reserve(points.size());
  for (const auto& x : points) residuals_m.push_back(residual(x));
  return residuals_m;
}

std::vector<double> residuals_of(const Points& points, const SphereFit& fit) {
  return each(points,
              [&](const Eigen::Vector3d& x) { return (x - fit.centre_m).norm() - fit.radius_m; });
}

std::vector<double> residuals_of(const Points& points, const PlaneFit& fit) {
  return each(points, [&](const Eigen::Vector3d& x) { return fit.normal.dot(x - fit.point_m); });
}

std::vector<double> residuals_of(const Points& points, const CylinderFit& fit) {
  return each(points, [&](const Eigen::Vector3d& x) {
    return (x - fit.axis.point_m).cross(fit.axis.direction).norm() - fit.radius_m;
  });
}

Points without_outliers(const Points& points, std::span<const double> residuals_m) {
  Points inner;
  for (const std::size_t i : kept(residuals_m)) inner.push_back(points[i]);
  return inner;
}

// A fit repeated without the points that its first residuals leave out.
template <class Fit>
auto refitted(const Points& points, Fit&& fit) {
  return fit(without_outliers(points, residuals_of(points, fit(points))));
}

// The largest form over places, and the points of all of them.
struct LargestForm {
  Form form;
  std::size_t points = 0;
  void add(std::span<const double> residuals_m) {
    const Form of = form_of(residuals_m);
    form.range_m = std::max(form.range_m, of.range_m);
    form.width_95_m = std::max(form.width_95_m, of.width_95_m);
    points += residuals_m.size();
  }
};

std::string over_places(std::size_t places, const char* what) {
  return std::string(what) + " over " + std::to_string(places) + " places";
}

Measurement figure(const char* name, double value, const char* unit, std::string over,
                   std::size_t count) {
  return {.name = name, .value = value, .unit = unit, .over = std::move(over), .count = count};
}

}  // namespace

Form form_of(std::span<const double> residuals_m) {
  if (residuals_m.empty()) throw Error(Trouble::input, "form: no points");
  std::vector<double> inner;
  for (const std::size_t i : kept(residuals_m)) inner.push_back(residuals_m[i]);
  std::vector<double> sorted(residuals_m.begin(), residuals_m.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = sorted.size();
  const auto held = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(n)));
  double width_m = sorted.back() - sorted.front();
  for (std::size_t i = 0; i + held <= n; ++i)
    width_m = std::min(width_m, sorted[i + held - 1] - sorted[i]);
  return {inner.back() - inner.front(), width_m};
}

std::vector<Measurement> probing_errors(std::span<const Points> balls, double true_diameter_m) {
  check_places(balls.size(), "probing error");
  LargestForm largest;
  double size_m = 0;
  for (const Points& ball : balls) {
    const SphereFit fit = refitted(ball, [](const Points& p) { return fit_sphere(p); });
    largest.add(residuals_of(ball, fit));
    size_m = farther_from_zero(size_m, 2 * fit.radius_m - true_diameter_m);
  }
  return {figure("probing_form", largest.form.range_m, "m",
                 over_places(balls.size(), "largest range of the residuals"), largest.points),
          figure("probing_form_95", largest.form.width_95_m, "m",
                 over_places(balls.size(), "largest width that holds 95 %"), largest.points),
          figure("probing_size", size_m, "m",
                 over_places(balls.size(), "fitted less true diameter, farthest from 0"),
                 largest.points)};
}

std::vector<Measurement> spacing_errors(std::span<const BallBar> bars, double true_length_m) {
  check_places(bars.size(), "sphere spacing");
  double error_m = 0;
  std::size_t points = 0;
  const auto centre = [](const Points& ball) {
    return refitted(ball, [](const Points& p) { return fit_sphere(p); }).centre_m;
  };
  for (const BallBar& bar : bars) {
    const double length_m = (centre(bar.first) - centre(bar.second)).norm();
    error_m = farther_from_zero(error_m, length_m - true_length_m);
    points += bar.first.size() + bar.second.size();
  }
  return {figure("sphere_spacing_error", error_m, "m",
                 over_places(bars.size(), "fitted less true distance of centres, farthest from 0"),
                 points)};
}

std::vector<Measurement> flatness_errors(std::span<const Points> plates) {
  check_places(plates.size(), "flatness");
  LargestForm largest;
  for (const Points& plate : plates)
    largest.add(residuals_of(plate, refitted(plate, [](const Points& p) { return fit_plane(p); })));
  return {figure("flatness", largest.form.range_m, "m",
                 over_places(plates.size(), "largest range of the residuals"), largest.points),
          figure("flatness_95", largest.form.width_95_m, "m",
                 over_places(plates.size(), "largest width that holds 95 %"), largest.points)};
}

std::vector<Measurement> cylinder_errors(std::span<const CylinderPlace> places,
                                         double true_diameter_m) {
  check_places(places.size(), "cylinder");
  LargestForm largest;
  double diameter_m = 0, angle_rad = 0;
  for (const CylinderPlace& place : places) {
    const CylinderFit fit =
        refitted(place.points, [&](const Points& p) { return fit_cylinder(p, place.true_axis); });
    largest.add(residuals_of(place.points, fit));
    diameter_m = farther_from_zero(diameter_m, 2 * fit.radius_m - true_diameter_m);
    const Eigen::Vector3d &a = fit.axis.direction, &b = place.true_axis.direction;
    angle_rad = std::max(angle_rad, std::atan2(a.cross(b).norm(), std::abs(a.dot(b))));
  }
  const auto over = [&](const char* what) { return over_places(places.size(), what); };
  return {figure("cylinder_diameter_error", diameter_m, "m",
                 over("fitted less true diameter, farthest from 0"), largest.points),
          figure("cylindricity", largest.form.range_m, "m", over("largest range of the residuals"),
                 largest.points),
          figure("cylindricity_95", largest.form.width_95_m, "m",
                 over("largest width that holds 95 %"), largest.points),
          figure("cylinder_axis_error", angle_rad, "rad",
                 over("largest angle between fitted and true axis"), largest.points)};
}

std::vector<Measurement> step_errors(std::span<const Step> steps, double true_height_m) {
  check_places(steps.size(), "step");
  double error_m = 0;
  std::size_t points = 0;
  const auto plane = [](const Points& face) {
    return refitted(face, [](const Points& p) { return fit_plane(p); });
  };
  for (const Step& step : steps) {
    const PlaneFit lower = plane(step.lower);
    const double height_m = std::abs(lower.normal.dot(plane(step.upper).point_m - lower.point_m));
    error_m = farther_from_zero(error_m, height_m - true_height_m);
    points += step.lower.size() + step.upper.size();
  }
  return {figure("step_error", error_m, "m",
                 over_places(steps.size(), "measured less true height, farthest from 0"), points)};
}

std::vector<Measurement> length_errors(std::span<const PlacedBall> balls) {
  if (balls.size() < 2) throw Error(Trouble::input, "length error: needs two balls at least");
  Points centres;
  std::size_t points = 0;
  for (const PlacedBall& ball : balls) {
    centres.push_back(
        refitted(ball.points, [](const Points& p) { return fit_sphere(p); }).centre_m);
    points += ball.points.size();
  }
  double error_m = 0;
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      error_m =
          farther_from_zero(error_m, (centres[i] - centres[k]).norm() -
                                         (balls[i].true_centre - balls[k].true_centre).norm());
  const std::size_t pairs = balls.size() * (balls.size() - 1) / 2;
  return {figure("length_error", error_m, "m",
                 "fitted less true distance of centres, farthest from 0 over " +
                     std::to_string(pairs) + " pairs of balls",
                 points)};
}

std::vector<Measurement> relative_range_errors(std::span<const PlacedPlate> plates,
                                               const Eigen::Vector3d& line) {
  check_places(plates.size(), "relative range");
  double first_m = 0, error_m = 0;
  std::size_t points = 0;
  for (const PlacedPlate& plate : plates) {
    const PlaneFit fit = refitted(plate.points, [](const Points& p) { return fit_plane(p); });
    const double behind_m =
        fit.normal.dot(fit.point_m - plate.true_point) / fit.normal.dot(line.normalized());
    if (&plate == &plates.front()) first_m = behind_m;
    error_m = farther_from_zero(error_m, behind_m - first_m);
    points += plate.points.size();
  }
  return {figure("relative_range_error", error_m, "m",
                 over_places(plates.size(), "distance behind the first plate, farthest from 0"),
                 points)};
}

Measurement repeatability(const Measurement& of, std::span<const double> values) {
  if (values.size() < 2) throw Error(Trouble::input, "repeatability: needs two values at least");
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  for (const double value : values) squares += (value - sum / n) * (value - sum / n);
  return {.name = of.name + "_repeatability",
          .value = std::sqrt(squares / (n - 1)),
          .unit = of.unit,
          .over = "repetitions with other noise",
          .count = values.size()};
}

}  // namespace scan
