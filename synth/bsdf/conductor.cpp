// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A metal's facets: Cook and Torrance 1982 with Smith's height-correlated masking (Heitz 2014).
// What the facets send into one another leaves after further reflections, spread out in proportion
// to the light missing in each direction (Kulla and Conty 2017), so a perfect metal loses nothing.
#include <algorithm>
#include <numbers>

#include "synth/bsdf/directional_table.h"
#include "synth/bsdf/fresnel.h"
#include "synth/bsdf/kinds.h"
#include "synth/bsdf/microfacet.h"
#include "synth/sampling/warp.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// Of light from a direction (its cosine): shares after one reflection.
struct Shares {
  DirectionalTable once;     // leaves, the facets reflecting as they do
  DirectionalTable perfect;  // would leave if they reflected all
  double perfect_mean;       // over the cosine-weighted hemisphere
  double again;              // of the light that hits again, what leaves in the end
};

FacetSpread facets_of(const Conductor& bsdf) {
  return {bsdf.facets, bsdf.roughness};
}

double reflected(const Conductor& bsdf, double cosine) {
  return fresnel_conductor(cosine, bsdf.eta, bsdf.k);
}

// Mean of a function of the cosine over the cosine-weighted hemisphere; c = t^2, 2 c dc.
template <class Function>
double hemisphere_mean(Function&& function) {
  return integral_over_unit([&](double t) { return function(t * t) * 4 * t * t * t; });
}

DirectionalTable table_of(const FacetSpread& facets, const std::function<double(double)>& facet) {
  return DirectionalTable([&](double cosine) {
    return facet_mean(facets, cosine, [&](const Eigen::Vector3d& out, const Eigen::Vector3d& h) {
      const Eigen::Vector3d in = mirrored(out, h);
      if (!is_above(in)) return 0.0;
      return facet(out.dot(h)) * facet_weight(facets, out, h) *
             seen_by_both(facet_lambda(facets, out), facet_lambda(facets, in));
    });
  });
}

Shares make_shares(const Conductor& bsdf) {
  const FacetSpread facets = facets_of(bsdf);
  const auto metal = [&](double cosine) { return reflected(bsdf, cosine); };
  const DirectionalTable perfect = table_of(facets, [](double) { return 1.0; });
  const double mean = hemisphere_mean(perfect), r = hemisphere_mean(metal);
  // two reflections, then any number more: r^2 mean (1 + r (1 - mean) + ...)
  return {table_of(facets, metal), perfect, mean, r * r * mean / (1 - r * (1 - mean))};
}

const Shares& shares_of(const Conductor& bsdf) {
  const TableKey key = {bsdf.eta, bsdf.k, bsdf.roughness, static_cast<double>(bsdf.facets)};
  return tabulated<Conductor, Shares>(key, [&] { return make_shares(bsdf); });
}

// The share that hits again; the tables' errors may not make it negative.
double missing(const Shares& shares, double cosine) {
  return std::max(0.0, 1 - shares.perfect(cosine));
}

// Probability of the spread-out lobe: its share of what leaves.
double spread_probability(const Shares& shares, double cosine) {
  const double spread = shares.again * missing(shares, cosine);
  return spread / (spread + shares.once(cosine));
}

double evaluate_rough(const Conductor& bsdf, const Shares& shares, const Eigen::Vector3d& out,
                      const Eigen::Vector3d& in) {
  const FacetSpread facets = facets_of(bsdf);
  const Eigen::Vector3d h = (out + in).normalized();
  const double seen = seen_by_both(facet_lambda(facets, out), facet_lambda(facets, in));
  // Walter et al. 2007, eq. 20
  const double once =
      reflected(bsdf, out.dot(h)) * facet_density(facets, h) * seen / (4 * out.z() * in.z());
  const double all_missing = pi * std::max(1 - shares.perfect_mean, 1e-12);
  return once + shares.again * missing(shares, out.z()) * missing(shares, in.z()) / all_missing;
}

double density_rough(const Conductor& bsdf, double spread, const Eigen::Vector3d& out,
                     const Eigen::Vector3d& in) {
  const Eigen::Vector3d h = (out + in).normalized();
  const double once = sampled_facet_density(facets_of(bsdf), out, h) / (4 * out.dot(h));  // eq. 14
  return (1 - spread) * once + spread * cosine_hemisphere_density(in);
}

}  // namespace

double evaluate(const Conductor& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  if (!is_above(out, in) || is_smooth(bsdf.roughness)) return 0;
  return evaluate_rough(bsdf, shares_of(bsdf), out, in);
}

double density(const Conductor& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  if (!is_above(out, in) || is_smooth(bsdf.roughness)) return 0;
  return density_rough(bsdf, spread_probability(shares_of(bsdf), out.z()), out, in);
}

std::optional<BsdfSample> sample(const Conductor& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u) {
  if (!is_above(out)) return std::nullopt;
  if (is_smooth(bsdf.roughness))
    return BsdfSample{.in = mirrored(out), .weight = reflected(bsdf, out.z()), .is_delta = true};
  const Shares& shares = shares_of(bsdf);
  const double spread = spread_probability(shares, out.z());
  const Eigen::Vector3d in = u.x() < spread
                                 ? to_cosine_hemisphere(u.tail<2>())
                                 : mirrored(out, sample_facet(facets_of(bsdf), out, u.y(), u.z()));
  if (!is_above(in)) return std::nullopt;
  const double density = density_rough(bsdf, spread, out, in);
  const double weight = evaluate_rough(bsdf, shares, out, in) * in.z() / density;
  if (!(weight > 0)) return std::nullopt;
  return BsdfSample{.in = in, .weight = weight, .density = density};
}

DeltaLobes delta_lobes(const Conductor& bsdf, const Eigen::Vector3d& out) {
  if (!is_above(out) || !is_smooth(bsdf.roughness)) return {};
  return {BsdfSample{.in = mirrored(out), .weight = reflected(bsdf, out.z()), .is_delta = true}};
}

double albedo(const Conductor& bsdf, const Eigen::Vector3d& in) {
  if (!is_above(in)) return 0;
  if (is_smooth(bsdf.roughness)) return reflected(bsdf, in.z());
  const Shares& shares = shares_of(bsdf);
  return shares.once(in.z()) + shares.again * missing(shares, in.z());
}

}  // namespace scan::synth
