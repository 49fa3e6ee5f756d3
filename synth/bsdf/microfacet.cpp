// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/microfacet.h"

#include <cmath>
#include <numbers>

#include "synth/bsdf/directional_table.h"
#include "synth/sampling/warp.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

double square(double x) {
  return x * x;
}

double ggx_lambda(double slope2) {
  // (sqrt(1 + s) - 1) / 2 without cancellation
  return slope2 / (2 * (1 + std::sqrt(1 + slope2)));
}

double beckmann_lambda(double slope2) {
  if (slope2 == 0) return 0;
  const double a = 1 / std::sqrt(slope2);
  if (a > 6) return 0;  // below exp(-36)
  return (std::exp(-a * a) / (a * std::sqrt(pi)) - std::erfc(a)) / 2;
}

}  // namespace

double facet_density(const FacetSpread& facets, const Eigen::Vector3d& h) {
  if (!(h.z() > 0)) return 0;
  const double alpha2 = square(facets.alpha), cosine2 = square(h.z());
  const double slope2 = (square(h.x()) + square(h.y())) / (cosine2 * alpha2);
  const double scale = 1 / (pi * alpha2 * square(cosine2));
  if (facets.kind == Microfacets::beckmann) return scale * std::exp(-slope2);  // eq. 25
  return scale / square(1 + slope2);                                           // eq. 33
}

double facet_lambda(const FacetSpread& facets, const Eigen::Vector3d& v) {
  // alpha^2 tan^2
  const double slope2 = square(facets.alpha) * (square(v.x()) + square(v.y())) / square(v.z());
  return facets.kind == Microfacets::beckmann ? beckmann_lambda(slope2) : ggx_lambda(slope2);
}

double seen_by_both(double lambda_out, double lambda_in) {
  return 1 / (1 + lambda_out + lambda_in);
}

Eigen::Vector3d sample_facet(const FacetSpread& facets, const Eigen::Vector3d& out, double u,
                             double v) {
  return to_ggx_visible_normal({u, v}, out, facets.alpha);
}

double sampled_facet_density(const FacetSpread& facets, const Eigen::Vector3d& out,
                             const Eigen::Vector3d& h) {
  return ggx_visible_normal_density(h, out, facets.alpha);
}

double facet_weight(const FacetSpread& facets, const Eigen::Vector3d& out,
                    const Eigen::Vector3d& h) {
  const double full = 1 + facet_lambda({Microfacets::ggx, facets.alpha}, out);
  if (facets.kind == Microfacets::ggx) return full;
  const double slope2 = (square(h.x()) + square(h.y())) / square(h.z() * facets.alpha);
  return full * std::exp(-slope2) * square(1 + slope2);
}

double facet_mean(
    const FacetSpread& facets, double cosine,
    const std::function<double(const Eigen::Vector3d& out, const Eigen::Vector3d& h)>& of_facet) {
  constexpr int angles = 32;
  const Eigen::Vector3d out(std::sqrt(1 - cosine * cosine), 0, cosine);
  // u = radius^2 makes the disk's rim smooth. Across the plane of incidence both halves are the
  // same, so the angles run over one half; the rule of midpoints is spectral there.
  return integral_over_unit([&](double radius) {
    double sum = 0;
    for (int i = 0; i < angles; ++i)
      sum +=
          of_facet(out, sample_facet(facets, out, radius * radius, ((i + 0.5) / angles - 0.5) / 2));
    return 2 * radius * sum / angles;
  });
}

}  // namespace scan::synth
