// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A clear boundary: its facets reflect and refract (Walter et al. 2007).
#include <cmath>
#include <utility>

#include "synth/bsdf/directional_table.h"
#include "synth/bsdf/fresnel.h"
#include "synth/bsdf/kinds.h"
#include "synth/bsdf/microfacet.h"

namespace scan::synth {
namespace {

// The boundary as seen from the side of `out`: that side is up, and index is n_below / n_above.
struct Boundary {
  FacetSpread facets;
  double index;
};

bool is_level(const Eigen::Vector3d& direction) {
  return std::abs(direction.z()) <= least_cosine;
}

Boundary boundary_of(const Dielectric& bsdf, bool from_outside) {
  return {{bsdf.facets, bsdf.roughness}, from_outside ? bsdf.index : 1 / bsdf.index};
}

// The facet that sends light from `in` to `out` and the cosines to it; none does if `cosine_out`
// is not positive.
struct Facet {
  Eigen::Vector3d h;
  double cosine_out = 0, cosine_in = 0;  // cosine_in is positive on its own side
};

Facet facet_between(const Boundary& boundary, const Eigen::Vector3d& out,
                    const Eigen::Vector3d& in) {
  const bool reflects = in.z() > 0;
  Eigen::Vector3d h = reflects ? (out + in).normalized() : (out + boundary.index * in).normalized();
  if (h.z() < 0) h = -h;
  const double cosine_in = reflects ? in.dot(h) : -in.dot(h);
  if (!(out.dot(h) > 0 && cosine_in > 0)) return {};
  return {h, out.dot(h), cosine_in};
}

// Share of the light that the facet sends the way of `in`.
double share(const Boundary& boundary, const Facet& facet, bool reflects) {
  if (reflects) return fresnel_dielectric(facet.cosine_out, boundary.index);
  return 1 - fresnel_boundary(facet.cosine_out, facet.cosine_in, boundary.index);
}

double masking(const Boundary& boundary, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  const double lambda_out = facet_lambda(boundary.facets, out);
  const double lambda_in = facet_lambda(boundary.facets, in);
  if (in.z() > 0) return seen_by_both(lambda_out, lambda_in);
  return 1 / ((1 + lambda_out) * (1 + lambda_in));  // eq. 23
}

// Solid angle of `h` over that of `in`, eqs. 14 and 17.
double turn_of_facet(const Boundary& boundary, const Facet& facet, bool reflects) {
  if (reflects) return 1 / (4 * facet.cosine_in);
  const double index = boundary.index;
  const double length = facet.cosine_out - index * facet.cosine_in;
  return index * index * facet.cosine_in / (length * length);
}

double evaluate_rough(const Boundary& boundary, const Eigen::Vector3d& out,
                      const Eigen::Vector3d& in) {
  const Facet facet = facet_between(boundary, out, in);
  if (!(facet.cosine_out > 0)) return 0;
  const bool reflects = in.z() > 0;
  // eqs. 20 and 21; per basic radiance the factor is the squared index of the side of `in`, which
  // turn_of_facet holds
  return share(boundary, facet, reflects) * facet_density(boundary.facets, facet.h) *
         masking(boundary, out, in) * facet.cosine_out * turn_of_facet(boundary, facet, reflects) /
         (out.z() * std::abs(in.z()));
}

double density_rough(const Boundary& boundary, const Eigen::Vector3d& out,
                     const Eigen::Vector3d& in) {
  const Facet facet = facet_between(boundary, out, in);
  if (!(facet.cosine_out > 0)) return 0;
  const bool reflects = in.z() > 0;
  return share(boundary, facet, reflects) * sampled_facet_density(boundary.facets, out, facet.h) *
         turn_of_facet(boundary, facet, reflects);
}

// f cosine / density for light that came over the facet h, the choice of its way left out.
double weight_over(const Boundary& boundary, const Eigen::Vector3d& out, const Eigen::Vector3d& h,
                   const Eigen::Vector3d& in) {
  return facet_weight(boundary.facets, out, h) * masking(boundary, out, in);
}

std::optional<BsdfSample> sample_rough(const Boundary& boundary, const Eigen::Vector3d& out,
                                       const Eigen::Vector3d& u) {
  const Eigen::Vector3d h = sample_facet(boundary.facets, out, u.y(), u.z());
  const double cosine = out.dot(h);
  if (!(cosine > 0)) return std::nullopt;
  const bool reflects = u.x() < fresnel_dielectric(cosine, boundary.index);
  const auto in = reflects ? std::optional(mirrored(out, h)) : refract(out, h, boundary.index);
  if (!in || (in->z() > 0) != reflects || is_level(*in)) return std::nullopt;
  return BsdfSample{.in = *in,
                    .weight = weight_over(boundary, out, h, *in),
                    .density = density_rough(boundary, out, *in),
                    .is_transmitted = !reflects};
}

std::optional<BsdfSample> sample_smooth(const Boundary& boundary, const Eigen::Vector3d& out,
                                        double u) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const bool reflects = u < fresnel_dielectric(out.z(), boundary.index);
  const auto in = reflects ? std::optional(mirrored(out)) : refract(out, up, boundary.index);
  if (!in) return std::nullopt;
  return BsdfSample{.in = *in, .weight = 1, .is_delta = true, .is_transmitted = !reflects};
}

// Light that leaves on either side over light that comes over a facet.
double kept_over(const Boundary& boundary, const Eigen::Vector3d& out, const Eigen::Vector3d& h) {
  const double cosine = out.dot(h);
  if (!(cosine > 0)) return 0;
  const double reflectance = fresnel_dielectric(cosine, boundary.index);
  const Eigen::Vector3d back = mirrored(out, h);
  double kept = back.z() > 0 ? reflectance * weight_over(boundary, out, h, back) : 0;
  const auto through = refract(out, h, boundary.index);
  if (through && through->z() < 0)
    kept += (1 - reflectance) * weight_over(boundary, out, h, *through);
  return kept;
}

Eigen::Vector3d turned(const Eigen::Vector3d& v, bool from_outside) {
  return {v.x(), v.y(), from_outside ? v.z() : -v.z()};
}

}  // namespace

bool is_smooth(const Dielectric& bsdf) {
  // so near to 1 the facet's normal between two directions is lost to rounding, and light goes on
  // within 1e-4 rad
  return is_smooth(bsdf.roughness) || bsdf.index < 1 + 1e-4;
}

double evaluate(const Dielectric& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  if (is_smooth(bsdf) || is_level(out) || is_level(in)) return 0;
  const bool outside = out.z() > 0;
  return evaluate_rough(boundary_of(bsdf, outside), turned(out, outside), turned(in, outside));
}

double density(const Dielectric& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  if (is_smooth(bsdf) || is_level(out) || is_level(in)) return 0;
  const bool outside = out.z() > 0;
  return density_rough(boundary_of(bsdf, outside), turned(out, outside), turned(in, outside));
}

std::optional<BsdfSample> sample(const Dielectric& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u) {
  if (is_level(out)) return std::nullopt;
  const bool outside = out.z() > 0;
  const Boundary boundary = boundary_of(bsdf, outside);
  const Eigen::Vector3d up = turned(out, outside);
  auto drawn = is_smooth(bsdf) ? sample_smooth(boundary, up, u.x()) : sample_rough(boundary, up, u);
  if (drawn) drawn->in = turned(drawn->in, outside);
  return drawn;
}

DeltaLobes delta_lobes(const Dielectric& bsdf, const Eigen::Vector3d& out) {
  if (is_level(out) || !is_smooth(bsdf)) return {};
  const bool outside = out.z() > 0;
  const Boundary boundary = boundary_of(bsdf, outside);
  const Eigen::Vector3d up = turned(out, outside);
  const double reflectance = fresnel_dielectric(up.z(), boundary.index);
  const BsdfSample reflected{
      .in = turned(mirrored(up), outside), .weight = reflectance, .is_delta = true};
  const auto through = refract(up, Eigen::Vector3d::UnitZ(), boundary.index);
  if (!through || !(reflectance < 1)) return {reflected};
  const BsdfSample transmitted{.in = turned(*through, outside),
                               .weight = 1 - reflectance,
                               .is_delta = true,
                               .is_transmitted = true};
  if (!(reflectance > 0)) return {transmitted};
  if (reflectance > 0.5) return {reflected, transmitted};
  return {transmitted, reflected};
}

double albedo(const Dielectric& bsdf, const Eigen::Vector3d& in) {
  if (is_level(in)) return 0;
  if (is_smooth(bsdf)) return 1;
  const Boundary boundary = boundary_of(bsdf, in.z() > 0);
  const TableKey key = {boundary.index, bsdf.roughness, static_cast<double>(bsdf.facets)};
  return tabulated<Dielectric, DirectionalTable>(key, [&] {
    return DirectionalTable([&](double cosine) {
      return facet_mean(boundary.facets, cosine,
                        [&](const Eigen::Vector3d& out, const Eigen::Vector3d& h) {
                          return kept_over(boundary, out, h);
                        });
    });
  })(std::abs(in.z()));
}

}  // namespace scan::synth
