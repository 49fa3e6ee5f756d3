// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/bsdf.h"

#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/shortest.h"
#include "synth/bsdf/kinds.h"

namespace scan::synth {
namespace {

// The name of the field, its value, and the limits it must keep (NaN keeps none).
void check_field(const std::string& field, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(Trouble::input, field + " is " + shortest(value) + ", must be from " + shortest(low) +
                                  " to " + shortest(high));
}

// The model's fit gives more light than it gets at grazing angles if the faces are whiter: its
// directional albedo reaches 1 for 0.954 at a slope of 0.3 rad, for more at any other.
constexpr double most_oren_nayar_albedo = 0.95;

// No body that light enters has an index near 100, and no metal; larger numbers are slips of a
// unit.
constexpr double most_index = 100;

void check_kind(const Lambert& bsdf, const std::string& place) {
  check_field(place + "/albedo", bsdf.albedo, 0, 1);
}
void check_kind(const OrenNayar& bsdf, const std::string& place) {
  check_field(place + "/albedo", bsdf.albedo, 0, most_oren_nayar_albedo);
  check_field(place + "/slope_rad", bsdf.slope_rad, 0, std::numbers::pi / 2);
}
void check_kind(const Conductor& bsdf, const std::string& place) {
  check_field(place + "/eta", bsdf.eta, 1e-6, most_index);
  check_field(place + "/k", bsdf.k, 0, most_index);
  check_field(place + "/roughness", bsdf.roughness, 0, 1);
}
void check_kind(const Dielectric& bsdf, const std::string& place) {
  check_field(place + "/index", bsdf.index, 1, most_index);
  check_field(place + "/roughness", bsdf.roughness, 0, 1);
}
void check_kind(const Plastic& bsdf, const std::string& place) {
  check_field(place + "/albedo", bsdf.albedo, 0, 1);
  check_field(place + "/index", bsdf.index, 1, most_index);
  check_field(place + "/roughness", bsdf.roughness, 0, 1);
}

}  // namespace

bool is_smooth(double roughness) {
  return roughness < least_roughness;
}

void check(const Bsdf& bsdf, const std::string& place) {
  std::visit([&](const auto& kind) { check_kind(kind, place); }, bsdf);
}

double evaluate(const Bsdf& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  return std::visit([&](const auto& kind) { return evaluate(kind, out, in); }, bsdf);
}

double density(const Bsdf& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  return std::visit([&](const auto& kind) { return density(kind, out, in); }, bsdf);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u) {
  return std::visit([&](const auto& kind) { return sample(kind, out, u); }, bsdf);
}

DeltaLobes delta_lobes(const Bsdf& bsdf, const Eigen::Vector3d& out) {
  return std::visit([&](const auto& kind) { return delta_lobes(kind, out); }, bsdf);
}

bool has_delta(const Bsdf& bsdf) {
  if (const auto* metal = std::get_if<Conductor>(&bsdf)) return is_smooth(metal->roughness);
  if (const auto* glass = std::get_if<Dielectric>(&bsdf)) return is_smooth(*glass);
  if (const auto* plastic = std::get_if<Plastic>(&bsdf)) return is_smooth(plastic->roughness);
  return false;
}

bool is_transmissive(const Bsdf& bsdf) {
  return std::holds_alternative<Dielectric>(bsdf);
}

double albedo(const Bsdf& bsdf, const Eigen::Vector3d& in) {
  return std::visit([&](const auto& kind) { return albedo(kind, in); }, bsdf);
}

}  // namespace scan::synth
