// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pose_step.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/align/rigid_fit.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t chunk = 256;
// Sums of a few operations: below this many, handing them over costs more than it saves.
constexpr std::size_t light_chunk = 2048;
// So many pairs decide what is weak; more would cost time and tell nothing new.
constexpr std::size_t most_judged = 4096;

template <class Residual>
void add(NormalEquations& sum, const PointPair& pair, double weight, const DataFrame& frame) {
  auto jacobian = Residual::jacobian(pair, frame.centre).eval();
  jacobian.template leftCols<3>() /= frame.size_m;
  const auto weighted = (weight * jacobian.transpose()).eval();
  sum.a.noalias() += weighted * jacobian;
  sum.b.noalias() -= weighted * Residual::value(pair) / frame.size_m;
}

void add_metric(NormalEquations& sum, const PointPair& pair, const Eigen::Matrix3d& metric,
                double weight, const DataFrame& frame) {
  auto jacobian = PointToPoint::jacobian(pair, frame.centre);
  jacobian.leftCols<3>() /= frame.size_m;
  const Eigen::Matrix<double, 6, 3> weighted = weight * jacobian.transpose() * metric;
  sum.a.noalias() += weighted * jacobian;
  sum.b.noalias() -= weighted * PointToPoint::value(pair) / frame.size_m;
}

Step rigid_step(const PairFinder& finder, const Pose& pose, std::span<const Couple> couples,
                const WelschLoss& loss, const DataFrame& frame, const TwistBasis& withheld) {
  std::vector<Eigen::Vector3d> moved, partners;
  std::vector<double> weights;
  for (const Couple& couple : couples) {
    const PointPair pair = finder.pair(pose, couple);
    moved.push_back(pair.moved - frame.centre);
    partners.push_back(pair.target - frame.centre);
    weights.push_back(loss.weight(couple.residual_m));
  }
  const Pose best = rigid_fit(moved, partners, weights).target_from_source;
  double squares_m2 = 0;
  for (std::size_t i = 0; i < moved.size(); ++i)
    squares_m2 += weights[i] * (best * moved[i] - moved[i]).squaredNorm();
  Vector6 twist = log(best);
  twist.tail<3>() /= frame.size_m;
  return {.twist = complement_projector(withheld) * twist,
          .change_m = std::sqrt(squares_m2),
          .sigma_m = rms_m(couples, loss)};
}

}  // namespace

DataFrame frame_of(const PairFinder& finder, const Pose& pose, std::span<const Couple> couples) {
  struct Sum {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double squares_m2 = 0;
    Sum& operator+=(const Sum& other) {
      at += other.at, squares_m2 += other.squares_m2;
      return *this;
    }
  };
  // About the pose's image of the source's middle, which is near enough to the pairs' own.
  const Eigen::Vector3d middle = pose.translation();
  const Sum sum =
      ordered_sum(couples.size(), light_chunk, Sum{}, [&](std::size_t begin, std::size_t end) {
        Sum part;
        for (const Couple& couple : couples.subspan(begin, end - begin)) {
          const Eigen::Vector3d arm = pose.linear() * finder.source().points[couple.source];
          part.at += arm;
          part.squares_m2 += arm.squaredNorm();
        }
        return part;
      });
  const auto count = static_cast<double>(couples.size());
  const Eigen::Vector3d mean = sum.at / count;
  const double size_m = std::sqrt(std::max(0.0, sum.squares_m2 / count - mean.squaredNorm()));
  return {middle + mean, size_m > 0 ? size_m : 1};  // all the same point: any unit will do
}

double rms_m(std::span<const Couple> couples, const WelschLoss& loss) {
  double squares_m2 = 0, weights = 0;
  for (const Couple& couple : couples) {
    const double weight = loss.weight(couple.residual_m);
    squares_m2 += weight * couple.residual_m * couple.residual_m;
    weights += weight;
  }
  return weights > 0 ? std::sqrt(squares_m2 / weights) : 0;
}

NormalEquations normal_equations(const PairFinder& finder, const Pose& pose,
                                 std::span<const Couple> couples, const WelschLoss& loss,
                                 const DataFrame& frame) {
  return ordered_sum(couples.size(), chunk, NormalEquations{},
                     [&](std::size_t begin, std::size_t end) {
                       NormalEquations sum;
                       for (const Couple& couple : couples.subspan(begin, end - begin)) {
                         const PointPair pair = finder.pair(pose, couple);
                         const double weight = loss.weight(couple.residual_m);
                         const double square_m2 = couple.residual_m * couple.residual_m;
                         sum.weights += weight;
                         sum.squares_m2 += weight * square_m2;
                         if (finder.method() == IcpMethod::point_to_point)
                           add<PointToPoint>(sum, pair, weight, frame);
                         else if (finder.method() == IcpMethod::symmetric)
                           add<Symmetric>(sum, pair, weight, frame);
                         else if (finder.method() == IcpMethod::point_to_plane)
                           add<PointToPlane>(sum, pair, weight, frame);
                         else
                           add_metric(sum, pair, finder.metric(pose, couple), weight, frame);
                       }
                       return sum;
                     });
}

Step best_step(const PairFinder& finder, const Pose& pose, std::span<const Couple> couples,
               const WelschLoss& loss, const DataFrame& frame, const TwistBasis& withheld) {
  if (finder.method() == IcpMethod::point_to_point)
    return rigid_step(finder, pose, couples, loss, frame, withheld);
  const NormalEquations sums = normal_equations(finder, pose, couples, loss, frame);
  const Vector6 twist = solve_withholding(sums.a, sums.b, withheld);
  const Matrix6 squares_m2 = frame.size_m * frame.size_m * sums.a;
  const double variance_m2 = sums.squares_m2 / sums.weights;
  return {twist, std::sqrt(std::max(0.0, twist.dot(squares_m2 * twist))), squares_m2,
          std::sqrt(variance_m2), 1 - variance_m2 / (loss.scale_m * loss.scale_m)};
}

Pose moved(const Pose& pose, Vector6 twist, const DataFrame& frame) {
  twist.tail<3>() *= frame.size_m;
  const Pose moved =
      Eigen::Translation3d(frame.centre) * exp(twist) * Eigen::Translation3d(-frame.centre) * pose;
  return make_pose(nearest_rotation(moved.linear()), moved.translation());
}

namespace {

// The error of the normal that the method goes by; `mean`: of the mean of both scans' normals,
// which errs by half of what the two err together.
std::optional<Eigen::Vector3d> normal_error(const PairFinder& finder, const Pose& pose,
                                            const Couple& couple, const PointPair& pair, bool mean,
                                            NormalErrors errors) {
  const LocalFit& there = finder.target().fits[couple.target];
  const LocalFit& here = finder.source().fits[couple.source];
  const bool both = there.shape == LocalShape::surface && here.shape == LocalShape::surface;
  if (errors == NormalErrors::between_scans) {
    if (!both) return std::nullopt;
    return Eigen::Vector3d((mean ? 0.5 : std::numbers::sqrt2 / 2) *
                           (pair.moved_normal - pair.normal));
  }
  if (there.shape != LocalShape::surface) return std::nullopt;
  const Eigen::Vector3d tilt = there.tilt.cast<double>();
  if (!mean || !both) return tilt;
  return Eigen::Vector3d(0.5 * (tilt + pose.linear() * here.tilt.cast<double>()));
}

bool are_marks(const PairFinder& finder, std::span<const Couple> couples) {
  const auto planes = std::count_if(couples.begin(), couples.end(), [&](const Couple& couple) {
    return !finder.target().normals[couple.target].isZero(0);
  });
  return 2 * static_cast<std::size_t>(planes) < couples.size();
}

}  // namespace

MotionInformation motion_information(const PairFinder& finder, const Pose& pose,
                                     std::span<const Couple> couples, const DataFrame& frame,
                                     NormalErrors errors) {
  const bool mean = finder.method() == IcpMethod::symmetric;
  const bool marks = are_marks(finder, couples);
  const std::size_t stride = std::max<std::size_t>(1, couples.size() / most_judged);
  const auto add = [&](const Couple& couple, MotionInformation& sum) {
    const PointPair pair = finder.pair(pose, couple);
    const Eigen::Vector3d arm = (pair.target - frame.centre) / frame.size_m;
    if (marks) {
      const LocalFit& there = finder.target().fits[couple.target];
      const Eigen::Vector3d along =
          there.shape == LocalShape::line ? there.direction : Eigen::Vector3d::Zero();
      if (there.shape != LocalShape::unknown)
        sum.add_mark(arm, Eigen::Matrix3d::Identity() - along * along.transpose());
    } else if (!pair.normal.isZero(0)) {
      const Eigen::Vector3d normal =
          mean ? Eigen::Vector3d(0.5 * (pair.normal + pair.moved_normal)) : pair.normal;
      sum.add_plane(arm, normal, normal_error(finder, pose, couple, pair, mean, errors));
    }
  };
  const std::size_t judged = (couples.size() + stride - 1) / stride;
  return ordered_sum(judged, chunk, MotionInformation{}, [&](std::size_t begin, std::size_t end) {
    MotionInformation sum;
    for (std::size_t k = begin; k < end; ++k) add(couples[k * stride], sum);
    return sum;
  });
}

}  // namespace scan
