// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How a surface scatters light: the five kinds behind one set of functions.
//
// Local frame: z is the outward normal. `out` points to where the light goes, `in` to where it
// comes from, both unit and away from the surface. Light is monochromatic. Paths carry the basic
// radiance B = L / n^2, which refraction leaves alone: B_out is the integral of f B_in |cos| over
// the directions of `in`, and a lossless boundary between two bodies of equal B changes nothing.
// With n the index of the side that a direction points to, n_out^2 f(out, in) = n_in^2 f(in, out):
// plain reciprocity wherever both are on one side.
//
// All but the dielectric reflect on their outer side only and are black from below; a shell's
// caller turns the frame to the side that it looks at.
//
// To add one: 1. synth/bsdf/<name>.h with its fields; 2. its name in the variant; 3. evaluate,
// density, sample, delta_lobes and albedo for it; bsdf_test.cpp walks the variant (furnace,
// reciprocity, chi-square).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <variant>

namespace scan::synth {

enum class Microfacets { ggx, beckmann };
// Facets with a smaller alpha count as smooth: their lobe is narrower than 2 mrad, and rounding
// would eat into the angles within it.
inline constexpr double least_roughness = 1e-3;

struct Lambert {
  double albedo = 0.5;
};
// Rough clay, plaster (Oren and Nayar 1994, the qualitative model's full form with
// interreflection).
struct OrenNayar {
  double albedo = 0.5;     // of its faces, at most 0.95
  double slope_rad = 0.3;  // standard deviation of the facets' slope angle
};
// Metal with the complex index eta + i k; roughness 0 is a mirror. Light that rough facets send
// into one another leaves in the end, spread out (Kulla and Conty 2017).
struct Conductor {
  double eta = 1.5;
  double k = 7;
  double roughness = 0.2;  // alpha of the distribution
  Microfacets facets = Microfacets::ggx;
};
// Clear glass, water: the object's inside has this index; roughness 0 is smooth. Light that rough
// facets hide is lost: for index 1.5 and light facing it 0.1 % at alpha 0.1, 3 % at 0.5.
struct Dielectric {
  double index = 1.5;
  double roughness = 0;
  Microfacets facets = Microfacets::ggx;
};
// A diffuse base under a dielectric coat (Ashikhmin and Shirley's energy split is not used; the
// coat's transmission in and out multiplies the base, with the internal reflections summed).
struct Plastic {
  double albedo = 0.5;  // of the base
  double index = 1.5;
  double roughness = 0.1;  // 0: a smooth coat
  Microfacets facets = Microfacets::ggx;
};
using Bsdf = std::variant<Lambert, OrenNayar, Conductor, Dielectric, Plastic>;

// Throws scan::Error (input), "place/field: value, must be limit".
void check(const Bsdf& bsdf, const std::string& place);

// f in 1/sr without the cosine; delta lobes give 0.
double evaluate(const Bsdf& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);

// Of sample() giving `in`, per sr; delta lobes give 0.
double density(const Bsdf& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);

struct BsdfSample {
  Eigen::Vector3d in;
  double weight = 0;   // f |cos| / density, or a delta lobe's reflectance over its probability
  double density = 0;  // per sr; 0 for a delta lobe
  bool is_delta = false;
  bool is_transmitted = false;
};
// None if the light is absorbed. `u` in [0, 1)^3: x picks the lobe.
std::optional<BsdfSample> sample(const Bsdf& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u);

// The single directions that light comes from, the brightest first: all that sample() chooses among
// but a coat's base, each with its reflectance or transmittance for a weight.
using DeltaLobes = std::array<std::optional<BsdfSample>, 2>;
DeltaLobes delta_lobes(const Bsdf& bsdf, const Eigen::Vector3d& out);

// All or part of its light leaves in single directions (a mirror, smooth glass, a smooth coat).
bool has_delta(const Bsdf& bsdf);
// It lets light through.
bool is_transmissive(const Bsdf& bsdf);
// Light that leaves over light that comes, from that direction: in closed form or from a table,
// right to 1e-3, that is made at first use.
double albedo(const Bsdf& bsdf, const Eigen::Vector3d& in);

}  // namespace scan::synth
