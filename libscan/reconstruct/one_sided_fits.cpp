// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/one_sided_fits.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace scan {
namespace {

constexpr double reach_spacings = 3.5;      // a quarter disc, one face of a corner, holds 9 samples
constexpr double least_cosine = 0.8660254;  // of 30 degrees: normals of one piece
constexpr double least_contrast = 6;        // angle between pieces over the scatter within one
constexpr double most_misfit = 0.1;         // rms distance of a piece's samples, in spacings
constexpr std::size_t least_samples = 5;
constexpr double slope_share = 0.1;  // weight of a slope against a value, in units of the reach

struct Sample {
  Eigen::Vector3d point, normal;
  double weight;
  int piece;
};

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

using Centres = std::vector<Eigen::Vector3d>;

void assign(std::vector<Sample>& samples, Centres& centres) {
  for (int round = 0; round < 5; ++round) {
    for (Sample& s : samples)
      for (int c = s.piece = 0; c < static_cast<int>(centres.size()); ++c)
        if (s.normal.dot(centres[c]) > s.normal.dot(centres[s.piece])) s.piece = c;
    Centres sums(centres.size(), Eigen::Vector3d::Zero());
    for (const Sample& s : samples) sums[s.piece] += s.weight * s.normal;
    for (std::size_t c = 0; c < centres.size(); ++c)
      if (sums[c].norm() > 0) centres[c] = sums[c].normalized();
  }
}

// The normal that is farthest from its piece's, if it is another piece's.
const Sample* stranger(const std::vector<Sample>& samples, const Centres& centres) {
  const Sample* farthest = nullptr;
  double least = least_cosine;
  for (const Sample& s : samples)
    if (const double cosine = s.normal.dot(centres[s.piece]); cosine < least) {
      least = cosine;
      farthest = &s;
    }
  return farthest;
}

// Leaves out groups of too few samples: bits of a piece that begins at the reach's end.
void drop_bits(std::vector<Sample>& samples, Centres& centres) {
  for (int c = 0; c < static_cast<int>(centres.size());) {
    const auto in_group = [&](const Sample& s) { return s.piece == c; };
    if (std::count_if(samples.begin(), samples.end(), in_group) >=
        static_cast<std::ptrdiff_t>(least_samples)) {
      ++c;
      continue;
    }
    std::erase_if(samples, in_group);
    centres.erase(centres.begin() + c);
    for (Sample& s : samples) s.piece -= s.piece > c;
  }
}

// Groups of normals, clearly apart; empty if there is one only, or no clear ones.
Centres find_pieces(std::vector<Sample>& samples) {
  Centres centres{samples.front().normal};
  assign(samples, centres);
  for (const Sample* other; (other = stranger(samples, centres));) {
    if (centres.size() == 3) return {};
    centres.push_back(other->normal);
    assign(samples, centres);
  }
  drop_bits(samples, centres);
  if (centres.size() < 2) return {};
  double apart = 4;
  for (std::size_t a = 0; a < centres.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) apart = std::min(apart, angle(centres[a], centres[b]));
  std::array<double, 3> scatter2{}, weights{};
  for (const Sample& s : samples) {
    const double off = angle(s.normal, centres[s.piece]);
    scatter2[s.piece] += s.weight * off * off;
    weights[s.piece] += s.weight;
  }
  for (std::size_t c = 0; c < centres.size(); ++c)
    if (!(apart * apart * weights[c] > least_contrast * least_contrast * scatter2[c])) return {};
  return centres;
}

using Row = Eigen::Matrix<double, 6, 1>;

// Weighted least squares of heights and slopes, lengths in units of the reach.
QuadricPatch fit(const std::vector<Sample>& samples, int piece, const Eigen::Vector3d& normal,
                 double reach) {
  QuadricPatch patch;
  double weights = 0;
  for (const Sample& s : samples)
    if (s.piece == piece) {
      patch.origin += s.weight * s.point;
      weights += s.weight;
    }
  patch.origin /= weights;
  const Eigen::Vector3d u = normal.unitOrthogonal();
  patch.frame << u.transpose(), normal.cross(u).transpose(), normal.transpose();
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Row right = Row::Zero();
  const auto add = [&](double weight, const Row& row, double value) {
    matrix += weight * row * row.transpose();
    right += weight * value * row;
  };
  for (const Sample& s : samples) {
    if (s.piece != piece) continue;
    const Eigen::Vector3d x = patch.frame * (s.point - patch.origin) / reach;
    const Eigen::Vector3d n = patch.frame * s.normal;
    add(s.weight, Row{1, x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1]}, x[2]);
    add(slope_share * s.weight, Row{0, 1, 0, 2 * x[0], x[1], 0}, -n[0] / n[2]);
    add(slope_share * s.weight, Row{0, 0, 1, 0, x[0], 2 * x[1]}, -n[1] / n[2]);
  }
  const Row solved = matrix.ldlt().solve(right);
  for (int i = 0; i < 6; ++i)
    patch.height[i] = solved[i] * (i == 0 ? reach : i < 3 ? 1 : 1 / reach);
  return patch;
}

double misfit(const std::vector<Sample>& samples, int piece, const QuadricPatch& patch) {
  double sum = 0, weights = 0;
  for (const Sample& s : samples)
    if (s.piece == piece) {
      const double d = patch.distance(s.point);
      sum += s.weight * d * d;
      weights += s.weight;
    }
  return std::sqrt(sum / weights);
}

enum class Meeting { intersect, unite, unclear };

// Samples of each piece that lie inside the other tell of a convex edge.
Meeting meeting_of(const std::vector<Sample>& samples, const SharpSurface& surface, int a, int b) {
  double of_a = 0, of_b = 0;
  for (const Sample& s : samples) {
    if (s.piece == a) of_a += s.weight * surface.pieces[b].distance(s.point);
    if (s.piece == b) of_b += s.weight * surface.pieces[a].distance(s.point);
  }
  if (of_a < 0 && of_b < 0) return Meeting::intersect;
  return of_a > 0 && of_b > 0 ? Meeting::unite : Meeting::unclear;
}

// Sets how the pieces are joined; the pair that differs from the others comes first.
bool join(const std::vector<Sample>& samples, SharpSurface& surface) {
  const Meeting first = meeting_of(samples, surface, 0, 1);
  if (first == Meeting::unclear) return false;
  surface.first_two_intersect = surface.third_intersects = first == Meeting::intersect;
  if (surface.count == 2) return true;
  const Meeting second = meeting_of(samples, surface, 0, 2),
                third = meeting_of(samples, surface, 1, 2);
  if (second == Meeting::unclear || third == Meeting::unclear) return false;
  if (second == third) {
    surface.third_intersects = second == Meeting::intersect;
    return true;
  }
  // One of the pairs with the third piece is the odd one: it comes first.
  const bool odd_is_second = third == first;
  std::swap(surface.pieces[odd_is_second ? 1 : 0], surface.pieces[2]);
  surface.first_two_intersect = (odd_is_second ? second : third) == Meeting::intersect;
  surface.third_intersects = !surface.first_two_intersect;
  return true;
}

}  // namespace

double QuadricPatch::distance(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d at = frame * (x - origin);
  const double u = at[0], v = at[1];
  const double u_slope = height[1] + 2 * height[3] * u + height[4] * v,
               v_slope = height[2] + height[4] * u + 2 * height[5] * v;
  const double over = at[2] - (height[0] + u * (height[1] + height[3] * u + height[4] * v) +
                               v * (height[2] + height[5] * v));
  return over / std::sqrt(1 + u_slope * u_slope + v_slope * v_slope);
}

Eigen::Vector3d QuadricPatch::normal(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d at = frame * (x - origin);
  const Eigen::Vector3d local(-(height[1] + 2 * height[3] * at[0] + height[4] * at[1]),
                              -(height[2] + height[4] * at[0] + 2 * height[5] * at[1]), 1);
  return frame.transpose() * local.normalized();
}

SharpSurface::Active SharpSurface::at(const Eigen::Vector3d& x) const {
  const auto joined = [&](const Active& a, int piece, bool intersect) {
    const Active b{pieces[piece].distance(x), piece};
    return (b.distance > a.distance) == intersect ? b : a;
  };
  Active active = joined({pieces[0].distance(x), 0}, 1, first_two_intersect);
  if (count == 3) active = joined(active, 2, third_intersects);
  return active;
}

Eigen::Vector3d SharpSurface::onto(Eigen::Vector3d x) const {
  for (int step = 0; step < 8; ++step) {
    const Active active = at(x);
    x -= active.distance * pieces[active.piece].normal(x);
  }
  return x;
}

int SharpSurface::piece_like(const Eigen::Vector3d& normal, const Eigen::Vector3d& x) const {
  int best = 0;
  for (int p = 1; p < count; ++p)
    if (pieces[p].normal(x).dot(normal) > pieces[best].normal(x).dot(normal)) best = p;
  return best;
}

Eigen::Vector3d SharpSurface::meeting_place(std::span<const int> named, Eigen::Vector3d x) const {
  for (int step = 0; step < 6; ++step) {
    Eigen::MatrixXd rows(named.size(), 3);
    Eigen::VectorXd values(named.size());
    for (std::size_t i = 0; i < named.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) = pieces[named[i]].normal(x).transpose();
      values[static_cast<Eigen::Index>(i)] = pieces[named[i]].distance(x);
    }
    // The shortest step that makes all distances vanish.
    const Eigen::MatrixXd square = rows * rows.transpose();
    x -= rows.transpose() * square.ldlt().solve(values);
  }
  return x;
}

OneSidedFits::OneSidedFits(std::span<const Eigen::Vector3d> points,
                           std::span<const Eigen::Vector3d> normals,
                           std::span<const double> spacing)
    : points_(points), normals_(normals), spacing_(spacing), tree_(points) {}

double OneSidedFits::spacing_at(const Eigen::Vector3d& x) const {
  return spacing_[tree_.nearest(x, unlimited_m)->index];
}

SharpSurface OneSidedFits::about(const Eigen::Vector3d& x) const {
  const double reach = reach_spacings * spacing_at(x);
  thread_local std::vector<Neighbour> found;
  tree_.within(x, reach, found);
  std::vector<Sample> samples;
  for (const Neighbour& n : found) {
    const double t = 1 - n.distance2_m2 / (reach * reach);
    if (t > 0) samples.push_back({points_[n.index], normals_[n.index], t * t, 0});
  }
  SharpSurface surface;
  if (samples.size() < 2 * least_samples) return surface;
  const Centres centres = find_pieces(samples);
  surface.count = static_cast<int>(centres.size());
  for (int p = 0; p < surface.count; ++p) {
    surface.pieces[p] = fit(samples, p, centres[p], reach);
    if (!(misfit(samples, p, surface.pieces[p]) < most_misfit / reach_spacings * reach)) return {};
  }
  if (surface.count > 0 && !join(samples, surface)) return {};
  return surface;
}

}  // namespace scan
