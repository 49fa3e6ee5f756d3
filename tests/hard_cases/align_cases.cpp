// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/hard_cases/align_cases.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/align/test_shapes.h"

namespace scan::test {
namespace {

using Eigen::Vector3d;

HardCase bumpy(const std::string& name, std::set<Stop> wanted = {Stop::converged}) {
  const auto [source, target] = split(bumpy_surface(1600, 1), 2);
  RandomStream random(3, 0, 0);
  HardCase made{.name = name, .source = source, .target = target, .wanted = std::move(wanted)};
  made.guess = random_pose(random, 0.03, 0.03);
  made.options.max_iterations = 300;
  return made;
}

PointCloud slice(const PointCloud& cloud, double from, double to) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.points[i].x() >= from && cloud.points[i].x() <= to) kept.push_back(i);
  return subset(cloud, kept);
}

void spoil(PointCloud& cloud, double share) {
  RandomStream random(4, 0, 0);
  for (Vector3d& x : cloud.points)
    if (random.uniform() < share) x[1] = std::nan("");
}

HardCase shape_case(const std::string& name, const PointCloud& source, const PointCloud& target) {
  HardCase made{.name = name, .source = source, .target = target, .wanted = {Stop::degenerate}};
  made.guess =
      make_pose(Eigen::AngleAxisd(0.05, Vector3d::UnitZ()).toRotationMatrix(), {0.02, 0.01, 0.01});
  made.options.max_iterations = 300;
  return made;
}

// Nine points in ten on a near wall, which leaves two slides and a turn open; the rest, far behind
// it, alone fixes them. Beside an exact wall any residual of the rest looks like an outlier's.
HardCase mixed_density(const std::string& name, double noise_m, std::set<Stop> wanted) {
  const auto with_wall = [&](const PointCloud& far, std::uint64_t seed) {
    PointCloud cloud = plane(9 * far.size(), seed);
    for (Vector3d& x : cloud.points) x *= 0.2;  // 2 x 2 m, as the rest
    add_noise(cloud, noise_m, seed);
    cloud.normals.assign(cloud.size(), Vector3d::UnitZ());
    for (std::size_t i = 0; i < far.size(); ++i) {
      cloud.points.push_back(far.points[i] + Vector3d(0, 0, 4));
      cloud.normals.push_back(far.normals[i]);
    }
    return cloud;
  };
  HardCase made = bumpy(name, std::move(wanted));
  made.source = with_wall(made.source, 1);
  made.target = with_wall(made.target, 2);
  return made;
}

std::vector<HardCase> cases_of_points() {
  std::vector<HardCase> cases;
  for (const double share : {0.01, 0.5}) {
    cases.push_back(bumpy(share < 0.1 ? "H1 1 % not finite" : "H1 50 % not finite"));
    spoil(cases.back().source, share), spoil(cases.back().target, share);
  }
  cases.push_back(bumpy("H1 nothing finite", {Stop::too_few_points}));
  spoil(cases.back().source, 1);
  for (const std::uint32_t count : {0u, 1u, 5u}) {
    cases.push_back(bumpy("H2 points: " + std::to_string(count), {Stop::too_few_points}));
    std::vector<std::uint32_t> first(count);
    std::iota(first.begin(), first.end(), 0u);
    cases.back().source = subset(cases.back().source, first);
  }
  cases.push_back(bumpy("H13 all tenfold"));
  for (PointCloud* cloud : {&cases.back().source, &cases.back().target}) {
    const PointCloud once = *cloud;
    for (int i = 0; i < 9; ++i) append(*cloud, once);
  }
  return cases;
}

std::vector<HardCase> cases_of_guesses() {
  std::vector<HardCase> cases;
  cases.push_back(bumpy("H3 no overlap", {Stop::no_correspondences}));
  cases.back().guess = Eigen::Translation3d(100, 0, 0) * cases.back().guess;
  cases.push_back(bumpy("H4 two iterations", {Stop::iteration_limit}));
  cases.back().options.max_iterations = 2;
  cases.push_back(bumpy("H23 sheared guess"));
  cases.back().guess.linear()(0, 1) += 0.01;
  return cases;
}

std::vector<HardCase> cases_of_normals() {
  std::vector<HardCase> cases;
  cases.push_back(bumpy("H16 half of normals flipped"));
  for (std::size_t i = 0; i < cases.back().source.size(); i += 2)
    cases.back().source.normals[i] *= -1;
  cases.push_back(bumpy("H16 normals 30 degrees off"));
  for (Vector3d& n : cases.back().source.normals)
    n = Eigen::AngleAxisd(0.52, Vector3d::UnitX()) * n;
  return cases;
}

// Terraces of planes, all facing the same way: where a cloud lies along them is lost.
std::vector<HardCase> terraces() {
  std::vector<HardCase> cases;
  for (const int spacings : {2, 5}) {
    cases.push_back(
        bumpy("steps of " + std::to_string(spacings) + " spacings", {Stop::degenerate}));
    if (spacings == 5) cases.back().wanted.insert(Stop::iteration_limit);
    const double step_m = spacings * 0.07;
    for (PointCloud* cloud : {&cases.back().source, &cases.back().target}) {
      for (Vector3d& x : cloud->points) x.z() = step_m * std::round(x.z() / step_m);
      cloud->normals.clear();
    }
  }
  return cases;
}

}  // namespace

std::vector<HardCase> input_cases() {
  std::vector<HardCase> cases;
  for (const auto& some : {cases_of_points(), cases_of_guesses(), cases_of_normals(), terraces()})
    cases.insert(cases.end(), some.begin(), some.end());
  return cases;
}

std::vector<HardCase> frame_cases() {
  std::vector<HardCase> cases;
  cases.push_back(bumpy("H8 5,400 km off"));
  const Vector3d far(5e5, 5.4e6, 0);
  for (Vector3d& x : cases.back().source.points) x += far;
  for (Vector3d& x : cases.back().target.points) x += far;
  cases.back().guess = Eigen::Translation3d(far) * cases.back().guess * Eigen::Translation3d(-far);
  for (const double scale : {1e-6, 1e6}) {
    cases.push_back(bumpy(scale < 1 ? "H9 micrometres" : "H9 thousand km"));
    HardCase& made = cases.back();
    for (Vector3d& x : made.source.points) x *= scale;
    for (Vector3d& x : made.target.points) x *= scale;
    made.guess.translation() *= scale;
    made.scale = scale;
  }
  cases.push_back(bumpy("H10 both turned alike"));
  RandomStream random(5, 0, 0);
  const Pose turned = random_pose(random, 2, 0);
  cases.back().source = transformed(turned, cases.back().source);
  cases.back().target = transformed(turned, cases.back().target);
  cases.back().guess = turned * cases.back().guess * turned.inverse();
  cases.push_back(bumpy("H12 half a turn"));
  cases.back().truth = make_pose(
      Eigen::AngleAxisd(std::numbers::pi, Vector3d(0.6, 0, 0.8)).toRotationMatrix(), {1, 2, 3});
  cases.back().target = transformed(cases.back().truth, cases.back().target);
  cases.back().guess = cases.back().truth * cases.back().guess;
  // Steps of 2^-4 m at a million metres: a cloud of few places, whose pose is known to a step.
  cases.push_back(
      bumpy("H24 float at 1,000 km", {Stop::converged, Stop::degenerate, Stop::iteration_limit}));
  for (PointCloud* cloud : {&cases.back().source, &cases.back().target})
    for (Vector3d& x : cloud->points)
      x = (x + Vector3d::Constant(1e6)).cast<float>().cast<double>() - Vector3d::Constant(1e6);
  cases.back().scale = 3;
  return cases;
}

std::vector<HardCase> scene_cases() {
  std::vector<HardCase> cases;
  cases.push_back(shape_case("H5 plane", plane(1500, 1), plane(1500, 2)));
  cases.push_back(shape_case("H6 corridor", corridor(3000, 1), corridor(3000, 2)));
  cases.push_back(shape_case("H7 sphere", sphere(1500, 1), sphere(1500, 2)));
  cases.push_back(shape_case("H7 cylinder", closed_cylinder(3000, 1), closed_cylinder(3000, 2)));
  cases.push_back(shape_case("H7 cone", cone(1500, 1), cone(1500, 2)));
  cases.push_back(shape_case("H7 screw", spiral_ramp(1500, 1), spiral_ramp(1500, 2)));
  PointCloud line;
  for (int i = 0; i < 100; ++i) line.points.emplace_back(0.01 * i * i, 0, 0);
  cases.push_back(shape_case("H11 line", line, line));
  cases.back().guess = Pose(Eigen::Translation3d(0, 0.001, 0));
  cases.back().wanted = {Stop::degenerate, Stop::no_correspondences};
  cases.push_back(mixed_density("H14 nine in ten on a wall", 0.002, {Stop::converged}));
  cases.push_back(mixed_density("H14 the wall exact", 0,
                                {Stop::converged, Stop::degenerate, Stop::iteration_limit}));
  for (const int percent : {70, 50, 30}) {
    cases.push_back(bumpy("H15 " + std::to_string(percent) + " % overlap"));
    const double edge = 1 - 2 * (1 - percent / 100.0) / 2;
    cases.back().source = slice(cases.back().source, -1, edge);
    cases.back().target = slice(cases.back().target, -edge, 1);
    // What is left to point-to-point of a third is mostly rim: it says so.
    if (percent == 30) cases.back().wanted.insert(Stop::degenerate);
  }
  cases.push_back(bumpy("H15 5 % overlap", {Stop::low_overlap, Stop::degenerate,
                                            Stop::no_correspondences, Stop::iteration_limit}));
  cases.back().source = slice(cases.back().source, -1, 0.05);
  cases.back().target = slice(cases.back().target, -0.05, 1);
  return cases;
}

}  // namespace scan::test
