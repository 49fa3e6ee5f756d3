// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Distance to the visible surface of a union of shapes and meshes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
#include "libscan/verify/surface_error.h"
#include "libscan/verify/true_surface_parts.h"

namespace scan {
namespace {

using Nearest = TrueDistance::Nearest;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const Nearest unknown{Eigen::Vector3d::Constant(not_a_number),
                      Eigen::Vector3d::Constant(not_a_number), not_a_number};

struct Candidate {
  std::size_t part;
  double at_least_m;                 // lower bound of its distance
  std::optional<PartNearest> exact;  // for meshes from the start, for shapes when needed
};

PartNearest nearest_on_shape(const PlacedShape& shape, const Eigen::Vector3d& x) {
  const Eigen::Vector3d point = closest_point(shape, x);
  const Eigen::Vector3d normal = field(shape, point).gradient.normalized();
  return {point, normal, std::copysign((x - point).norm(), field(shape, x).value_m), no_triangle};
}

// The nearest triangle of each mesh to the last point asked about.
using Guesses = std::vector<std::uint32_t>;

std::vector<Candidate> candidates(const TrueSurfaceParts& parts, const Eigen::Vector3d& x,
                                  Guesses& guesses) {
  std::vector<Candidate> list;
  list.reserve(parts.size());
  for (std::size_t i = 0; i < parts.shapes.size(); ++i)
    list.push_back({i, std::abs(field(parts.shapes[i], x).value_m), std::nullopt});
  for (std::size_t i = 0; i < parts.meshes.size(); ++i) {
    const PartNearest nearest = parts.meshes[i]->nearest(x, guesses[i]);
    guesses[i] = nearest.triangle;
    list.push_back({parts.shapes.size() + i, std::abs(nearest.signed_distance_m), nearest});
  }
  std::stable_sort(list.begin(), list.end(), [](const Candidate& a, const Candidate& b) {
    return a.at_least_m < b.at_least_m;
  });
  return list;
}

// The nearest candidate, or the nearest visible one. Stops where lower bounds exceed the best.
const Candidate* best_of(std::vector<Candidate>& list, const TrueSurfaceParts& parts,
                         const Eigen::Vector3d& x, bool only_visible) {
  const Candidate* best = nullptr;
  double best_m = std::numeric_limits<double>::infinity();
  for (Candidate& candidate : list) {
    if (candidate.at_least_m >= best_m) break;
    if (!candidate.exact) candidate.exact = nearest_on_shape(parts.shapes[candidate.part], x);
    const double distance_m = std::abs(candidate.exact->signed_distance_m);
    if (distance_m >= best_m) continue;
    if (only_visible &&
        parts.is_hidden(candidate.part, candidate.exact->point, candidate.exact->normal))
      continue;
    best = &candidate;
    best_m = distance_m;
  }
  return best;
}

Nearest nearest_of(const TrueSurfaceParts& parts, const Eigen::Vector3d& x, Guesses& guesses) {
  std::vector<Candidate> list = candidates(parts, x, guesses);
  const Candidate* best = best_of(list, parts, x, true);
  PartNearest found;
  if (best != nullptr) {
    found = *best->exact;
  } else {
    // Each part's nearest point is buried in another part. The union of the shapes knows the seams
    // where they meet; a seam between a mesh and another part is not known, so the buried point
    // stays, which can only make the distance too small.
    found = parts.shapes.size() > 1 ? nearest_on_shape(parts.all_shapes, x)
                                    : *best_of(list, parts, x, false)->exact;
  }
  bool inside = false;
  for (const Candidate& candidate : list) {
    const bool shape = candidate.part < parts.shapes.size();
    inside = inside || (shape ? parts.contains(candidate.part, x)
                              : parts.meshes[candidate.part - parts.shapes.size()]->is_solid() &&
                                    candidate.exact->signed_distance_m < 0);
  }
  const double distance_m = (x - found.point).norm();
  const bool behind = inside || found.signed_distance_m < 0;
  return {found.point, found.normal, behind ? -distance_m : distance_m};
}

}  // namespace

struct TrueDistance::Parts : TrueSurfaceParts {
  using TrueSurfaceParts::TrueSurfaceParts;
};

TrueDistance::TrueDistance(const TrueSurface& surface) : parts_(std::make_unique<Parts>(surface)) {
  if (parts_->size() == 0) throw Error(Trouble::input, "true surface: neither a shape nor a mesh");
}

TrueDistance::~TrueDistance() = default;
TrueDistance::TrueDistance(TrueDistance&&) noexcept = default;

Nearest TrueDistance::nearest(const Eigen::Vector3d& x) const {
  Guesses guesses(parts_->meshes.size(), no_triangle);
  return nearest_of(*parts_, x, guesses);
}

std::vector<Nearest> TrueDistance::nearest_of_each(std::span<const Eigen::Vector3d> points) const {
  const std::vector<std::uint32_t> order = curve_order(points);
  std::vector<Nearest> found(points.size());
  parallel_chunks(points.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
    Guesses guesses(parts_->meshes.size(), no_triangle);
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t i = order[place];
      found[i] = points[i].allFinite() ? nearest_of(*parts_, points[i], guesses) : unknown;
    }
  });
  return found;
}

std::vector<double> deviations_m(std::span<const Eigen::Vector3d> points,
                                 const TrueSurface& truth) {
  std::vector<double> deviations;
  deviations.reserve(points.size());
  for (const Nearest& nearest : TrueDistance(truth).nearest_of_each(points))
    deviations.push_back(nearest.signed_distance_m);
  return deviations;
}

}  // namespace scan
