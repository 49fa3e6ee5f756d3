// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What stands before the scanner: shapes and meshes with their materials, and light.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "libscan/core/image.h"
#include "libscan/core/mesh.h"
#include "libscan/core/shape.h"
#include "libscan/verify/truth.h"
#include "synth/bsdf/bsdf.h"
#include "synth/effects/effect.h"
#include "synth/light.h"
#include "synth/medium/medium.h"

namespace scan::synth {

// Textures: a factor on the albedo at a point of the object, in the object's frame.
struct PlainTexture {};
// Cubes of half a period, dark and light in turn; one is centred at the origin, so that faces at
// multiples of half a period run through the middle of cubes and not between them.
struct CheckerTexture {
  double period_m = 0.01;
  double contrast = 0.5;  // albedo times 1 or 1 - contrast
};
// Sum of octaves of value noise; its finest wavelength is period_m / 2^(octaves - 1).
struct NoiseTexture {
  double period_m = 0.01;
  int octaves = 4;
  double contrast = 0.8;
};
// A picture of factors from 0 to 1 upon the xy plane, seen from +z with its top row at +y, centred
// at the origin and repeated; bilinear between pixels.
struct ImageTexture {
  Image<float> factors;
  double width_m = 0.1;  // of the whole picture; its pixels are square
};
// A picture of factors laid on a mesh by its texture coordinates; bilinear, repeated.
struct MeshTexture {
  Image<float> factors;
};
using Texture = std::variant<PlainTexture, CheckerTexture, NoiseTexture, ImageTexture, MeshTexture>;

// An object's surface and what it encloses. A texture multiplies the albedo of a Lambert,
// Oren-Nayar or plastic surface. `interior` fills an object with a dielectric surface: absorbing
// glass or, with scattering, a translucent body (index 1: no boundary to speak of).
struct Material {
  std::string name;
  Bsdf bsdf = Lambert{};
  Texture texture;
  std::optional<Medium> interior;
};

// Smooth, and light passes straight into it: not meant to be measured, so no truth either.
bool is_clear(const Material& material);

struct Object {
  std::string name;
  Pose world_from_object = Pose::Identity();
  std::variant<Shape, Mesh> geometry;  // object frame, metres
  int material = 0;                    // index into Scene::materials
  // Where a MeshTexture's picture lies, per triangle of a mesh; else empty.
  std::vector<TextureCorners> texture_corners;
};

struct Scene {
  std::vector<Object> objects;
  std::vector<Material> materials;
  std::vector<Light> lights;     // besides the device's own
  std::optional<Medium> medium;  // that everything stands in: fog, dusty air
};

// Throws scan::Error (input) naming object and field.
// A point light inside an opaque shape is refused; a mesh is a shell, and light may stand in it.
void check(const Scene& scene);

TrueSurface true_surface(const Scene& scene);  // in the world frame

// How the object's surface reflects at a point (world frame) of a triangle (0 if it is no mesh),
// its texture applied.
Bsdf bsdf_at(const Scene& scene, int object, std::uint32_t triangle,
             const Eigen::Vector3d& x_in_world);

// The scene as it is rendered with those effects: without refraction no object with a dielectric
// surface and no scattering inside; without subsurface scattering translucent bodies are Lambert
// surfaces of equal diffuse albedo (synth/medium/diffusion.h); without medium or scene lights none
// of them. What is left out costs nothing; density grids get their majorants. Objects keep their
// order; `name`s tell who is who.
Scene simplified(const Scene& scene, const EffectSet& effects);

// What there is to measure: the scene without its clear objects.
Scene without_clear_objects(const Scene& scene);

// Our own models, metres. bracket: a machined angle of 80 x 50 x 45 mm with a bore (radius 9 mm), a
// fillet, a thin wall (1.5 mm) and sharp edges; genus 1 (the bore). bud: an organic form of blended
// spheres and a ring, about 100 mm; genus 1 (the ring is its handle). Both are one connected solid.
// `catalogue_shape` finds them by the words "bracket" and "bud"; none for another word.
Shape bracket();
Shape bud();
std::optional<Shape> catalogue_shape(std::string_view word);

}  // namespace scan::synth
