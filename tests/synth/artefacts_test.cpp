// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Bodies stand inside their volume, have their sizes, and show the scanner what is measured of
// them.
#include "synth/artefacts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "libscan/core/error.h"

namespace scan::synth {
namespace {

const Artefacts artefacts = with_sizes({.volume_m = {0.4, 0.3, 0.2}, .centre_m = {1, 2, 3}});

// Looks along +y of the world, with world z up.
Pose scanner() {
  Pose pose = Pose::Identity();
  pose.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  pose.translation() = Eigen::Vector3d(1, 1, 3);
  return pose;
}

PlacedShape shape_of(const Object& body) {
  return {body.world_from_object, std::get<Shape>(body.geometry)};
}

TEST(Artefacts, SizesAreSharesOfTheDiagonal) {
  const double diagonal = std::sqrt(0.29);
  EXPECT_DOUBLE_EQ(artefacts.ball_diameter_m, 0.1 * diagonal);
  EXPECT_DOUBLE_EQ(artefacts.bar_length_m, 0.35 * diagonal);
  EXPECT_DOUBLE_EQ(with_sizes({.volume_m = {1, 1, 1}, .plate_m = 0.2}).plate_m, 0.2);
}

// In the scanner's axes, about the centre.
TEST(Artefacts, BallsStandInsideTheVolume) {
  const auto places = ball_places(artefacts, scanner());
  ASSERT_EQ(places.size(), 10u);
  for (const PlacedObjects& place : places) {
    ASSERT_EQ(place.size(), 1u);
    const auto& ball = std::get<SphereShape>(std::get<Shape>(place[0].geometry));
    EXPECT_DOUBLE_EQ(2 * ball.radius_m, artefacts.ball_diameter_m);
    const Eigen::Vector3d from_centre =
        scanner().linear().transpose() *
        (place[0].world_from_object.translation() - artefacts.centre_m);
    const Eigen::Array3d room = artefacts.volume_m.array() / 2 - ball.radius_m;
    EXPECT_TRUE((from_centre.array().abs() <= room + 1e-12).all()) << from_centre.transpose();
  }
}

// Neither ball hides the other: from the scanner their discs lie apart.
TEST(Artefacts, BarsHaveTheirLengthAndBothBallsAreSeen) {
  const auto places = bar_places(artefacts, scanner());
  ASSERT_EQ(places.size(), 7u);
  for (const PlacedObjects& place : places) {
    const Eigen::Vector3d a = place[0].world_from_object.translation();
    const Eigen::Vector3d b = place[1].world_from_object.translation();
    EXPECT_NEAR((a - b).norm(), artefacts.bar_length_m, 1e-14);
    const Eigen::Vector3d to_a = a - scanner().translation(), to_b = b - scanner().translation();
    const auto half_angle = [](const Eigen::Vector3d& to) {
      return std::asin(artefacts.ball_diameter_m / 2 / to.norm());
    };
    EXPECT_GT(std::acos(to_a.normalized().dot(to_b.normalized())),
              half_angle(to_a) + half_angle(to_b));
  }
}

// A ray down the middle of the sight meets the measured face, at most 30 degrees from its normal,
// and the two faces of a step differ by its height along it.
TEST(Artefacts, FacesLookAtTheScanner) {
  const Eigen::Vector3d back = -scanner().linear().col(2);
  for (const PlacedObjects& place : plate_places(artefacts, scanner())) {
    const Pose& pose = place[0].world_from_object;
    EXPECT_GT(pose.linear().col(2).dot(back), std::cos(0.5236));
    const double half = std::get<BoxShape>(std::get<Shape>(place[0].geometry)).size_m.z() / 2;
    const Eigen::Vector3d face = pose * Eigen::Vector3d(0, 0, half);
    EXPECT_NEAR(field(shape_of(place[0]), face).value_m, 0, 1e-12);
    EXPECT_LE(std::abs((face - artefacts.centre_m).dot(back)), 0.4 * 0.2 + 1e-12);
  }
  for (const PlacedObjects& place : step_places(artefacts, scanner())) {
    const auto height = [&](const Object& slab) {
      const double half = std::get<BoxShape>(std::get<Shape>(slab.geometry)).size_m.z() / 2;
      return back.dot(slab.world_from_object * Eigen::Vector3d(0, 0, half));
    };
    EXPECT_NEAR(height(place[1]) - height(place[0]), artefacts.step_m, 1e-14);
  }
  for (const PlacedObjects& place : cylinder_places(artefacts, scanner()))
    EXPECT_NEAR(place[0].world_from_object.linear().col(2).dot(back), 0, 1e-14);
}

// The mesh's vertices lie on the wave, crests at whole periods from the centre of the plate, which
// lies across the sight; normals point back to the scanner, and along y the wave is the same.
TEST(Artefacts, WavesRunAlongTheirAxisAndFaceTheScanner) {
  const Eigen::Vector3d back = -scanner().linear().col(2);
  const double period = artefacts.plate_m / 7.3;
  for (const WaveAxis axis : {WaveAxis::x, WaveAxis::y}) {
    const Object plate = wave_plate(artefacts, scanner(), period, axis).front();
    const Mesh& mesh = std::get<Mesh>(plate.geometry);
    const Eigen::Vector3d along = scanner().linear().col(axis == WaveAxis::x ? 0 : 1);
    Eigen::Vector3d low = artefacts.centre_m, high = low;
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      const Eigen::Vector3d x = plate.world_from_object * vertex;
      const double height =
          period / 20 *
          std::cos(2 * std::numbers::pi * (x - artefacts.centre_m).dot(along) / period);
      EXPECT_NEAR((x - artefacts.centre_m).dot(back), height, 1e-12);
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    EXPECT_NEAR((high - low).dot(scanner().linear().col(0).cwiseAbs()), artefacts.plate_m, 1e-12);
    EXPECT_NEAR((high - low).dot(scanner().linear().col(1).cwiseAbs()), artefacts.plate_m, 1e-12);
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3d a = mesh.vertices[t[0]];
      const Eigen::Vector3d normal =
          (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
      EXPECT_GT((plate.world_from_object.linear() * normal).dot(back), std::cos(0.305));
    }
  }
}

TEST(Artefacts, RefuseWhatDoesNotFit) {
  EXPECT_NO_THROW(check(artefacts));
  EXPECT_THROW(check(Artefacts{}), Error);
  EXPECT_THROW(check(Artefacts{.volume_m = {1, 1, -1}}), Error);
  EXPECT_THROW(check(Artefacts{.volume_m = {1, 1, 1}, .ball_diameter_m = 1.1}), Error);
  EXPECT_THROW(check(Artefacts{.volume_m = {1, 1, 1}, .step_m = -0.1}), Error);
}

}  // namespace
}  // namespace scan::synth
