// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The models of scene.h's catalogue.
#include "synth/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "libscan/core/random.h"

namespace scan::synth {
namespace {

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
