// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rough boundaries as facets that are smooth (Walter et al. 2007, "Microfacet Models for Refraction
// through Rough Surfaces"; Heitz 2014): how the facets' normals are spread, and how they hide one
// another.
#pragma once

#include <functional>

#include "synth/bsdf/bsdf.h"

namespace scan::synth {

// `out` and `in` in the local frame; a normal h points up (h.z > 0).
struct FacetSpread {
  Microfacets kind;
  double alpha;
};

// D(h), per steradian: the facets' area in the direction h over the surface's.
double facet_density(const FacetSpread& facets, const Eigen::Vector3d& h);

// Smith's Lambda: the share of facets facing v that others hide is Lambda / (1 + Lambda). Of either
// side; infinite in the surface's plane.
double facet_lambda(const FacetSpread& facets, const Eigen::Vector3d& v);

// Seen by both, on one side: heights decide both, so what hides one is likely to hide the other
// (Heitz 2014, eq. 99).
double seen_by_both(double lambda_out, double lambda_in);

// A facet's normal as drawn for `out` (above), and its density. Both kinds are drawn by GGX's
// visible normals (warp.h), exact for GGX and with weights below 2.7 for Beckmann's: the ratio of
// the distributions is at most 4 / e, that of the shares that are seen at most sqrt(pi).
Eigen::Vector3d sample_facet(const FacetSpread& facets, const Eigen::Vector3d& out, double u,
                             double v);
double sampled_facet_density(const FacetSpread& facets, const Eigen::Vector3d& out,
                             const Eigen::Vector3d& h);

// D(h) out.h / out.z over sampled_facet_density: 1 + Lambda for GGX.
double facet_weight(const FacetSpread& facets, const Eigen::Vector3d& out,
                    const Eigen::Vector3d& h);

// Mean, by quadrature, of a function of `out` (of that cosine) and the normals that sample_facet
// draws for it; the function must be the same on both sides of the plane of `out` and z.
double facet_mean(
    const FacetSpread& facets, double cosine,
    const std::function<double(const Eigen::Vector3d& out, const Eigen::Vector3d& h)>& of_facet);

}  // namespace scan::synth
