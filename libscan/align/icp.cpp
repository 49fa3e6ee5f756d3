// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/icp.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libscan/align/observability.h"
#include "libscan/align/pairs.h"
#include "libscan/align/rigid_fit.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t least_pairs = 6;
constexpr std::size_t chunk = 1024;

// Sums over the kept pairs of J^T J and J^T r, lengths in units of the frame's size.
struct NormalEquations {
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  NormalEquations& operator+=(const NormalEquations& other) {
    a += other.a;
    b += other.b;
    return *this;
  }
};

template <class Residual>
void add(NormalEquations& sum, const PointPair& pair, const DataFrame& frame) {
  auto jacobian = Residual::jacobian(pair, frame.centre).eval();
  jacobian.template leftCols<3>() /= frame.size_m;
  sum.a += jacobian.transpose() * jacobian;
  sum.b -= jacobian.transpose() * (Residual::value(pair) / frame.size_m);
}

void check_guess(const Pose& guess) {
  if (!guess.matrix().allFinite())
    throw Error(Trouble::input, "icp: target_from_source_guess is not finite");
}

// The iteration of one call to icp, in the clouds' local frames.
class Iteration {
 public:
  Iteration(const LocalCloud& source, const LocalCloud& target, const IcpOptions& options)
      : source_(source), target_(target), options_(options), finder_(source, target, options) {}

  void run(const Pose& guess, IcpResult& result);

 private:
  // Pairs kept at the current pose, where they lie, and the motions that they leave open.
  struct State {
    std::vector<std::uint32_t> kept;
    DataFrame frame;
    TwistBasis weak{6, 0};
  };

  void tighten();
  State examine();
  NormalEquations normal_equations(const State& state) const;
  Vector6 step(const State& state) const;
  Vector6 rigid_step(const State& state) const;
  Vector6 accept_lower(const State& state, Vector6 twist);
  bool small(const Vector6& twist, const DataFrame& frame) const;
  double rms_m(const State& state) const;
  void finish(bool at_limit, IcpResult& result);
  void report(const State& state, IcpResult& result) const;

  const LocalCloud& source_;
  const LocalCloud& target_;
  const IcpOptions& options_;
  PairFinder finder_;
  Pose pose_ = Pose::Identity();
  Gates gates_;
  bool gates_settled_ = false;
  std::vector<Match> matches_;
};

void Iteration::tighten() {
  const Gates before = gates_;
  gates_ = finder_.tightened(before, pose_, matches_);
  gates_settled_ = gates_.distance_m >= 0.99 * before.distance_m;
}

Iteration::State Iteration::examine() {
  State state;
  state.kept = finder_.kept(matches_, gates_);
  if (state.kept.size() < least_pairs) return state;
  std::vector<std::uint32_t> used;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : state.kept) {
    used.push_back(matches_[i].target);
    sum += pose_ * source_.points[i];
  }
  const auto count = static_cast<double>(state.kept.size());
  state.frame.centre = sum / count;
  double sum2 = 0;
  for (const std::uint32_t i : state.kept)
    sum2 += (pose_ * source_.points[i] - state.frame.centre).squaredNorm();
  state.frame.size_m = std::sqrt(sum2 / count);
  if (!(state.frame.size_m > 0)) state.frame.size_m = 1;  // all the same point: any unit will do
  const bool planes = options_.method == IcpMethod::point_to_plane;
  const auto normals = planes ? std::span<const Eigen::Vector3d>(target_.normals)
                              : std::span<const Eigen::Vector3d>();
  state.weak = weak_motions(used, target_.points, normals, finder_.surface(), state.frame);
  return state;
}

NormalEquations Iteration::normal_equations(const State& state) const {
  return ordered_sum(state.kept.size(), chunk, NormalEquations{},
                     [&](std::size_t begin, std::size_t end) {
                       NormalEquations sum;
                       for (std::size_t i = begin; i < end; ++i) {
                         const PointPair pair = finder_.pair(pose_, matches_, state.kept[i]);
                         if (options_.method == IcpMethod::point_to_plane)
                           add<PointToPlane>(sum, pair, state.frame);
                         else
                           add<PointToPoint>(sum, pair, state.frame);
                       }
                       return sum;
                     });
}

// The exact minimum over all rotations, as a twist about the frame's centre.
Vector6 Iteration::rigid_step(const State& state) const {
  std::vector<Eigen::Vector3d> moved, partners;
  for (const std::uint32_t i : state.kept) {
    const PointPair pair = finder_.pair(pose_, matches_, i);
    moved.push_back(pair.moved - state.frame.centre);
    partners.push_back(pair.target - state.frame.centre);
  }
  Vector6 twist = log(rigid_fit(moved, partners).target_from_source);
  twist.tail<3>() /= state.frame.size_m;
  return complement_projector(state.weak) * twist;
}

// Twist about the frame's centre, translation in units of its size.
Vector6 Iteration::step(const State& state) const {
  if (options_.method == IcpMethod::point_to_point) return rigid_step(state);
  const NormalEquations sums = normal_equations(state);
  return solve_withholding(sums.a, sums.b, state.weak);
}

bool Iteration::small(const Vector6& twist, const DataFrame& frame) const {
  return twist.head<3>().norm() < options_.stop_rotation_rad &&
         twist.tail<3>().norm() * frame.size_m <
             options_.stop_translation_fraction * 2 * source_.radius_m;
}

// Moves by the twist, or by the first of its quarters that does not raise the objective (partners
// found anew); by nothing when even a negligible part would. Returns what was moved.
Vector6 Iteration::accept_lower(const State& state, Vector6 twist) {
  const double before = finder_.cost_m2(matches_, gates_);
  while (true) {
    Vector6 metric = twist;
    metric.tail<3>() *= state.frame.size_m;
    const Eigen::Vector3d& c = state.frame.centre;
    const Pose moved = Eigen::Translation3d(c) * exp(metric) * Eigen::Translation3d(-c) * pose_;
    const std::vector<Match> matches = finder_.find(moved, gates_.distance_m);
    if (finder_.cost_m2(matches, gates_) <= before) {
      pose_ = make_pose(nearest_rotation(moved.linear()), moved.translation());
      matches_ = matches;
      return twist;
    }
    if (small(twist, state.frame)) return Vector6::Zero();
    twist /= 4;
  }
}

double Iteration::rms_m(const State& state) const {
  double sum = 0;
  for (const std::uint32_t i : state.kept) sum += matches_[i].residual_m * matches_[i].residual_m;
  return std::sqrt(sum / static_cast<double>(state.kept.size()));
}

void Iteration::report(const State& state, IcpResult& result) const {
  result.target_from_source = global_pose(pose_, source_, target_);
  result.pairs = state.kept.size();
  result.inlier_fraction_of_source =
      static_cast<double>(state.kept.size()) / static_cast<double>(source_.points.size());
  result.rms_m = rms_m(state);
  result.weak_directions = name_motions(state.weak, state.frame, target_.origin);
  // Residuals cannot be known better than the coordinates are rounded.
  const double rounding_m = 1e-16 * (target_.origin.norm() + target_.radius_m);
  const double sigma_m = std::max({result.rms_m, rounding_m, 1e-150});
  const Matrix6 projector = complement_projector(state.weak);
  Matrix6 to_frame = Matrix6::Identity();  // twist about the target's origin -> about the centre
  to_frame.bottomLeftCorner<3, 3>() =
      -cross_matrix(target_.origin + state.frame.centre) / state.frame.size_m;
  to_frame.bottomRightCorner<3, 3>() /= state.frame.size_m;
  const double scale = state.frame.size_m / sigma_m;
  result.information = scale * scale * to_frame.transpose() * projector *
                       normal_equations(state).a * projector * to_frame;
}

void Iteration::finish(bool at_limit, IcpResult& result) {
  const State state = examine();
  if (state.kept.size() < least_pairs) {
    result.stop = Stop::no_correspondences;
    return;
  }
  result.stop = at_limit                 ? Stop::iteration_limit
                : state.weak.cols() == 0 ? Stop::converged
                                         : Stop::degenerate;
  report(state, result);
}

void Iteration::run(const Pose& guess, IcpResult& result) {
  pose_ = local_pose(guess, source_, target_);
  const double given = options_.max_pair_distance_m;
  matches_ = finder_.find(pose_, given > 0 ? given : unlimited_m);
  for (result.iterations = 0;;) {
    tighten();
    const State state = examine();
    if (state.kept.size() < least_pairs) {
      result.stop = Stop::no_correspondences;
      return;
    }
    result.history_rms_m.push_back(rms_m(state));
    const bool last = result.iterations == options_.max_iterations;
    Vector6 moved = Vector6::Zero();
    if (!last) moved = accept_lower(state, step(state));
    if (!last) ++result.iterations;
    if (!last && options_.on_iteration)
      options_.on_iteration(result.iterations, global_pose(pose_, source_, target_));
    const bool settled = !last && gates_settled_ && small(moved, state.frame);
    if (!last && !settled) continue;
    finish(last, result);
    return;
  }
}

// A guess that is a rotation to rounding is left as it is, to the bit.
Pose proper_guess(const Pose& guess, double& off_rotation) {
  const Eigen::Matrix3d nearest = nearest_rotation(guess.linear());
  off_rotation = (guess.linear() - nearest).norm();
  return off_rotation < 1e-14 ? guess : make_pose(nearest, guess.translation());
}

}  // namespace

std::string_view name_of(IcpMethod method) {
  return method == IcpMethod::point_to_point ? "point-to-point" : "point-to-plane";
}

std::optional<IcpMethod> icp_method_from(std::string_view name) {
  for (const IcpMethod method : {IcpMethod::point_to_point, IcpMethod::point_to_plane})
    if (name == name_of(method)) return method;
  return std::nullopt;
}

std::string_view name_of(Stop stop) {
  switch (stop) {
    case Stop::converged: return "converged";
    case Stop::iteration_limit: return "iteration limit";
    case Stop::too_few_points: return "too few points";
    case Stop::no_correspondences: return "no correspondences";
    case Stop::degenerate: return "degenerate";
  }
  return "";
}

void check(const IcpOptions& options) {
  const auto need = [](bool good, const char* name, double value, const char* limit) {
    if (!good)
      throw Error(Trouble::usage,
                  std::string("icp: ") + name + ": " + std::to_string(value) + ", " + limit);
  };
  need(options.max_pair_distance_m >= 0, "max_pair_distance_m", options.max_pair_distance_m,
       "must be at least 0");
  need(options.max_normal_angle_rad > 0 && options.max_normal_angle_rad <= 3.1416,
       "max_normal_angle_rad", options.max_normal_angle_rad, "must be above 0 and at most pi");
  need(options.trim_fraction >= 0 && options.trim_fraction < 1, "trim_fraction",
       options.trim_fraction, "must be at least 0 and below 1");
  need(options.max_iterations >= 1, "max_iterations", options.max_iterations, "must be at least 1");
  need(options.stop_rotation_rad > 0, "stop_rotation_rad", options.stop_rotation_rad,
       "must be above 0");
  need(options.stop_translation_fraction > 0, "stop_translation_fraction",
       options.stop_translation_fraction, "must be above 0");
}

IcpResult icp(const PointCloud& source, const PointCloud& target,
              const Pose& target_from_source_guess, const IcpOptions& options) {
  const Stopwatch watch;
  check(options);
  check_guess(target_from_source_guess);
  if (options.method == IcpMethod::point_to_plane && target.normals.empty() && !target.empty())
    throw Error(Trouble::input, "icp: the target has no normals, which point-to-plane needs",
                "estimate normals first, or choose point-to-point");
  IcpResult result;
  result.target_from_source = proper_guess(target_from_source_guess, result.guess_off_rotation);
  const LocalCloud local_source = localise(source), local_target = localise(target);
  result.invalid_points = local_source.invalid_points + local_target.invalid_points;
  if (std::min(local_source.points.size(), local_target.points.size()) >= least_pairs)
    Iteration(local_source, local_target, options).run(result.target_from_source, result);
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
