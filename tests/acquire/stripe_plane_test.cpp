// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_plane.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "libscan/core/random.h"

namespace scan::calibrating {
namespace {

const Eigen::Vector3d normal = Eigen::Vector3d(0.8, 0.1, -0.6).normalized();
constexpr double offset_m = -0.2, stripe_sigma_m = 3e-5;

// A board and how sure its pose is: turns about its middle and shifts.
struct HeldBoard {
  Eigen::Vector3d middle_m, normal;
};
constexpr double turn_rad = 2e-3, shift_m = 1e-4;

const std::vector<HeldBoard> boards = {{{0, 0, 0.30}, {0.1, 0.5, -0.8}},
                                       {{0.05, 0, 0.38}, {-0.2, 0.1, -1}},
                                       {{0.1, 0.02, 0.45}, {0.3, -0.3, -0.9}},
                                       {{-0.03, -0.02, 0.27}, {0, 0, -1}}};

// The stripe as it is read when the board's pose and the columns are off.
BoardStripe seen_stripe(const HeldBoard& held, RandomStream& random) {
  Vector6 sigmas, off;
  sigmas << Eigen::Vector3d::Constant(turn_rad), Eigen::Vector3d::Constant(shift_m);
  for (int i = 0; i < 6; ++i) off[i] = sigmas[i] * random.normal();
  Matrix6 in_camera = Matrix6::Identity();  // a turn w about c moves the origin by c x w
  in_camera.bottomLeftCorner<3, 3>() = cross_matrix(held.middle_m);
  const Pose moved = exp((in_camera * off).eval());
  const Eigen::Vector3d upright = held.normal.normalized();
  BoardStripe stripe{{},
                     moved.linear() * upright,
                     in_camera * sigmas.cwiseAbs2().asDiagonal() * in_camera.transpose()};
  // The line where light and board meet, 41 points along 10 cm of it.
  const Eigen::Vector3d along = normal.cross(upright).normalized();
  Eigen::Matrix3d planes;
  planes << normal.transpose(), upright.transpose(), along.transpose();
  const Eigen::Vector3d start =
      planes.inverse() *
      Eigen::Vector3d(offset_m, upright.dot(held.middle_m), along.dot(held.middle_m));
  for (int i = -20; i <= 20; ++i) {
    const Eigen::Vector3d ray = start + 0.0025 * i * along;
    const Eigen::Vector3d place =
        ray * stripe.board_normal.dot(moved * held.middle_m) / stripe.board_normal.dot(ray);
    const Eigen::Vector3d shift = stripe_sigma_m * along.cross(upright);
    stripe.points.push_back({place + random.normal() * shift, shift});
  }
  return stripe;
}

// Chi-square of three unknowns over 200 fits: 600, standard deviation sqrt(1200), and of 161
// degrees of freedom each; 4 sigma. Most of what moves the points are the boards' poses.
TEST(StripePlane, IsOffByWhatPosesAndColumnsAreOff) {
  constexpr int fits = 200;
  double sum = 0, misfit2 = 0;
  for (std::uint64_t seed = 0; seed < fits; ++seed) {
    RandomStream random(seed, 0, 0);
    std::vector<BoardStripe> stripes;
    for (const HeldBoard& held : boards) stripes.push_back(seen_stripe(held, random));
    const StripePlane plane = fit_stripe_plane(stripes, 0.05);
    const double side = plane.normal.dot(normal) < 0 ? -1 : 1;
    Eigen::Vector3d off;
    off << plane.axes.transpose() * normal * side,
        side * (offset_m - normal.dot(plane.centre_m)) - plane.offset_m;
    sum += off.dot(plane.covariance.ldlt().solve(off));
    misfit2 += plane.misfit * plane.misfit / fits;
  }
  EXPECT_NEAR(sum, 3 * fits, 4 * std::sqrt(6.0 * fits));
  EXPECT_NEAR(misfit2, 1, 4 * std::sqrt(2.0 / (161 * fits)));
}

// Corners of a square that lie off the plane x = 0 by +a and -a in turn: the fit stays where it is,
// chi-square is 4 (a / sigma)^2 and one degree of freedom is left. Boards known to 1e-12 m and rad
// follow the points by a millionth of sigma.
TEST(StripePlane, MisfitCountsItsThreeUnknowns) {
  constexpr double a_m = 2e-6, sigma_m = 1e-6;
  BoardStripe stripe{{}, -Eigen::Vector3d::UnitZ(), 1e-24 * Matrix6::Identity()};
  for (int i = 0; i < 4; ++i)
    stripe.points.push_back(
        {{i == 0 || i == 3 ? a_m : -a_m, i % 2 ? 0.1 : -0.1, i / 2 ? 0.4 : 0.3}, {sigma_m, 0, 0}});
  const StripePlane plane = fit_stripe_plane(std::span(&stripe, 1), 0.05);
  EXPECT_NEAR(plane.misfit, 2 * a_m / sigma_m, 1e-4);
  EXPECT_NEAR(plane.rms_m, a_m, 1e-4 * a_m);
}

// Spread is that of the points across their longest direction, in their own plane.
TEST(StripePlane, TellsHowFarTheStripesSpread) {
  BoardStripe stripe{{}, -Eigen::Vector3d::UnitZ(), 1e-6 * Matrix6::Identity()};
  for (int i = 0; i < 4; ++i)
    stripe.points.push_back({{i % 2 ? 0.1 : -0.1, i / 2 ? 0.03 : -0.03, 1}, {0, 0, 1e-4}});
  EXPECT_NEAR(fit_stripe_plane(std::span(&stripe, 1), 0.5).spread, 0.3, 1e-12);
}

}  // namespace
}  // namespace scan::calibrating
