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
#include "synth/medium/diffusion.h"
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

TEST(Scene, NamesWhatIsWrongWithAMedium) {
  Scene scene = one_object();
  scene.medium = Medium{.absorption_per_m = -1};
  EXPECT_NE(complaint_of(scene).find("scene/medium/absorption_per_m: -1"), std::string::npos);
  scene = one_object();
  scene.materials[0].interior = Medium{};
  scene.materials[0].bsdf = Dielectric{1.4};
  EXPECT_EQ(complaint_of(scene), "");
  scene.materials[0].interior->phase = HenyeyGreenstein{-1};
  EXPECT_NE(complaint_of(scene).find("clay/interior/phase/mean_cosine: -1"), std::string::npos);
}

// A ball of clay, one of clear glass, one of tinted glass, one of marble, in fog under a lamp.
Scene scene_of_all_kinds() {
  Scene scene = one_object();
  scene.materials.push_back({.name = "glass", .bsdf = Dielectric{1.5}});
  scene.materials.push_back(
      {.name = "tinted", .bsdf = Dielectric{1.5}, .interior = Medium{.absorption_per_m = 3}});
  scene.materials.push_back({.name = "marble",
                             .bsdf = Dielectric{1.4, 0.2},
                             .interior = Medium{.absorption_per_m = 1, .scattering_per_m = 2000}});
  for (int i = 1; i < 4; ++i) {
    scene.objects.push_back(scene.objects.front());
    scene.objects.back().name = scene.materials[i].name;
    scene.objects.back().material = i;
  }
  scene.medium = fog(100, 0.7, 0.9);
  scene.lights.push_back(PointLight{.position_m = {0, 0, 1}});
  return scene;
}

TEST(SimplifiedScene, IsTheSceneItselfWithAllEffects) {
  EXPECT_EQ(complaint_of(scene_of_all_kinds()), "");
  const Scene all = simplified(scene_of_all_kinds(), EffectSet::all());
  EXPECT_EQ(all.objects.size(), 4u);
  EXPECT_EQ(all.lights.size(), 1u);
  EXPECT_TRUE(all.medium);
  EXPECT_EQ(all.materials[3].interior->scattering_per_m, 2000);
  EXPECT_EQ(std::get<Dielectric>(all.materials[3].bsdf).roughness, 0.2);
}

TEST(SimplifiedScene, MakesTranslucentBodiesLambertOfEqualAlbedo) {
  const Scene full = scene_of_all_kinds();
  const Scene kept = simplified(full, EffectSet::all().without(Effect::subsurface));
  ASSERT_EQ(kept.objects.size(), 4u);
  EXPECT_EQ(std::get<Lambert>(kept.materials[3].bsdf).albedo,
            diffuse_albedo(*full.materials[3].interior, 1.4));
  EXPECT_FALSE(kept.materials[3].interior);
  EXPECT_EQ(kept.materials[2].interior->absorption_per_m, 3) << "tinted glass is refraction's";
  EXPECT_TRUE(std::holds_alternative<Dielectric>(kept.materials[2].bsdf));
  EXPECT_EQ(std::get<Lambert>(kept.materials[0].bsdf).albedo, 0.6);
  EXPECT_EQ(complaint_of(kept), "");
}

TEST(SimplifiedScene, LeavesOutClearBodiesWithoutRefraction) {
  const Scene kept = simplified(scene_of_all_kinds(), EffectSet::all().without(Effect::refraction));
  ASSERT_EQ(kept.objects.size(), 2u);
  EXPECT_EQ(kept.objects[0].name, "ball");
  EXPECT_EQ(kept.objects[1].name, "marble");
  EXPECT_TRUE(kept.materials[kept.objects[1].material].interior);
}

TEST(SimplifiedScene, StandsInVacuumInTheDarkWithoutEffects) {
  const Scene kept = simplified(scene_of_all_kinds(), {});
  EXPECT_FALSE(kept.medium);
  EXPECT_TRUE(kept.lights.empty());
  ASSERT_EQ(kept.objects.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Lambert>(kept.materials[kept.objects[1].material].bsdf));
}

TEST(SimplifiedScene, GivesDensityGridsTheirMajorants) {
  Scene scene = scene_of_all_kinds();
  const DensityGrid puff{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()},
                         Eigen::Vector3i(1, 1, 2),
                         {0.25f, 0.5f},
                         {}};
  scene.medium->density = puff;
  scene.materials[3].interior->density = puff;
  const Scene kept = simplified(scene, EffectSet::all());
  const std::vector<float> majorants = {0.5f};
  EXPECT_EQ(std::get<DensityGrid>(kept.medium->density).majorants, majorants);
  EXPECT_EQ(std::get<DensityGrid>(kept.materials[3].interior->density).majorants, majorants);
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
  const auto albedo = [&](const Eigen::Vector3d& x_in_world) {
    return std::get<Lambert>(bsdf_at(scene, 0, 0, x_in_world)).albedo;
  };
  const double before = albedo(x);
  const Pose pose = exp((Vector6() << 1, 2, 0.3, 1, 2, 3).finished());
  scene.objects[0].world_from_object = pose;
  // a slope of at most about 2 / finest wavelength (2.5 mm) carries roundings of 1e-15 m
  EXPECT_NEAR(albedo(pose * x), before, 1e-11);
}

TEST(Texture, CheckersAlternateWithTheirPeriod) {
  const CheckerTexture checker{0.02, 0.75};
  const auto at = [&](double x, double y, double z) {
    return texture_factor(checker, {{x, y, z}});
  };
  EXPECT_EQ(at(0, 0, 0), 1);
  EXPECT_EQ(at(0.01, 0, 0), 0.25);
  EXPECT_EQ(at(0.02, 0, 0), 1);
  EXPECT_EQ(at(0.01, 0.01, 0), 1);
  EXPECT_EQ(at(-0.01, 0, 0), 0.25);
  EXPECT_EQ(at(0.0049, 0, 0), 1);
  EXPECT_EQ(at(0.0051, 0, 0), 0.25);
}

TEST(Texture, CheckersOnAFaceDoNotFlipByRounding) {
  const CheckerTexture checker{0.02, 0.75};
  for (int cell = -3; cell <= 3; ++cell)
    for (const double offset : {-1e-12, 0.0, 1e-12})
      EXPECT_EQ(texture_factor(checker, {{0.001, 0.002, 0.01 * cell + offset}}),
                cell % 2 == 0 ? 1 : 0.25);
}

TEST(Texture, PictureLiesCentredOnThePlaneAndRepeats) {
  ImageTexture picture{Image<float>(4, 2), 0.04};  // pixels of 10 mm
  for (int i = 0; i < 8; ++i) picture.factors.pixels[i] = static_cast<float>(i) / 8;
  const auto at = [&](double x, double y) { return texture_factor(picture, {{x, y, 0.3}}); };
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column)
      for (const int turn : {-2, 0, 3})
        EXPECT_NEAR(at(0.01 * column - 0.015 + 0.04 * turn, 0.005 - 0.01 * row - 0.02 * turn),
                    (4 * row + column) / 8.0, 1e-12);
  EXPECT_NEAR(at(-0.01, 0.005), 0.5 / 8, 1e-12) << "half way along the first row";
  EXPECT_NEAR(at(-0.015, 0), 2.0 / 8, 1e-12) << "half way down the first column";
  EXPECT_NEAR(at(0.02, 0.005), 1.5 / 8, 1e-12) << "from the last column over to the first";
}

// A square of 0.2 m in space whose first triangle shows the left upper half of a picture of 2 x 2
// pixels. Between the centres of pixels the factor is bilinear, so it is known in closed form.
TEST(Texture, PictureIsLaidOnAMeshByItsCoordinates) {
  Scene scene = one_object(MeshTexture{Image<float>(2, 2)});
  auto& factors = std::get<MeshTexture>(scene.materials[0].texture).factors;
  factors.pixels = {0.0f, 0.25f, 0.5f, 1.0f};
  scene.objects[0].geometry =
      Mesh{{{1, 0, 0}, {1, 0.2, 0}, {1, 0.2, -0.2}, {1, 0, -0.2}}, {{0, 2, 1}, {0, 3, 2}}};
  scene.objects[0].texture_corners = {{{{0, 0}, {1, 1}, {1, 0}}}, {{{0, 0}, {0, 1}, {1, 1}}}};
  EXPECT_EQ(complaint_of(scene), "");
  for (const double u : {0.3, 0.5, 0.7})
    for (const double v : {0.3, 0.45, 0.7}) {
      const double a = 2 * u - 0.5, b = 2 * v - 0.5;
      const double expected = (1 - b) * 0.25 * a + b * (0.5 * (1 - a) + a);
      const std::uint32_t triangle = u >= v ? 0 : 1;
      const auto bsdf = std::get<Lambert>(
          bsdf_at(scene, 0, triangle,
                  scene.objects[0].world_from_object * Eigen::Vector3d(1, 0.2 * u, -0.2 * v)));
      EXPECT_NEAR(bsdf.albedo, 0.6 * expected, 1e-9) << u << " " << v;  // floats of 2^-24 are exact
    }
  scene.objects[0].texture_corners.pop_back();
  EXPECT_NE(complaint_of(scene).find("texture_corners has 1 entries, must have 2"),
            std::string::npos);
  scene.objects[0].texture_corners.clear();
  EXPECT_NE(complaint_of(scene).find("a picture without a width"), std::string::npos);
}

TEST(Scene, RefusesMaterialsThatCannotBe) {
  Scene scene = one_object(NoiseTexture{});
  scene.materials[0].bsdf = Conductor{};
  EXPECT_NE(complaint_of(scene).find("materials/clay/texture multiplies"), std::string::npos);
  scene.materials[0].bsdf = Dielectric{};
  EXPECT_NE(complaint_of(scene).find("materials/clay/texture multiplies"), std::string::npos);
  scene.materials[0].bsdf = Plastic{};
  EXPECT_EQ(complaint_of(scene), "");
  scene.materials[0].interior = Medium{};
  EXPECT_NE(complaint_of(scene).find("materials/clay/interior lies"), std::string::npos);
  scene = one_object();
  scene.materials[0].bsdf = Dielectric{};
  scene.materials[0].interior = Medium{};
  EXPECT_EQ(complaint_of(scene), "");
  scene.materials[0].bsdf = Dielectric{0.5};
  EXPECT_NE(complaint_of(scene).find("materials/clay/index is 0.5"), std::string::npos);
  scene = one_object(ImageTexture{});
  EXPECT_NE(complaint_of(scene).find("clay/texture/image has no pixels"), std::string::npos);
  scene = one_object(ImageTexture{Image<float>(1, 1, 1.5f), 0.1});
  EXPECT_NE(complaint_of(scene).find("clay/texture/image is 1.5"), std::string::npos);
  scene = one_object(ImageTexture{Image<float>(1, 1, 0.5f), 0});
  EXPECT_NE(complaint_of(scene).find("clay/texture/width_m is 0"), std::string::npos);
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
    const double f =
        texture_factor(noise, {{random.uniform(), random.uniform(), random.uniform()}});
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
