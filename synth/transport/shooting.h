// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A ray over a given chain of smooth sheets, how it changes with its direction, and the direction
// that meets a target.
#pragma once

#include <array>
#include <optional>

#include "synth/transport/connection.h"
#include "synth/transport/smooth_surfaces.h"

namespace scan::synth {

// What happens at a sheet: reflection or refraction, come to from inside or outside of its body.
struct Turn {
  int sheet = -1;
  bool reflects = false;
  bool from_inside = false;
  bool operator==(const Turn&) const = default;
};
struct Chain {
  std::array<Turn, Connection::most_bounces> turns;
  int size = 0;
  void add(const Turn& turn) { turns[size++] = turn; }
  bool operator==(const Chain&) const = default;  // turns past the size are untouched
};

// Direction of travel behind a smooth surface: mirrored, or refracted by Snell's law from
// n_incident to n_transmitted with `index` their ratio transmitted over incident; none under total
// reflection. `normal` against the direction.
std::optional<Eigen::Vector3d> turned(const Eigen::Vector3d& direction,
                                      const Eigen::Vector3d& normal, bool reflects, double index);

// Index behind a sheet over the index before it.
double relative_index(const SmoothSurfaces& surfaces, const Turn& turn);

// In the frame of SmoothSurfaces.
struct Shot {
  std::array<Eigen::Vector3d, Connection::most_bounces> points;
  std::array<Eigen::Vector3d, Connection::most_bounces> normals;         // outward
  std::array<Eigen::Vector3d, Connection::most_bounces + 1> directions;  // before each, and last
  Eigen::Vector3d miss;  // from where the ray passes the target to the target, across the ray
  double last_m = 0;     // from the last point to there; negative: away from the target
  // Change of where the ray passes the target, across it, per radian of the first direction along
  // two unit vectors across that.
  Eigen::Matrix2d gradient;
  Eigen::Vector2d miss_across;               // in the gradient's frame
  Eigen::Matrix<double, 3, 2> across_first;  // those two unit vectors
};

// None where the ray leaves the chain: a sheet is not met, met from its other side, or reflects
// totally. A flat sheet counts as an infinite plane.
std::optional<Shot> shoot(const SmoothSurfaces& surfaces, const Chain& chain,
                          const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                          const Eigen::Vector3d& target);

// Newton's method on the first direction, each step halved until it brings the ray nearer to the
// target; converged when it passes within 1e-12 of the distance, or as near as rounding lets it
// (1e-10).
std::optional<Shot> solve(const SmoothSurfaces& surfaces, const Chain& chain,
                          const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                          const Eigen::Vector3d& target);

}  // namespace scan::synth
