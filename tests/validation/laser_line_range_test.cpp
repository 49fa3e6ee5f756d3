// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

constexpr double albedo = 0.5;
constexpr double narrowest_px = 0.4;  // of the decoder's fit; three samples hardly fix less

LaserLine scanner() {
  LaserLine scanner;
  scanner.camera = {
      .width_px = 160, .height_px = 60, .fx_px = 400, .fy_px = 400, .cx_px = 79.5, .cy_px = 29.5};
  scanner.beam_radius_m = 8e-4;  // about 1 px, 1 sigma, in the image
  scanner.steps = 31;
  scanner.step_m = 2e-3;
  scanner.sensor = {.gain_e_per_dn = 10, .offset_dn = 8, .bits = 10};
  return scanner;
}

// One camera row at one step: what its pixels see.
struct Row {
  const LaserLine& scanner;
  const StripeImages& frames;
  const RayCaster& caster;
  Pose scanner_from_camera;
  double row;

  // At a column: signed distance of the surface from the light plane, and the logarithm of its
  // brightness but for the beam's profile (cosine over distance, see laser_line.h). None in the
  // void and where the light comes from behind.
  struct Seen {
    double from_plane_m;
    double log_brightness;
  };
  std::optional<Seen> at(double column) const {
    const Eigen::Vector3d direction = ray_through(scanner.camera, {column, row})->normalized();
    const auto hit = caster.closest(scanner_from_camera.translation(), direction);
    if (!hit) return std::nullopt;
    const Eigen::Vector3d x = hit->distance_m * direction;  // the stage does not turn
    const double from_plane_m =
        frames.calibration.plane_normal.dot(x) - frames.calibration.plane_offset_m;
    const Eigen::Vector3d source =
        Eigen::Vector3d(scanner.baseline_m, 0, 0) + from_plane_m * frames.calibration.plane_normal;
    const double length_m = (x - source).norm();
    const double brightness_1_m = -hit->normal.dot(x - source) / (length_m * length_m);
    if (!(brightness_1_m > 0)) return std::nullopt;
    return Seen{from_plane_m, std::log(brightness_1_m)};
  }
};

// The stripe across the row is exp(-2 delta^2 / w^2) g with delta = a s + b s^2 the distance from
// the light plane s columns beside its true place, and ln g = const + gamma s. To first order this
// is a Gaussian of sigma = w / 2a times 1 + gamma s - (b / a) s^3 / sigma^2. Least squares move its
// centre by sigma^2 (gamma - k b / a), k = 3 for weights 1 / m (moments of the Gaussian, 3 sigma^4
// / sigma^2) and k = 1.5 for equal weights (those of its square); 3 is the bound. Terms of second
// order are smaller by that shift over sigma, times a factor below 10. Then half a step of rounding
// in each reading, in the worst combination of signs: (step / 2) sum |s| / N with the window's sum
// |s| <= 9 sigma^2 + 3 sigma + 1 and N = sqrt(2 pi) sigma H electrons.
struct ColumnError {
  double first_px, second_px, rounding_px;
};
ColumnError column_error(double sigma_px, double gamma, double b_over_a, double height_e,
                         double step_e) {
  const double shift_px = sigma_px * sigma_px * (std::abs(gamma) + 3 * std::abs(b_over_a));
  const double electrons = std::sqrt(2 * std::numbers::pi) * sigma_px * height_e;
  const double window = 9 * sigma_px * sigma_px + 3 * sigma_px + 1;
  return {shift_px, 10 * shift_px * shift_px / sigma_px, step_e / 2 * window / electrons};
}

// What the decoder leaves of the first order where the rows around tell it the shift: for the light
// that the beam's profile spreads to a place it takes what the place gets when the stage has
// carried the sheet there. But the stage does not move across the sheet: tan(angle) as far it
// carries the source along it, and light grows with 1 / r towards the source.
double left_px(const LaserLine& s, double sigma_px, double to_source_m) {
  return sigma_px * s.beam_radius_m / 2 * std::tan(s.triangulation_rad) / to_source_m;
}

// Along the camera's ray r(u), z = 1, the range is |r| offset / (n . r).
double range_m(const LaserLineCalibration& calibration, double column, double row) {
  const Eigen::Vector3d ray = *ray_through(calibration.camera, {column, row});
  return ray.norm() * calibration.plane_offset_m / calibration.plane_normal.dot(ray);
}

// None where the expansion does not hold: where the stripe is narrower than the decoder fits,
// within 4 sigma of the limb, or where the first-order terms are no longer small. There the stripe
// is cut or skewed, as a real one is (Curless and Levoy 1995).
std::optional<double> bound_m(const Row& row, const RayTruth& truth, bool is_corrected) {
  if (truth.object < 0) return std::nullopt;
  const LaserLine& s = row.scanner;
  const Eigen::Vector3d x = row.scanner_from_camera.inverse() * truth.point_in_scanner;
  const double u = project(s.camera, x)->x();
  const double h = 0.25;  // px
  const auto before = row.at(u - h), here = row.at(u), after = row.at(u + h);
  if (!before || !here || !after) return std::nullopt;
  const double a = (after->from_plane_m - before->from_plane_m) / (2 * h);
  const double b =
      (after->from_plane_m + before->from_plane_m - 2 * here->from_plane_m) / (2 * h * h);
  const double gamma = (after->log_brightness - before->log_brightness) / (2 * h);
  const double sigma_px = s.beam_radius_m / (2 * std::abs(a));
  if (sigma_px < narrowest_px) return std::nullopt;
  if (!row.at(u - 4 * sigma_px) || !row.at(u + 4 * sigma_px)) return std::nullopt;
  if (sigma_px * (std::abs(gamma) + 3 * std::abs(b / a)) > 0.1) return std::nullopt;
  const double focus_m = s.baseline_m / std::sin(s.triangulation_rad);
  const double height_e = s.peak_electrons * albedo * focus_m * std::exp(here->log_brightness) /
                          std::cos(s.triangulation_rad);
  const LaserLineCalibration& calibration = row.frames.calibration;
  const ColumnError error =
      column_error(sigma_px, gamma, b / a, height_e, calibration.sensor.gain_e_per_dn);
  const double to_source_m = (x - Eigen::Vector3d(s.baseline_m, 0, 0)).norm();
  const double error_px = (is_corrected ? left_px(s, sigma_px, to_source_m) : error.first_px) +
                          error.second_px + error.rounding_px;
  return std::abs(range_m(calibration, u + error_px, row.row) -
                  range_m(calibration, u - error_px, row.row)) /
         2;
}

void check_range(const Target& target, std::size_t least_points, bool is_flat) {
  const LaserLine s = scanner();
  const RayCaster caster(target.scene);
  const RawFrames raw = render(s, caster, Pose::Identity(), {}, no_effects).frames;
  const auto& frames = std::get<StripeImages>(raw);
  const std::vector<RayTruth> truth = true_rays(s, caster, Pose::Identity());
  const Scan scan = acquire(raw);
  const RangeFigures figures = compare(
      scan, truth,
      [&](std::size_t ray) -> Eigen::Vector3d {
        return frames.scanner_from_camera[ray / s.camera.height_px].translation();
      },
      [&](std::size_t ray) {
        const Pose& scanner_from_camera = frames.scanner_from_camera[ray / s.camera.height_px];
        const auto row = static_cast<double>(ray % s.camera.height_px);
        const bool has_rows_around = row > 0 && row < s.camera.height_px - 1;
        return bound_m({s, frames, caster, scanner_from_camera, row}, truth[ray],
                       is_flat && has_rows_around);
      });
  print("laser line", target.name, figures);
  EXPECT_GE(figures.points, least_points);
}

TEST(LaserLineRange, OfAPlaneIsExactButForTheStripesWidth) {
  check_range(plane_target(0.18, {.name = "grey", .bsdf = Lambert{albedo}, .texture = {}}), 1500,
              true);
}

TEST(LaserLineRange, OfASphereIsExactButForTheStripesWidth) {
  check_range(sphere_target(0.2, 0.025, {.name = "grey", .bsdf = Lambert{albedo}, .texture = {}}),
              500, false);
}

}  // namespace
}  // namespace scan::synth
