// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each kind of BSDF must answer: the functions of bsdf.h, kind by kind.
#pragma once

#include "synth/bsdf/bsdf.h"

namespace scan::synth {

double evaluate(const Lambert& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
double density(const Lambert& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
std::optional<BsdfSample> sample(const Lambert& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u);
double albedo(const Lambert& bsdf, const Eigen::Vector3d& in);
inline DeltaLobes delta_lobes(const Lambert& /*bsdf*/, const Eigen::Vector3d& /*out*/) {
  return {};
}

double evaluate(const OrenNayar& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
double density(const OrenNayar& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
std::optional<BsdfSample> sample(const OrenNayar& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u);
double albedo(const OrenNayar& bsdf, const Eigen::Vector3d& in);
inline DeltaLobes delta_lobes(const OrenNayar& /*bsdf*/, const Eigen::Vector3d& /*out*/) {
  return {};
}

double evaluate(const Conductor& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
double density(const Conductor& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
std::optional<BsdfSample> sample(const Conductor& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u);
double albedo(const Conductor& bsdf, const Eigen::Vector3d& in);
DeltaLobes delta_lobes(const Conductor& bsdf, const Eigen::Vector3d& out);

double evaluate(const Dielectric& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
double density(const Dielectric& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
std::optional<BsdfSample> sample(const Dielectric& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u);
double albedo(const Dielectric& bsdf, const Eigen::Vector3d& in);
DeltaLobes delta_lobes(const Dielectric& bsdf, const Eigen::Vector3d& out);

double evaluate(const Plastic& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
double density(const Plastic& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in);
std::optional<BsdfSample> sample(const Plastic& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u);
double albedo(const Plastic& bsdf, const Eigen::Vector3d& in);
DeltaLobes delta_lobes(const Plastic& bsdf, const Eigen::Vector3d& out);

// Delta lobes instead of facets.
bool is_smooth(double roughness);
bool is_smooth(const Dielectric& bsdf);

// Directions nearer to the surface's plane count as within it, and nothing goes there: cosines and
// their squares and quotients stay clear of underflow.
inline constexpr double least_cosine = 1e-12;
inline bool is_above(const Eigen::Vector3d& direction) {
  return direction.z() > least_cosine;
}
inline bool is_above(const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  return is_above(out) && is_above(in);
}
inline Eigen::Vector3d mirrored(const Eigen::Vector3d& out) {
  return {-out.x(), -out.y(), out.z()};
}
inline Eigen::Vector3d mirrored(const Eigen::Vector3d& out, const Eigen::Vector3d& h) {
  return 2 * out.dot(h) * h - out;
}

}  // namespace scan::synth
