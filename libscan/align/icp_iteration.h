// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The descent of one pair to rest: what icp (icp.h) does between two prepared clouds.
#pragma once

#include "libscan/align/pairs.h"
#include "libscan/align/pose_step.h"

namespace scan {

// Fewer pairs fix no pose.
inline constexpr std::size_t least_pairs = 6;

// The iteration of one call to icp, in the clouds' local frames.
class IcpIteration {
 public:
  IcpIteration(const PreparedCloud& source, const PreparedCloud& target, const IcpOptions& options)
      : source_(source), target_(target), options_(options), finder_(source, target, options) {}

  void run(const Pose& guess, IcpResult& result);

 private:
  // Pairs that count at the current pose, where they lie, and the motions that they leave open.
  struct State {
    std::vector<Couple> couples;
    DataFrame frame;
    TwistBasis weak{6, 0};
  };

  enum class Settling { failed, on_the_way, at_rest };

  // Where a descent ended, with all points of the source.
  struct Rest {
    Pose pose = Pose::Identity();
    std::vector<Match> matches;
    Weighing weighing;
    double opening = 0;
  };

  // Point-to-point's steps say little of how far it has to go.
  bool creeps() const { return options_.method == IcpMethod::point_to_point; }
  void sample_every(std::size_t stride);
  double fitting_scale_m() const;
  State narrow();
  State examine(const Weighing& weighing) const;
  State widened_for_weak(State state);
  Step next_step(const State& state) const;
  Vector6 accept_lower(const State& state, Step step);
  Settling settle(const State& state, Step step);
  bool small(const Vector6& twist, const DataFrame& frame) const;
  bool iterate(IcpResult& result);
  bool descend(const Pose& guess, IcpResult& result);
  bool may_go_on(const IcpResult& result) const {
    return result.iterations < options_.max_iterations;
  }
  void count_iteration(IcpResult& result) const;
  // icp_approach.cpp
  bool is_near() const;
  double roughness() const;
  double contradicted() const;
  void approach(IcpResult& result);
  bool seek_better(const Pose& guess, IcpResult& result);
  bool withhold_more(const State& state);
  Stop judge(const State& state) const;
  void report(const State& state, IcpResult& result) const;

  const PreparedCloud& source_;
  const PreparedCloud& target_;
  const IcpOptions& options_;
  PairFinder finder_;
  Pose pose_ = Pose::Identity();
  std::size_t stride_ = 1;
  std::vector<std::uint32_t> sample_;
  std::vector<Match> matches_;
  Weighing weighing_;
  double scale_in_medians_ = 0;
  bool settled_ = false;       // the scale follows the residuals no further
  double opening_ = 0;         // share of the sample that the gates let pass at first; 0: closed
  bool near_ = false;          // the guess
  TwistBasis withheld_{6, 0};  // at least, about withheld_frame_
  DataFrame withheld_frame_;
};

}  // namespace scan
