// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A diffuse base under a clear coat: light that the coat does not reflect enters, is reflected to
// and fro between base and coat, and leaves. What a rough coat's facets lose among themselves is
// taken to enter, so a white base makes a white surface.
#include <numbers>

#include "synth/bsdf/directional_table.h"
#include "synth/bsdf/fresnel.h"
#include "synth/bsdf/kinds.h"
#include "synth/bsdf/microfacet.h"
#include "synth/sampling/warp.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// The coat by itself, seen from outside.
struct Coat {
  DirectionalTable reflected;  // of a rough coat's facets
  double internal;             // share of the base's light that the coat sends back to it
};

FacetSpread facets_of(const Plastic& bsdf) {
  return {bsdf.facets, bsdf.roughness};
}

double weight_over(const Plastic& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& h) {
  const Eigen::Vector3d in = mirrored(out, h);
  if (!is_above(in)) return 0;
  const FacetSpread facets = facets_of(bsdf);
  return fresnel_dielectric(out.dot(h), bsdf.index) * facet_weight(facets, out, h) *
         seen_by_both(facet_lambda(facets, out), facet_lambda(facets, in));
}

Coat make_coat(const Plastic& bsdf) {
  const DirectionalTable reflected([&](double cosine) {
    if (is_smooth(bsdf.roughness)) return fresnel_dielectric(cosine, bsdf.index);
    return facet_mean(facets_of(bsdf), cosine,
                      [&](const Eigen::Vector3d& out, const Eigen::Vector3d& h) {
                        return weight_over(bsdf, out, h);
                      });
  });
  const double mean = is_smooth(bsdf.roughness)
                          ? fresnel_dielectric_mean(bsdf.index)
                          : integral_over_unit([&](double t) {
                              return reflected(t * t) * 4 * t * t * t;  // 2 c dc with c = t^2
                            });
  // the light that passes is the same from both sides, times index^2 (etendue)
  return {reflected, 1 - (1 - mean) / (bsdf.index * bsdf.index)};
}

const Coat& coat_of(const Plastic& bsdf) {
  const TableKey key = {bsdf.index, bsdf.roughness, static_cast<double>(bsdf.facets)};
  return tabulated<Plastic, Coat>(key, [&] { return make_coat(bsdf); });
}

double reflected_by(const Coat& coat, const Plastic& bsdf, double cosine) {
  return is_smooth(bsdf.roughness) ? fresnel_dielectric(cosine, bsdf.index)
                                   : coat.reflected(cosine);
}

// Sum over all passages between base and coat: light leaving the base over light arriving first.
double summed_base(const Coat& coat, const Plastic& bsdf) {
  return bsdf.albedo / (1 - bsdf.albedo * coat.internal);
}

double evaluate_facets(const Plastic& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  const FacetSpread facets = facets_of(bsdf);
  const Eigen::Vector3d h = (out + in).normalized();
  const double seen = seen_by_both(facet_lambda(facets, out), facet_lambda(facets, in));
  return fresnel_dielectric(out.dot(h), bsdf.index) * facet_density(facets, h) * seen /
         (4 * out.z() * in.z());
}

// Probability of the coat's lobe: its share of what leaves.
double coat_probability(const Coat& coat, const Plastic& bsdf, double cosine) {
  const double coat_share = reflected_by(coat, bsdf, cosine);
  const double base_share = (1 - coat_share) * (1 - coat.internal) * summed_base(coat, bsdf);
  return coat_share + base_share > 0 ? coat_share / (coat_share + base_share) : 0;
}

double mixed_density(const Plastic& bsdf, double coat_share, const Eigen::Vector3d& out,
                     const Eigen::Vector3d& in) {
  const double base = (1 - coat_share) * cosine_hemisphere_density(in);
  if (is_smooth(bsdf.roughness)) return base;
  const Eigen::Vector3d h = (out + in).normalized();
  return base + coat_share * sampled_facet_density(facets_of(bsdf), out, h) / (4 * out.dot(h));
}

}  // namespace

double evaluate(const Plastic& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  if (!is_above(out, in)) return 0;
  const Coat& coat = coat_of(bsdf);
  // index^2: light spreads over a wider cone as it leaves
  const double base = (1 - reflected_by(coat, bsdf, out.z())) *
                      (1 - reflected_by(coat, bsdf, in.z())) * summed_base(coat, bsdf) /
                      (pi * bsdf.index * bsdf.index);
  return is_smooth(bsdf.roughness) ? base : base + evaluate_facets(bsdf, out, in);
}

double density(const Plastic& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  if (!is_above(out, in)) return 0;
  return mixed_density(bsdf, coat_probability(coat_of(bsdf), bsdf, out.z()), out, in);
}

std::optional<BsdfSample> sample(const Plastic& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u) {
  if (!is_above(out)) return std::nullopt;
  const Coat& coat = coat_of(bsdf);
  const double coat_share = coat_probability(coat, bsdf, out.z());
  const bool over_coat = u.x() < coat_share;
  if (over_coat && is_smooth(bsdf.roughness))
    return BsdfSample{.in = mirrored(out),
                      .weight = fresnel_dielectric(out.z(), bsdf.index) / coat_share,
                      .is_delta = true};
  const Eigen::Vector3d in = over_coat
                                 ? mirrored(out, sample_facet(facets_of(bsdf), out, u.y(), u.z()))
                                 : to_cosine_hemisphere(u.tail<2>());
  if (!is_above(in)) return std::nullopt;
  const double density = mixed_density(bsdf, coat_share, out, in);
  const double weight = evaluate(bsdf, out, in) * in.z() / density;
  if (!(weight > 0)) return std::nullopt;
  return BsdfSample{.in = in, .weight = weight, .density = density};
}

DeltaLobes delta_lobes(const Plastic& bsdf, const Eigen::Vector3d& out) {
  if (!is_above(out) || !is_smooth(bsdf.roughness)) return {};
  return {BsdfSample{
      .in = mirrored(out), .weight = fresnel_dielectric(out.z(), bsdf.index), .is_delta = true}};
}

double albedo(const Plastic& bsdf, const Eigen::Vector3d& in) {
  if (!is_above(in)) return 0;
  const Coat& coat = coat_of(bsdf);
  const double reflected = reflected_by(coat, bsdf, in.z());
  return reflected + (1 - reflected) * (1 - coat.internal) * summed_base(coat, bsdf);
}

}  // namespace scan::synth
