// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/scan_edges.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>

#include "libscan/align/agreement.h"
#include "libscan/core/disjoint_sets.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

// Residuals of noise-free scans say nothing; coordinates are rounded to this share of the size.
constexpr double rounding = 1e-12;
// How far beyond its tolerance, in spacings, a point may lie and still be expected on the other.
constexpr double expected_in_spacings = 4;

// How far off a guess usually puts a scan, in units of its size.
constexpr double guess_share_of_size = 0.05;
constexpr double limit_of_six = 22.458;  // 99.9 % quantile of chi-square

// Of what a pair fixes best; motions below are open.
constexpr double open_share = 1e-12;

// With less, a pair that stands alone is tried from other starts as well.
constexpr double good_agreement = 0.8;

bool has_answer(const ScanEdge& edge) {
  return edge.stop == Stop::converged || edge.stop == Stop::degenerate ||
         edge.stop == Stop::iteration_limit;
}

double agreement_of(const PreparedScans& scans, const ScanEdge& edge) {
  const PreparedCloud& source = scans.clouds[edge.source];
  const PreparedCloud& target = scans.clouds[edge.target];
  const PosedScan other{&target, Pose::Identity(), scans.tolerance_m[edge.target]};
  const PosedScan posed{&source, local_pose(edge.target_from_source, source, target),
                        scans.tolerance_m[edge.source]};
  const double reach_m = expected_in_spacings * std::max(source.spacing_m, target.spacing_m);
  return agreement(posed, {&other, 1}, reach_m).agreeing;
}

ScanEdge align_from(const PreparedScans& scans, const EdgeTask& task, const Pose& start,
                    IcpOptions options) {
  ScanEdge edge{.source = task.source,
                .target = task.target,
                .target_from_source_guess = task.target_from_source_guess,
                .path = {start}};
  options.on_iteration = [&edge, tell = options.on_iteration](int iteration, const Pose& pose) {
    edge.path.push_back(pose);
    if (tell) tell(iteration, pose);
  };
  const IcpResult result =
      icp(scans.clouds[task.source], scans.clouds[task.target], start, options);
  edge.target_from_source = result.target_from_source;
  edge.stop = result.stop;
  edge.overlap = result.inlier_fraction_of_source;
  edge.rms_m = result.rms_m;
  edge.centre = result.centre;
  edge.information = result.information;
  if (has_answer(edge)) edge.agreement = agreement_of(scans, edge);
  return edge;
}

double score(const ScanEdge& edge) {
  return edge.overlap * edge.agreement;
}

// The guess turned about the middle of the source, and shifted, both ways along each axis; a turn
// moves the ends of the cloud by about as much as a shift.
std::vector<Pose> starts_around(const Pose& guess, const PreparedCloud& source, double shift_m) {
  const Eigen::Vector3d centre = guess * source.origin;
  std::vector<Pose> starts;
  for (int i = 0; i < 6; ++i)
    for (const double sign : {-1.0, 1.0}) {
      Vector6 twist = Vector6::Zero();
      twist[i] = sign * (i < 3 ? shift_m / source.radius_m : shift_m);
      starts.push_back(Eigen::Translation3d(centre) * exp(twist) * Eigen::Translation3d(-centre) *
                       guess);
    }
  return starts;
}

// A pair that no loop can check is tried from around its guess, too, where that does not end well.
ScanEdge align_pair(const PreparedScans& scans, const EdgeTask& task, bool alone,
                    const IcpOptions& options) {
  ScanEdge best = align_from(scans, task, task.target_from_source_guess, options);
  if (!alone || best.agreement >= good_agreement) return best;
  const PreparedCloud& source = scans.clouds[task.source];
  const double step_m = std::max(source.spacing_m, scans.clouds[task.target].spacing_m);
  for (const double spacings : {1.0, 2.0, 4.0})
    for (const Pose& start :
         starts_around(task.target_from_source_guess, source, spacings * step_m)) {
      const ScanEdge other = align_from(scans, task, start, options);
      if (score(other) > score(best)) best = other;
    }
  return best;
}

// An edge that was aligned before from the same guess, to the bit.
const ScanEdge* known_edge(const EdgeTask& task, const std::vector<ScanEdge>& known) {
  for (const ScanEdge& edge : known)
    if (edge.source == task.source && edge.target == task.target &&
        edge.target_from_source_guess.matrix() == task.target_from_source_guess.matrix())
      return &edge;
  return nullptr;
}

double size_m(const PreparedScans& scans, const ScanEdge& edge) {
  return std::min(scans.clouds[edge.source].radius_m, scans.clouds[edge.target].radius_m);
}

// Orthonormal motions about the overlap's centre, translations in units of the size, and which of
// them the pair leaves open.
struct PairMotions {
  Matrix6 directions;
  std::array<bool, 6> open;
};

PairMotions motions_of(const ScanEdge& edge, double size_m) {
  Vector6 unit;
  unit << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(size_m);
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(unit.asDiagonal() * edge.information *
                                                      unit.asDiagonal());
  PairMotions motions{.directions = solver.eigenvectors(), .open = {}};
  for (int i = 0; i < 6; ++i)
    motions.open[std::size_t(i)] =
        !(solver.eigenvalues()[i] > open_share * solver.eigenvalues()[5]);
  return motions;
}

// How far the pair moved from its guess along each motion that it fixes, metres, turns by what they
// move at the size; root mean square. None if all are open.
std::optional<double> off_guess_m(const ScanEdge& edge, double size_m) {
  const PairMotions motions = motions_of(edge, size_m);
  const Eigen::Translation3d there(edge.centre), back(-edge.centre);
  Vector6 off =
      log(Pose(back * edge.target_from_source_guess * edge.target_from_source.inverse() * there));
  off.tail<3>() /= size_m;
  double square = 0, fixed = 0;
  for (int i = 0; i < 6; ++i) {
    if (motions.open[std::size_t(i)]) continue;
    const double along = motions.directions.col(i).dot(off);
    square += along * along;
    ++fixed;
  }
  if (fixed == 0) return std::nullopt;
  return size_m * std::sqrt(square / fixed);
}

}  // namespace

std::vector<ScanEdge> align_pairs(const PreparedScans& scans, std::span<const EdgeTask> tasks,
                                  const MultiviewOptions& options, const Progress& progress) {
  std::vector<ScanEdge> edges(tasks.size());
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(
      tasks.size(),
      [&](std::size_t k) {
        const ScanEdge* known = known_edge(tasks[k], options.known_edges);
        edges[k] = known ? *known : align_pair(scans, tasks[k], tasks.size() == 1, options.icp);
        const std::lock_guard lock(mutex);
        if (options.on_edge && !known) options.on_edge(edges[k]);
        if (progress)
          progress("pairs", static_cast<double>(++done) / static_cast<double>(tasks.size()));
      },
      1);
  return edges;
}

double guess_sigma_m(const PreparedScans& scans, std::span<const ScanEdge> edges) {
  std::vector<double> offs_m;
  for (const ScanEdge& edge : edges)
    if (has_answer(edge))
      if (const auto off_m = off_guess_m(edge, size_m(scans, edge))) offs_m.push_back(*off_m);
  return median(std::move(offs_m));
}

double open_sigma_m(const PreparedScans& scans, std::span<const ScanEdge> edges) {
  DisjointSets tied(scans.clouds.size());
  const auto set_of = [&](std::size_t scan) {
    return tied.name_of(static_cast<std::uint32_t>(scan));
  };
  for (const ScanEdge& edge : edges) {
    const auto open = motions_of(edge, size_m(scans, edge)).open;
    if (edge.accepted && std::find(open.begin(), open.end(), true) == open.end())
      tied.unite(set_of(edge.source), set_of(edge.target));
  }
  const bool settled = std::all_of(edges.begin(), edges.end(), [&](const ScanEdge& edge) {
    return !edge.accepted || set_of(edge.source) == set_of(edge.target);
  });
  return settled ? 0 : guess_sigma_m(scans, edges);
}

PoseEdge graph_edge(const PreparedScans& scans, const ScanEdge& edge, double guess_sigma_m) {
  const PreparedCloud& source = scans.clouds[edge.source];
  const PreparedCloud& target = scans.clouds[edge.target];
  const double size = size_m(scans, edge);
  const double off_m = std::max(edge.rms_m, rounding * (size + target.origin.norm()));
  Vector6 unit;  // of motions about the overlap's centre: metres at the size
  unit << Eigen::Vector3d::Constant(size), Eigen::Vector3d::Ones();
  const Vector6 floor = unit.cwiseAbs2() / (off_m * off_m);  // inverses of the variances
  // (I^-1 + F^-1)^-1 = I (I + F)^-1 F, which holds for a singular I, too.
  const Matrix6 limit = floor.asDiagonal();
  Matrix6 less = edge.information * (edge.information + limit).ldlt().solve(limit);
  if (guess_sigma_m > 0) {
    const PairMotions motions = motions_of(edge, size);
    for (int i = 0; i < 6; ++i) {
      if (!motions.open[std::size_t(i)]) continue;
      const Vector6 row = unit.cwiseProduct(motions.directions.col(i)) / guess_sigma_m;
      less += row * row.transpose();
    }
  }
  Matrix6 to_centre = Matrix6::Identity();
  to_centre.bottomLeftCorner<3, 3>() = -cross_matrix(edge.centre - target.origin);
  const Matrix6 about_origin = to_centre.transpose() * less * to_centre;
  return {edge.source, edge.target, local_pose(edge.target_from_source, source, target),
          0.5 * (about_origin + about_origin.transpose())};
}

SolvedPoses solve_edges(const PreparedScans& scans, std::span<const Pose> starts,
                        std::vector<ScanEdge>& edges, std::size_t anchor,
                        const KnownGuesses& guesses) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    edges[k].accepted = false;
    if (has_answer(edges[k]) && !is_ruled_out(scans, graph_edge(scans, edges[k], 0), guesses))
      order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return edges[a].overlap * edges[a].agreement > edges[b].overlap * edges[b].agreement;
  });
  std::vector<PoseEdge> graph;
  graph.reserve(order.size());
  const double sigma_m = guess_sigma_m(scans, edges);
  for (const std::size_t k : order) graph.push_back(graph_edge(scans, edges[k], sigma_m));
  PoseGraph solved = solve_pose_graph(starts, graph, anchor);
  for (std::size_t k = 0; k < order.size(); ++k) edges[order[k]].accepted = solved.accepted[k];
  return {std::move(solved.world_from_scan), std::move(solved.tied)};
}

bool within_guess(const PreparedScans& scans, const ScanEdge& edge, std::span<const Pose> poses) {
  const PreparedCloud& source = scans.clouds[edge.source];
  const PreparedCloud& target = scans.clouds[edge.target];
  const Pose found = local_pose(edge.target_from_source, source, target);
  Vector6 off = log(poses[edge.target].inverse() * poses[edge.source] * found.inverse());
  off.tail<3>() /= std::min(source.radius_m, target.radius_m);
  return off.squaredNorm() <= limit_of_six * guess_share_of_size * guess_share_of_size;
}

}  // namespace scan
