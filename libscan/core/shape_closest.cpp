// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The nearest surface point of a shape: of a sharp combination it lies on a face (one part's
// surface), an edge (two parts' surfaces) or a corner (three), so these are tried.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "libscan/core/shape.h"

namespace scan {
namespace {

// A part that is not itself a sharp combination: a simple shape, or a blend.
struct Leaf {
  Pose parent_from_leaf;
  const Shape* shape;
};

DistanceField field_of(const Leaf& leaf, const Eigen::Vector3d& x) {
  const Eigen::Matrix3d rotation = leaf.parent_from_leaf.linear();
  const DistanceField f =
      field(*leaf.shape, rotation.transpose() * (x - leaf.parent_from_leaf.translation()));
  return {f.value_m, rotation * f.gradient};
}

void collect_leaves(const Pose& parent_from_shape, const Shape& shape, std::vector<Leaf>& leaves) {
  const auto* combination = std::get_if<CombinedShape>(&shape);
  if (combination == nullptr || combination->blend_m > 0) {
    leaves.push_back({parent_from_shape, &shape});
    return;
  }
  for (const PlacedShape& part : combination->parts)
    collect_leaves(parent_from_shape * part.parent_from_shape, part.shape, leaves);
}

// Up to three surfaces at once: their values and gradients (rows) at one place.
using Leaves = std::span<const Leaf* const>;
using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using Gradients = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3>;

void evaluate(Leaves leaves, const Eigen::Vector3d& x, Values& values, Gradients& gradients) {
  const auto count = static_cast<Eigen::Index>(leaves.size());
  values.resize(count);
  gradients.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const DistanceField f = field_of(*leaves[static_cast<std::size_t>(i)], x);
    values(i) = f.value_m;
    gradients.row(i) = f.gradient.transpose();
  }
}

// The combination of gradients that changes the values by `change`, of least norm.
Eigen::Vector3d least_step(const Gradients& gradients, const Values& change) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram =
      gradients * gradients.transpose();
  return gradients.transpose() * gram.partialPivLu().solve(change);
}

// Newton's method onto all surfaces at once; not finite where they are parallel or do not meet.
Eigen::Vector3d onto_common_surface(Leaves leaves, Eigen::Vector3d x) {
  Values values;
  Gradients gradients;
  double last_m = std::numeric_limits<double>::infinity();
  for (int step = 0, setbacks = 0; step < 60; ++step) {
    evaluate(leaves, x, values, gradients);
    const double size_m = values.norm();
    if (size_m == 0) break;
    if (size_m >= last_m && ++setbacks == 2) break;  // the first may be a bend, then it is rounding
    last_m = size_m;
    const Eigen::Vector3d last = x;
    x -= least_step(gradients, values);
    if (x == last || !x.allFinite()) break;
  }
  return x;
}

// Descent of the distance to x along the common surface, from the place that Newton reaches first.
Eigen::Vector3d nearest_common_point(Leaves leaves, const Eigen::Vector3d& x,
                                     const Eigen::Vector3d& start) {
  Values values;
  Gradients gradients;
  Eigen::Vector3d best = onto_common_surface(leaves, start);
  double best_m = (best - x).norm(), stride = 1;
  for (int step = 0; step < 200 && best_m > 0 && stride > 1e-10; ++step) {
    if (!best.allFinite()) break;
    evaluate(leaves, best, values, gradients);
    const Eigen::Vector3d offset = x - best;
    const Eigen::Vector3d tangential = offset - least_step(gradients, gradients * offset);
    if (!(tangential.norm() > 1e-10 * best_m)) break;  // the distance is right to its square
    const Eigen::Vector3d trial = onto_common_surface(leaves, best + stride * tangential);
    const double trial_m = (trial - x).norm();
    if (trial_m < best_m) {
      best = trial;
      best_m = trial_m;
      stride = std::min(1.0, 2 * stride);
    } else {
      stride /= 2;
    }
  }
  return best;
}

// The best of the points tried that lie on the surface of the whole.
class Search {
 public:
  Search(const PlacedShape& whole, const Eigen::Vector3d& x) : whole_(whole), x_(x) {
    collect_leaves(whole.parent_from_shape, whole.shape, leaves_);
    reach_m_ = x.norm();
    for (const Leaf& leaf : leaves_) {
      reach_m_ = std::max(reach_m_, leaf.parent_from_leaf.translation().norm());
      at_least_m_.push_back(std::abs(field_of(leaf, x).value_m));
    }
  }

  Eigen::Vector3d result() {
    for (std::size_t i = 0; i < leaves_.size(); ++i) try_face(i);
    const std::size_t n = leaves_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) try_common(std::array{i, j});
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        for (std::size_t k = j + 1; k < n; ++k) try_common(std::array{i, j, k});
    if (std::isfinite(best_m_)) return best_;
    const Leaf all{whole_.parent_from_shape, &whole_.shape};  // by the field alone
    return nearest_common_point(std::array{static_cast<const Leaf*>(&all)}, x_, x_);
  }

 private:
  bool lies_on_surface(const Eigen::Vector3d& point) const {
    const double tolerance_m = 1e-13 * reach_m_ + 1e-11 * (point - x_).norm();
    return point.allFinite() && std::abs(field(whole_, point).value_m) <= tolerance_m;
  }

  const Eigen::Vector3d& offer(const Eigen::Vector3d& point) {
    const double distance_m = (point - x_).norm();
    if (distance_m < best_m_ && lies_on_surface(point)) {
      best_ = point;
      best_m_ = distance_m;
    }
    return point;
  }

  void try_face(std::size_t i) {
    if (at_least_m_[i] >= best_m_) return;
    const Leaf& leaf = leaves_[i];
    const auto* blend = std::get_if<CombinedShape>(leaf.shape);
    if (blend == nullptr) {
      const DistanceField f = field_of(leaf, x_);
      offer(x_ - f.value_m * f.gradient);
      return;
    }
    const std::array alone{&leaf};
    offer(nearest_common_point(alone, x_, x_));
    for (const PlacedShape& part : blend->parts) {
      const PlacedShape placed{leaf.parent_from_leaf * part.parent_from_shape, part.shape};
      // a part whose surface is farther than the best, fillet allowed for, cannot lead to a better
      // one
      if (std::abs(field(placed, x_).value_m) > best_m_ + blend->blend_m) continue;
      offer(nearest_common_point(alone, x_, closest_point(placed, x_)));
    }
  }

  // Surfaces that lie farther than the best point found cannot hold a better one.
  template <std::size_t n>
  void try_common(const std::array<std::size_t, n>& indices) {
    std::array<const Leaf*, n> together{};
    for (std::size_t i = 0; i < n; ++i) {
      if (at_least_m_[indices[i]] >= best_m_) return;
      together[i] = &leaves_[indices[i]];
    }
    if (lies_on_surface(offer(nearest_common_point(together, x_, x_)))) return;
    // from an axis of symmetry the gradients are parallel and lead nowhere: step aside
    const DistanceField f = field_of(*together[0], x_);
    const double aside_m = std::abs(f.value_m) + at_least_m_[indices[1]];
    offer(nearest_common_point(together, x_, x_ + aside_m * f.gradient.unitOrthogonal()));
  }

  const PlacedShape& whole_;
  Eigen::Vector3d x_;
  std::vector<Leaf> leaves_;
  std::vector<double> at_least_m_;
  double reach_m_ = 0;
  Eigen::Vector3d best_ = Eigen::Vector3d::Zero();
  double best_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Eigen::Vector3d closest_point(const PlacedShape& placed, const Eigen::Vector3d& x) {
  return Search(placed, x).result();
}

}  // namespace scan
