// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/scan_edges.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace scan {
namespace {

const Eigen::Vector3d arm(0.3, -0.1, 0.2);  // from the target's origin to the overlap's centre
constexpr double rms_m = 1e-3, size_m = 0.2;

PreparedScans two_scans() {
  PreparedScans scans;
  scans.clouds.resize(2);
  scans.clouds[0].radius_m = size_m;  // the source, which is the smaller one
  scans.clouds[1].radius_m = 2.5 * size_m;
  scans.clouds[1].origin = {1, 2, 3};
  return scans;
}

PoseEdge edge_of(const Matrix6& information, double guess_sigma_m = 0) {
  const PreparedScans scans = two_scans();
  ScanEdge edge{.source = 0, .target = 1};
  edge.rms_m = rms_m;
  edge.centre = scans.clouds[1].origin + arm;
  edge.information = information;
  return graph_edge(scans, edge, guess_sigma_m);
}

// An icp that is sure without limit leaves what a distortion may do: at the overlap's centre
// shifts of the residuals' rms, and turns of that over the size. The centre's motion follows from
// the twist about the origin as t + w x arm.
TEST(GraphEdge, IsNoSurerThanADistortionAllows) {
  const Matrix6 covariance = edge_of(1e18 * Matrix6::Identity()).information.inverse();
  Eigen::Matrix<double, 3, 6> motion_of_centre;
  motion_of_centre << -cross_matrix(arm), Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d shift = motion_of_centre * covariance * motion_of_centre.transpose();
  const double turn = rms_m / size_m;
  // 1e18 stands for infinity: its 1e-18 are 1e-12 of the smallest variance.
  EXPECT_TRUE(shift.isApprox(rms_m * rms_m * Eigen::Matrix3d::Identity(), 1e-9)) << shift;
  EXPECT_TRUE(
      (covariance.topLeftCorner<3, 3>().isApprox(turn * turn * Eigen::Matrix3d::Identity(), 1e-9)));
}

// Far below the limit the icp's own information is kept: of half the limit a third is lost.
TEST(GraphEdge, KeepsWhatIsUnsureAnyway) {
  Vector6 limit;
  limit << Eigen::Vector3d::Constant(size_m * size_m / (rms_m * rms_m)),
      Eigen::Vector3d::Constant(1 / (rms_m * rms_m));
  const Matrix6 whole = edge_of(1e30 * Matrix6::Identity()).information;
  const Matrix6 half = edge_of(Matrix6((0.5 * limit).asDiagonal())).information;
  EXPECT_TRUE(half.isApprox(whole / 3, 1e-9));  // 1 / (1 / 0.5 + 1) of the limit
}

TEST(GraphEdge, LeavesOpenWhatIsOpen) {
  Matrix6 information = 1e6 * Matrix6::Identity();
  information(5, 5) = 0;  // slides along z
  const Matrix6 about_origin = edge_of(information).information;
  const double others = about_origin.norm();
  EXPECT_LT(about_origin.col(5).norm(), 1e-12 * others);  // rounding
  EXPECT_GT(about_origin(3, 3), 1e-3 * others);
}

// What a pair leaves open is as sure as the guess, at the overlap's centre: a slide by its sigma, a
// turn by that over the size; what it fixes is as sure as before.
TEST(GraphEdge, IsAsSureAsTheGuessAlongWhatIsOpen) {
  constexpr double guess_m = 0.02;
  Matrix6 information = 1e12 * Matrix6::Identity();
  information(0, 0) = information(5, 5) = 0;
  Matrix6 to_centre = Matrix6::Identity();
  to_centre.bottomLeftCorner<3, 3>() = -cross_matrix(arm);
  const Matrix6 about_centre =
      to_centre * edge_of(information, guess_m).information.inverse() * to_centre.transpose();
  Vector6 sigmas;  // 1e12 is 1e6 and more of what a distortion allows
  const double turn = rms_m / size_m;
  sigmas << guess_m / size_m, turn, turn, rms_m, rms_m, guess_m;
  const Matrix6 should = sigmas.cwiseAbs2().asDiagonal();
  EXPECT_TRUE(about_centre.isApprox(should, 1e-5)) << about_centre;
}

// Less than 1e-12 of what it fixes best a pair leaves open; more it fixes, if badly.
TEST(GraphEdge, TakesARoundedShareForNothing) {
  constexpr double guess_m = 0.02;
  for (const auto& [share, is_open] : {std::pair(1e-9, false), {1e-14, true}}) {
    Matrix6 information = 1e6 * Matrix6::Identity();
    information(5, 5) *= share / (size_m * size_m);  // shifts count at the size
    EXPECT_EQ(edge_of(information, guess_m).information(5, 5) > 0.5 / (guess_m * guess_m), is_open);
  }
}

// Pairs that moved by 1, 3 and 9 mm along z, the one motion that they fix, and any way along those
// that they leave open; one that fixes nothing says nothing.
TEST(GuessSigma, IsTheMedianAlongWhatPairsFix) {
  const PreparedScans scans = two_scans();
  // Scans that stand across: what is off is told in the target's frame.
  const Eigen::Matrix3d turn = exp((Vector6() << 1.5, 0, 0, 0, 0, 0).finished()).linear();
  std::vector<ScanEdge> edges;
  for (const double along_m : {9e-3, 1e-3, 3e-3, 0.5}) {
    ScanEdge edge{.source = 0, .target = 1, .stop = Stop::degenerate};
    edge.centre = scans.clouds[1].origin + arm;
    edge.target_from_source_guess.linear() = turn;
    edge.target_from_source = Eigen::Translation3d(0.1, -0.2, along_m) * Pose(turn);
    if (along_m < 0.1) edge.information(5, 5) = 1e6;
    edges.push_back(edge);
  }
  EXPECT_NEAR(guess_sigma_m(scans, edges), 3e-3, 1e-12);  // rounding of 1 m
  EXPECT_EQ(guess_sigma_m(scans, std::span(edges).last(1)), 0);
}

// Pairs off their guesses along what they fix, of which the second one comes to leave a slide
// open.
TEST(OpenSigma, IsThatOfTheGuessesWhereAnAcceptedPairAloneLeavesAMotionOpen) {
  PreparedScans scans = two_scans();
  scans.clouds.resize(3);
  scans.clouds[2].radius_m = size_m;
  std::vector<ScanEdge> edges;
  for (const double along_m : {1e-3, 3e-3}) {
    ScanEdge edge{
        .source = 2 * edges.size(), .target = 1, .stop = Stop::converged, .accepted = true};
    edge.centre = scans.clouds[1].origin + arm;
    edge.target_from_source = Eigen::Translation3d(along_m, along_m, along_m) * Pose::Identity();
    edge.information = 1e6 * Matrix6::Identity();
    edges.push_back(edge);
  }
  EXPECT_EQ(open_sigma_m(scans, edges), 0);
  edges[1].information(3, 3) = 0;
  EXPECT_EQ(open_sigma_m(scans, edges), guess_sigma_m(scans, edges));
  EXPECT_GT(guess_sigma_m(scans, edges), 0);
  edges.push_back(edges[0]);  // a way around it, from 0 to 2
  edges[2].target = 2;
  EXPECT_EQ(open_sigma_m(scans, edges), 0);
  edges[2].accepted = false;
  EXPECT_GT(open_sigma_m(scans, edges), 0);
  edges[1].accepted = false;
  EXPECT_EQ(open_sigma_m(scans, edges), 0);
}

// Off by 3 mm along one motion and 1 along another that they fix: root mean square of both. A pair
// without an answer says nothing.
TEST(GuessSigma, IsARootMeanSquareOverWhatPairsFix) {
  const PreparedScans scans = two_scans();
  ScanEdge edge{.source = 0, .target = 1, .stop = Stop::degenerate};
  edge.centre = scans.clouds[1].origin + arm;
  edge.target_from_source = Eigen::Translation3d(0.1, 1e-3, 3e-3) * Pose::Identity();
  edge.information(4, 4) = edge.information(5, 5) = 1e6;
  ScanEdge failed = edge;
  failed.stop = Stop::no_correspondences;
  failed.target_from_source.translation().z() = 1;
  EXPECT_NEAR(guess_sigma_m(scans, std::vector{edge, failed, failed}), std::sqrt(5) * 1e-3, 1e-12);
}

// Noise-free scans have residuals of rounding: 1e-12 of how far off zero their points are.
TEST(GraphEdge, IsNoSurerThanRounding) {
  const PreparedScans scans = two_scans();
  ScanEdge edge{.source = 0, .target = 1};
  edge.centre = scans.clouds[1].origin;
  edge.information = 1e40 * Matrix6::Identity();
  const double off_m = 1e-12 * (size_m + scans.clouds[1].origin.norm());
  const Matrix6 information = graph_edge(scans, edge, 0).information;
  EXPECT_NEAR(information(3, 3) * off_m * off_m, 1, 1e-6);
  EXPECT_NEAR(information(0, 0) * off_m * off_m / (size_m * size_m), 1, 1e-6);
}

// Three answers for one pair that contradict each other, and a sure one that is none.
TEST(SolveEdges, BelievesTheSurestByOverlapAndAgreement) {
  const PreparedScans scans = two_scans();
  std::vector<ScanEdge> edges;
  for (const auto& [overlap, agreement] :
       {std::pair(0.9, 0.5), {0.6, 0.8}, {0.5, 0.9}, {1.0, 1.0}}) {
    ScanEdge edge{.source = 0, .target = 1, .stop = Stop::converged};
    edge.overlap = overlap, edge.agreement = agreement, edge.rms_m = rms_m;
    edge.information = 1e6 * Matrix6::Identity();
    edge.target_from_source.translation().x() = 0.2 * double(edges.size());
    edge.accepted = true;
    edges.push_back(edge);
  }
  edges[3].stop = Stop::low_overlap;
  const std::vector<Pose> starts(2, Pose::Identity());
  const SolvedPoses solved = solve_edges(scans, starts, edges, 1, {});
  for (std::size_t k = 0; k < edges.size(); ++k) EXPECT_EQ(edges[k].accepted, k == 1) << k;
  // The local origins: that of the target is (1, 2, 3) in its cloud.
  const Eigen::Vector3d should = Eigen::Vector3d(0.2, 0, 0) - scans.clouds[1].origin;
  EXPECT_LT((solved.world_from_local[0].translation() - should).norm(), 1e-9);
}

// The same where the guesses rule out the surest.
TEST(SolveEdges, LeavesOutWhatTheGuessesRuleOut) {
  const PreparedScans scans = two_scans();
  std::vector<ScanEdge> edges;
  for (const double off_m : {0.0, 0.3}) {
    ScanEdge edge{.source = 0, .target = 1, .stop = Stop::iteration_limit};
    edge.overlap = 0.5 + off_m, edge.agreement = 1, edge.rms_m = rms_m;
    edge.information = 1e6 * Matrix6::Identity();
    edge.target_from_source.translation().x() = off_m;
    edges.push_back(edge);
  }
  const std::vector<Pose> guesses = {Pose(Eigen::Translation3d(-scans.clouds[1].origin)),
                                     Pose::Identity()};
  solve_edges(scans, guesses, edges, 1, {});
  EXPECT_TRUE(edges[1].accepted && !edges[0].accepted);
  const std::vector<GuessSigma> sigmas(2, {.rotation_rad = 1e-3, .translation_m = 1e-3});
  solve_edges(scans, guesses, edges, 1, {guesses, sigmas});
  EXPECT_TRUE(edges[0].accepted && !edges[1].accepted);
}

// sqrt(22.458) of 0.05 rad or 0.05 of the smaller size, of scans that stand across.
TEST(WithinGuess, EndsAtAThousandthOfWhatGuessesAreOff) {
  const PreparedScans scans = two_scans();
  const std::vector<Pose> poses = {exp((Vector6() << 0.3, -1, 0.5, 1, 2, 3).finished()),
                                   exp((Vector6() << -0.7, 0.2, 1, 0, 1, -2).finished())};
  const double limit = std::sqrt(22.458) * 0.05;
  for (int axis = 0; axis < 6; ++axis)
    for (const double share : {0.99, 1.01}) {
      Vector6 off = Vector6::Zero();
      off[axis] = share * limit * (axis < 3 ? 1 : size_m);
      ScanEdge edge{.source = 0, .target = 1};
      edge.target_from_source =
          global_pose(exp(off) * poses[1].inverse() * poses[0], scans.clouds[0], scans.clouds[1]);
      EXPECT_EQ(within_guess(scans, edge, poses), share < 1) << axis;
    }
}

}  // namespace
}  // namespace scan
