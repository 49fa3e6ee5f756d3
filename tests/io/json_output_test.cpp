// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/json_output.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/io/poses.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::vector<std::string> keys_of(const ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(JsonOutput, MeasurementsHaveTheirStableKeys) {
  Measurement measurement;
  measurement.name = "genus";
  measurement.value = 4;
  const ordered_json free = measurement_json(measurement);
  EXPECT_EQ(keys_of(free), (std::vector<std::string>{"name", "value", "unit", "definition", "over",
                                                     "count", "limit", "relation", "pass", "reason",
                                                     "interval", "expected"}));
  EXPECT_TRUE(free["limit"].is_null());
  EXPECT_TRUE(free["relation"].is_null());
  measurement.value = std::nan("");
  measurement.limit = 0.1;
  measurement.relation = "<=";
  measurement.reason = "spec";
  measurement.pass = false;
  const ordered_json limited = measurement_json(measurement);
  EXPECT_TRUE(limited["value"].is_null());
  EXPECT_EQ(limited["limit"], 0.1);
  EXPECT_EQ(limited["reason"], "spec");
  EXPECT_EQ(limited["pass"], false);
}

TEST(JsonOutput, AlignmentIsWhatReadPosesReads) {
  const TemporaryFolder folder;
  MultiviewResult result;
  result.scans.resize(2);
  Vector6 twist;
  twist << 1, 2, 3, 1.0 / 3, 5, 6;
  result.scans[1].world_from_scan = exp(twist);
  result.scans[1].stop = Stop::converged;
  Vector6 variances;
  variances << 1, 4, 9, 16, 25, 36;
  result.scans[1].covariance = Matrix6(variances.asDiagonal());
  result.scans[1].covariance_from_guess = Matrix6::Zero();
  (*result.scans[1].covariance_from_guess)(4, 4) = 16;
  result.edges.push_back({.source = 0, .target = 1});
  const std::vector<std::string> files = {"a.ply", "b.ply"};
  const ordered_json alignment = alignment_json(files, result, {});
  EXPECT_EQ(keys_of(alignment["scans"][0]),
            (std::vector<std::string>{"file", "world_from_scan", "stop", "iterations", "rms_m",
                                      "inlier_fraction_of_source", "agreement", "weak_directions",
                                      "sigma_rotation_rad", "sigma_translation_m", "covariance",
                                      "covariance_from_guess", "covariance_centre_m"}));
  EXPECT_TRUE(alignment["scans"][0]["covariance"].is_null());
  EXPECT_DOUBLE_EQ(alignment["scans"][1]["sigma_rotation_rad"].get<double>(), std::sqrt(14.0));
  EXPECT_DOUBLE_EQ(alignment["scans"][1]["sigma_translation_m"].get<double>(), std::sqrt(77.0));
  EXPECT_EQ(alignment["scans"][1]["covariance"][5][5], 36);
  EXPECT_EQ(alignment["scans"][1]["covariance_from_guess"][4][4], 16);
  EXPECT_EQ(keys_of(alignment["pairs"][0]),
            (std::vector<std::string>{"source", "target", "accepted", "stop", "overlap",
                                      "agreement", "rms_m"}));
  EXPECT_EQ(alignment["pairs"][0]["target"], "b.ply");
  EXPECT_EQ(alignment["scans"][1]["stop"], "converged");
  EXPECT_EQ(alignment["method"], "symmetric");
  EXPECT_EQ(alignment["search"], "kd-tree");
  EXPECT_EQ(json_text(alignment).find("seconds"), std::string::npos);
  write_json(folder / "alignment.json", alignment);
  const auto poses = read_poses(folder / "alignment.json");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].name, "b.ply");
  EXPECT_EQ(poses[1].pose.matrix(), result.scans[1].world_from_scan.matrix());
  error_of([&] { alignment_json(std::span(files).first(1), result, {}); }, Trouble::usage);
}

TEST(JsonOutput, SurfacesTellTheirTopology) {
  SurfaceResult result;
  result.method = "ssd";
  result.surface = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  result.depth = 8;
  result.parts.parts_per_axis = 4;
  const ordered_json object = surface_json(result);
  EXPECT_EQ(object["parts_per_axis"], 4);
  EXPECT_EQ(object["triangles"], 4);
  EXPECT_EQ(object["watertight"], true);
  EXPECT_EQ(object["genus"], 0);
  EXPECT_EQ(object["components"], 1);
  EXPECT_EQ(object["depth"], 8);
  EXPECT_TRUE(surface_json({})["depth"].is_null());
}

TEST(JsonOutput, ScansCountTheirRays) {
  Scan scan;
  scan.cloud.points.resize(3);
  scan.misses = {{"no signal", 2}};
  EXPECT_EQ(scan_json("scans/000.ply", scan)["rays"], 5);
  EXPECT_EQ(scan_json("scans/000.ply", scan)["misses"]["no signal"], 2);
  scan.grid = {2, 4};
  EXPECT_EQ(scan_json("scans/000.ply", scan)["rays"], 8);
}

TEST(JsonOutput, NumbersReadBackToTheBitAndNamesNeedNotBeUtf8) {
  RandomStream random(14, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const double number = random.normal() * std::pow(10, 20 * random.normal());
    EXPECT_EQ(json::parse(json_text(ordered_json(number))).get<double>(), number);
  }
  EXPECT_EQ(json_text(ordered_json(0.1)), "0.1\n");
  EXPECT_TRUE(json::accept(json_text(ordered_json("bad \xff name"))));
}

}  // namespace
}  // namespace scan
