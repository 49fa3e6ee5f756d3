// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Reflectance and refraction at a boundary, for unpolarised light.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

namespace scan::synth {

// Share of the power reflected; cosine of the incident angle in [0, 1], index = n_transmitted /
// n_incident. 1 beyond the critical angle.
double fresnel_dielectric(double cosine, double index);
double fresnel_conductor(double cosine, double eta, double k);
// The dielectric's from the cosines on both sides: it is the same seen from either.
double fresnel_boundary(double cosine, double cosine_behind, double index);

// Direction of travel behind the boundary: `in` points away from the surface on the normal's side;
// none under total reflection.
std::optional<Eigen::Vector3d> refract(const Eigen::Vector3d& in, const Eigen::Vector3d& normal,
                                       double index);

// Mean of fresnel_dielectric over the cosine-weighted hemisphere: diffuse reflectance.
double fresnel_dielectric_mean(double index);

// Published indices by name and wavelength, linear between table entries: metals "aluminium",
// "copper", "gold", "iron", "silver", "chromium" (eta, k); clear "bk7", "water", "acrylic",
// "polycarbonate" (k = 0). None for an unknown name or a wavelength that was not measured; metals,
// "bk7" and "water" cover 0.4 to 1.6 um, "acrylic" 0.42 to 1.62, "polycarbonate" 0.4368 to 1.052.
struct RefractiveIndex {
  double eta = 1;
  double k = 0;
};
std::optional<RefractiveIndex> refractive_index(std::string_view name, double wavelength_m);
std::vector<std::string_view> refractive_index_names();

}  // namespace scan::synth
