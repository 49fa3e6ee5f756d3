// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scene.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "synth/texture.h"

namespace scan::synth {
namespace {

Scene one_object(Texture texture = PlainTexture{}) {
  Scene scene;
  scene.materials.push_back({.name = "clay", .bsdf = Lambert{0.6}, .texture = texture});
  scene.objects.push_back({"ball", Pose::Identity(), Shape{SphereShape{0.1}}, 0});
  return scene;
}

std::string complaint_of(const Scene& scene) {
  try {
    check(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Scene, NamesWhatIsWrong) {
  EXPECT_EQ(complaint_of(one_object()), "");
  Scene scene = one_object();
  scene.materials[0].bsdf = Lambert{1.5};
  EXPECT_NE(complaint_of(scene).find("materials/clay/albedo is 1.5"), std::string::npos);
  scene = one_object(CheckerTexture{-1, 0.5});
  EXPECT_NE(complaint_of(scene).find("clay/texture/period_m"), std::string::npos);
  scene = one_object(NoiseTexture{0.01, 0, 0.5});
  EXPECT_NE(complaint_of(scene).find("octaves"), std::string::npos);
  scene = one_object();
  scene.objects[0].material = 1;
  EXPECT_NE(complaint_of(scene).find("objects/ball/material is 1"), std::string::npos);
  scene = one_object();
  scene.objects[0].world_from_object.linear() *= 1.01;
  EXPECT_NE(complaint_of(scene).find("no rigid motion"), std::string::npos);
  scene = one_object();
  scene.objects[0].geometry = Shape{SphereShape{-1}};
  EXPECT_NE(complaint_of(scene).find("objects/ball: sphere"), std::string::npos);
  scene.objects[0].geometry = Mesh{};
  EXPECT_NE(complaint_of(scene).find("no triangles"), std::string::npos);
}

TEST(Scene, GivesItsTrueSurfaceInTheWorld) {
  Scene scene = one_object();
  const Pose pose = exp((Vector6() << 0.1, 0.2, 0.3, 1, 2, 3).finished());
  scene.objects[0].world_from_object = pose;
  scene.objects.push_back({"sheet", pose, Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 0});
  const TrueSurface surface = true_surface(scene);
  ASSERT_EQ(surface.shapes.size(), 1u);
  ASSERT_EQ(surface.meshes.size(), 1u);
  EXPECT_NEAR(field(surface.shapes[0], pose * Eigen::Vector3d(0, 0, 0.3)).value_m, 0.2, 1e-15);
  EXPECT_NEAR((surface.meshes[0].vertices[1] - pose * Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-15);
}

TEST(Texture, MovesWithItsObject) {
  Scene scene = one_object(NoiseTexture{0.02, 4, 0.8});
  const Eigen::Vector3d x(0.03, -0.05, 0.08);
  const double before = albedo_at(scene, 0, x);
  const Pose pose = exp((Vector6() << 1, 2, 0.3, 1, 2, 3).finished());
  scene.objects[0].world_from_object = pose;
  // a slope of at most about 2 / finest wavelength (2.5 mm) carries roundings of 1e-15 m
  EXPECT_NEAR(albedo_at(scene, 0, pose * x), before, 1e-11);
}

TEST(Texture, CheckersAlternateWithTheirPeriod) {
  const CheckerTexture checker{0.02, 0.75};
  const auto at = [&](double x, double y, double z) { return texture_factor(checker, {x, y, z}); };
  EXPECT_EQ(at(0.005, 0.005, 0.005), 1);
  EXPECT_EQ(at(0.015, 0.005, 0.005), 0.25);
  EXPECT_EQ(at(0.025, 0.005, 0.005), 1);
  EXPECT_EQ(at(0.015, 0.015, 0.005), 1);
  EXPECT_EQ(at(-0.005, 0.005, 0.005), 0.25);
}

TEST(Texture, NoiseIsUniformOnItsLatticeAndSmoothBetween) {
  double sum = 0, squares = 0;
  const int side = 30;
  for (int i = 0; i < side * side * side; ++i) {
    const double v =
        value_noise(Eigen::Vector3d(i % side, i / side % side, i / side / side).array() - 15);
    ASSERT_GE(v, 0);
    ASSERT_LT(v, 1);
    sum += v;
    squares += v * v;
  }
  const double count = side * side * side;
  // uniform: mean 1/2, variance 1/12; four standard errors
  EXPECT_NEAR(sum / count, 0.5, 4 / std::sqrt(12 * count));
  EXPECT_NEAR(squares / count - std::pow(sum / count, 2), 1.0 / 12,
              4 * std::sqrt(1.0 / 180 / count));

  RandomStream random(1, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    Eigen::Vector3d x(20 * random.uniform() - 10, 20 * random.uniform() - 10,
                      20 * random.uniform() - 10);
    if (i % 2) x.x() = std::round(x.x());  // across a cell's face too
    const double h = 1e-4, slope = (value_noise(x + h * Eigen::Vector3d::UnitX()) -
                                    value_noise(x - h * Eigen::Vector3d::UnitX())) /
                                   (2 * h);
    ASSERT_LT(std::abs(slope), 1.875 + 1e-3);  // the blend's steepest slope, 15/8
    if (i % 2) {
      ASSERT_NEAR(slope, 0, 1e-6) << "level at the lattice";
    }
  }
}

TEST(Texture, NoiseKeepsTheContrastAsked) {
  const NoiseTexture noise{0.01, 4, 0.8};
  double low = 1, high = 0;
  for (int i = 0; i < 20000; ++i) {
    RandomStream random(2, 0, i);
    const double f = texture_factor(noise, {random.uniform(), random.uniform(), random.uniform()});
    low = std::min(low, f);
    high = std::max(high, f);
  }
  EXPECT_GE(low, 0.2);
  EXPECT_LE(high, 1);
  EXPECT_LT(low, 0.4);
  EXPECT_GT(high, 0.8);
}

// Solid cells of a grid over a shape, for its topology.
struct Cells {
  int nx, ny, nz;
  std::vector<char> solid;
  bool at(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz && solid[(z * ny + y) * nx + x];
  }
};

Cells cells_of(const Shape& shape, double cell_m) {
  const Bounds box = bounds_of(PlacedShape{Pose::Identity(), shape});
  const Eigen::Array3i n = (box.sizes().array() / cell_m).ceil().cast<int>() + 4;
  Cells cells{n.x(), n.y(), n.z(), {}};
  for (int z = 0; z < n.z(); ++z)
    for (int y = 0; y < n.y(); ++y)
      for (int x = 0; x < n.x(); ++x)
        cells.solid.push_back(
            field(shape, box.min() + cell_m * Eigen::Vector3d(x - 1.7, y - 1.7, z - 1.7)).value_m <
            0);
  return cells;
}

// Parts of the cells with the given value, connected through faces.
int components(Cells cells, bool value) {
  int parts = 0;
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < cells.solid.size(); ++start) {
    if (cells.solid[start] != value) continue;
    ++parts;
    cells.solid[start] = !value;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      const int x = i % cells.nx, y = i / cells.nx % cells.ny, z = i / cells.nx / cells.ny;
      const int steps[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
      for (const auto& s : steps) {
        const int u = x + s[0], v = y + s[1], w = z + s[2];
        if (u < 0 || v < 0 || w < 0 || u >= cells.nx || v >= cells.ny || w >= cells.nz) continue;
        const std::size_t j = (static_cast<std::size_t>(w) * cells.ny + v) * cells.nx + u;
        if (cells.solid[j] != value) continue;
        cells.solid[j] = !value;
        open.push_back(j);
      }
    }
  }
  return parts;
}

// Euler number of the closed cells: vertices - edges + faces - cells, each counted if a cell
// touches it.
int euler_number(const Cells& cells) {
  int sum = 0;
  for (int z = 0; z <= cells.nz; ++z)
    for (int y = 0; y <= cells.ny; ++y)
      for (int x = 0; x <= cells.nx; ++x)
        for (int kind = 0; kind < 8; ++kind) {  // bit k: extends along axis k
          bool touched = false;
          for (int n = 0; n < 8; ++n)
            touched |= (n & kind) == 0 && cells.at(x - (n & 1), y - (n >> 1 & 1), z - (n >> 2 & 1));
          if (touched) sum += std::popcount(static_cast<unsigned>(kind)) % 2 ? -1 : 1;
        }
  return sum;
}

class OwnModel : public testing::TestWithParam<const char*> {
 protected:
  Shape shape = catalogue_shape(GetParam()).value();
};

// One solid without cavity has the Euler number 1 - genus; both models have genus 1.
TEST_P(OwnModel, IsOneSolidOfGenusOne) {
  const Cells cells = cells_of(shape, 0.6e-3);
  EXPECT_EQ(components(cells, true), 1);
  EXPECT_EQ(components(cells, false), 1) << "no cavity";
  EXPECT_EQ(euler_number(cells), 0);
}

TEST_P(OwnModel, HasAFieldThatRaysMayStepBy) {
  for (int i = 0; i < 20000; ++i) {
    RandomStream random(3, 0, i);
    const auto place = [&] {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      return Eigen::Vector3d(0.2 * x - 0.1, 0.2 * y - 0.1, 0.2 * z - 0.1);
    };
    const Eigen::Vector3d a = place();
    const Eigen::Vector3d b = i % 2 ? place() : Eigen::Vector3d(a + 1e-3 * place().normalized());
    const double rise = std::abs(field(shape, a).value_m - field(shape, b).value_m);
    ASSERT_LE(rise, (a - b).norm() + 1e-15);
  }
}

TEST_P(OwnModel, HasTheSizeItSays) {
  check(shape);
  const Eigen::Vector3d size = bounds_of(PlacedShape{Pose::Identity(), shape}).sizes();
  EXPECT_NEAR(size.maxCoeff(), std::string(GetParam()) == "bud" ? 0.1 : 0.08, 0.016);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, OwnModel, testing::Values("bracket", "bud"),
                         [](const auto& model) { return std::string(model.param); });

TEST(Bracket, HasItsBoreItsWallAndItsFillet) {
  const Shape shape = bracket();
  const auto inside = [&](double x, double y, double z) {
    return field(shape, {x, y, z}).value_m < 0;
  };
  EXPECT_FALSE(inside(0.022, 0, 0.004)) << "bore";
  EXPECT_TRUE(inside(0.0325, 0, 0.004));
  EXPECT_TRUE(inside(-0.015, 0, 0.025)) << "wall";
  EXPECT_TRUE(inside(-0.015, 0.0007, 0.025));
  EXPECT_FALSE(inside(-0.015, 0.0008, 0.025));
  EXPECT_TRUE(inside(-0.0295, 0.02, 0.0085)) << "fillet";
  EXPECT_FALSE(inside(-0.020, 0.02, 0.0085));
  EXPECT_NEAR(field(shape, {0.01, 0.02, 0.0100}).value_m, 0.002, 1e-15) << "flat foot beyond it";
}

TEST(Catalogue, KnowsTwoWords) {
  EXPECT_FALSE(catalogue_shape("teapot"));
}

}  // namespace
}  // namespace scan::synth
