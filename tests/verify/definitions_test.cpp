// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Every figure that verify gives says what it is.
#include "libscan/verify/definitions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/verify/artefacts.h"
#include "libscan/verify/disparity_error.h"
#include "libscan/verify/pose_error.h"
#include "libscan/verify/self_intersection.h"
#include "libscan/verify/size_error.h"
#include "libscan/verify/stated_uncertainty.h"
#include "libscan/verify/structural_resolution.h"
#include "libscan/verify/surface_error.h"
#include "tests/core/meshes.h"

namespace scan {
namespace {

// Of the unit that the measurement has.
void expect_defined(const std::vector<Measurement>& figures,
                    FigureSource source = FigureSource::surface_or_run) {
  EXPECT_FALSE(figures.empty());
  for (const Measurement& figure : figures) {
    const auto definition = figure_definition(figure.name);
    ASSERT_TRUE(definition) << figure.name;
    EXPECT_EQ(definition->unit, figure.unit) << figure.name;
    EXPECT_EQ(definition->source, source) << figure.name;
  }
}

TEST(Definition, IsThereForEachSurfaceFigure) {
  const Mesh mesh = torus(3, 1, 12, 8);
  const TrueSurface truth{{}, {mesh}};
  expect_defined(surface_error(mesh, truth, {.samples = 100}));
  expect_defined(size_error(mesh, truth));
  expect_defined(topology(mesh));
  const std::vector<double> spacings(mesh.vertices.size());
  expect_defined({unsupported_area(mesh, spacings, 1)});
  if (const auto crossings = self_intersection(mesh)) expect_defined({*crossings});
}

TEST(Definition, IsThereForEachPoseAndRangeFigure) {
  const std::vector<Pose> poses(2, Pose::Identity());
  const std::vector<Eigen::Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector points(2, corners);
  expect_defined(summarise(pose_errors(poses, poses, points)));
  expect_defined(summarise_relative(relative_pose_errors(poses, poses, points)));
  expect_defined(target_registration_error(poses, poses, points, corners));
  PointCloud cloud;
  cloud.points = {{0, 0, 1}};
  cloud.sigma_m = {1};
  ScanTruth truth;
  truth.rays = {{{0, 0, 1}, {0, 0, -1}, 0}};
  expect_defined(range_error(cloud, std::vector<std::uint32_t>{0}, truth));
  expect_defined(stated_uncertainty("pose", {.squares = {1}, .degrees = 6}, ""));
  expect_defined(stated_uncertainty("surface", {.squares = {1}, .degrees = 1}, ""));
}

TEST(Definition, IsThereForEachArtefactAndDisparityFigure) {
  const auto expect_artefact = [](const std::vector<Measurement>& figures) {
    expect_defined(figures, FigureSource::artefact);
  };
  Points ball, plate;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      const double u = 0.2 * i, v = 0.2 * k;
      ball.push_back({std::cos(u) * std::cos(v), std::cos(u) * std::sin(v), std::sin(u)});
      plate.push_back({u, v, 0});
    }
  Points mantle;
  for (const auto& x : plate) mantle.push_back({std::cos(x.x()), std::sin(x.x()), x.y()});
  expect_artefact(probing_errors(std::vector<Points>{ball}, 2));
  expect_artefact(length_errors(std::vector<PlacedBall>(2, {ball, {0, 0, 0}})));
  expect_artefact(relative_range_errors(std::vector<PlacedPlate>{{plate, {0, 0, 0}}}, {0, 0, 1}));
  expect_artefact(
      {repeatability({.name = "probing_size", .unit = "m"}, std::vector<double>{1, 2})});
  EXPECT_NE(definition("merged_probing_form"), definition("probing_form"));
  expect_artefact(spacing_errors(std::vector{BallBar{ball, ball}}, 0));
  expect_artefact(flatness_errors(std::vector<Points>{plate}));
  expect_artefact(step_errors(std::vector{Step{plate, plate}}, 0));
  WavePlate waves{.edge_m = 2.4, .period_m = 0.8, .amplitude_m = 1};
  for (const auto& x : plate)
    for (const double a : {-1.1, 0.1})
      for (const double b : {-1.1, 0.1})
        waves.points.push_back(
            {x.x() + a, x.y() + b, std::cos(2.5 * std::numbers::pi * (x.x() + a))});
  expect_artefact({structural_resolution(std::vector<std::vector<WavePlate>>{{waves}})});
  expect_artefact(cylinder_errors(std::vector{CylinderPlace{mantle, {}}}, 2));
  Image<float> disparity(2, 2, 5.0F);
  expect_defined(disparity_error(disparity, disparity, 0), FigureSource::disparity);
}

TEST(Definition, OfAnUnknownNameIsEmpty) {
  EXPECT_EQ(definition("accuracy"), "");
  EXPECT_EQ(definition("accuracy_p9"), "");
  EXPECT_EQ(definition("merged_accuracy"), "");
  EXPECT_EQ(definition("accuracy_repeatability"), "");
}

TEST(Definition, OfASlipIsHintedAt) {
  EXPECT_EQ(figure_hint("acuracy_p95"), "did you mean 'accuracy_p95'?");
  EXPECT_EQ(figure_hint("pose_eror_rms"), "did you mean 'pose_error_rms'?");
  EXPECT_EQ(figure_hint("beauty"), "");
}

}  // namespace
}  // namespace scan
