// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What `scan verify` makes of input that cannot be right: said in one line, with the right exit
// code.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/judged_cube.h"
#include "tests/tools/small_run.h"

namespace scan::test {
namespace {

constexpr int failed = 1, input = 3;

TEST(VerifyInput, AGrownCubeHasItsClosedFormFigures) {
  const Folder folder;
  const Judged same = judged(folder, cube_off(1.001, 0));
  EXPECT_EQ(same.outcome.exit_code, 0) << same.outcome.err;
  EXPECT_NEAR(same.figure("volume_error"), 1.001 * 1.001 * 1.001 - 1, 1e-12);
  EXPECT_NEAR(same.figure("area_error"), 1.001 * 1.001 - 1, 1e-12);
  EXPECT_FALSE(says(same.outcome, "another")) << same.outcome.err;
}

TEST(VerifyInput, AnotherUnitIsSuspectedWithItsFactor) {
  const Folder folder;
  const Judged other = judged(folder, cube_off(1000, 0));
  EXPECT_TRUE(says(other.outcome, "measured.off: its size is")) << other.outcome.err;
  EXPECT_TRUE(says(other.outcome, "scale it by 0.001")) << other.outcome.err;
}

TEST(VerifyInput, InchesAreSuspectedWithTheirFactor) {
  const Folder folder;
  const Judged other = judged(folder, cube_off(1 / 0.0254, 0));
  EXPECT_TRUE(says(other.outcome, "scale it by 0.0254\n")) << other.outcome.err;
}

TEST(VerifyInput, AMeasuredFileThatIsNotThereIsNamed) {
  const Outcome outcome = run_scan({"verify", "no-such-run"});
  EXPECT_EQ(outcome.exit_code, input);
  EXPECT_TRUE(says(outcome, "no-such-run: no such file or folder")) << outcome.err;
}

TEST(VerifyInput, AnotherFrameIsSuspectedWithItsGap) {
  const Folder folder;
  const Judged other = judged(folder, cube_off(1, 10));
  EXPECT_TRUE(says(other.outcome, "another frame? Then align it first")) << other.outcome.err;
}

TEST(VerifyInput, ATriangleWithoutAreaDoesNoHarm) {
  const Folder folder;
  const Judged thin = judged(folder, cube_off(1, 0, "3 0 0 1\n", 1));
  EXPECT_EQ(thin.outcome.exit_code, 0) << thin.outcome.err;
  EXPECT_NEAR(thin.figure("accuracy_max"), 0, 1e-15);
}

TEST(VerifyInput, AMeshOfNothingButThinTrianglesIsRefusedByName) {
  const Folder folder;
  const std::string flat = "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";
  const Judged refused = judged(folder, flat);
  EXPECT_EQ(refused.outcome.exit_code, input);
  EXPECT_TRUE(says(refused.outcome, "measured.off: none of its triangles has an area"))
      << refused.outcome.err;
  spill(folder / "flat.off", flat);
  const Outcome truth = run_scan(
      {"verify", (folder / "measured.off").string(), "--truth", (folder / "flat.off").string()});
  EXPECT_EQ(truth.exit_code, input);
  EXPECT_TRUE(says(truth, "flat.off: none of its triangles has an area")) << truth.err;
}

TEST(VerifyInput, ATruthWithoutCoordinatesIsRefusedByName) {
  const Folder folder;
  std::string text = cube_off(1, 0);
  text.replace(text.find("0 0 0\n"), 5, "0 nan 0");
  spill(folder / "measured.off", cube_off(1, 0));
  spill(folder / "nan.off", text);
  const Outcome outcome = run_scan(
      {"verify", (folder / "measured.off").string(), "--truth", (folder / "nan.off").string()});
  EXPECT_EQ(outcome.exit_code, input);
  EXPECT_TRUE(says(outcome, "nan.off: line")) << outcome.err;
}

TEST(VerifyInput, ABrokenMeshIsRefusedByName) {
  const Folder folder;
  for (const std::string& broken :
       {std::string("OFF\n0 0 0\n"), std::string("OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"),
        cube_off(1, 0, "3 0 1 99\n", 1)}) {
    const Judged refused = judged(folder, broken);
    EXPECT_EQ(refused.outcome.exit_code, input) << broken << refused.outcome.err;
    EXPECT_TRUE(says(refused.outcome, "error: ")) << refused.outcome.err;
    EXPECT_TRUE(says(refused.outcome, "measured.off")) << refused.outcome.err;
  }
}

TEST(VerifyInput, EachFigureStandsWithItsDefinition) {
  const Folder folder;
  const Judged same = judged(folder, cube_off(1, 0));
  for (const auto& m : same.json.at("measurements"))
    EXPECT_NE(m.at("definition"), "") << m.at("name");
  const Outcome text = run_scan(
      {"verify", (folder / "measured.off").string(), "--truth", (folder / "truth.off").string()});
  EXPECT_NE(text.out.find("mean of the distances |d| of the measured surface from the true one"),
            std::string::npos)
      << text.out;
}

// A second cube, half inside the first: the walls of both overlap and cross.
TEST(VerifyInput, SelfIntersectionsAreCounted) {
#ifdef LIBSCAN_WITH_CGAL
  const Folder folder;
  EXPECT_EQ(judged(folder, cube_off(1, 0)).figure("self_intersections"), 0);
  const std::string one = cube_off(1, 0), other = cube_off(1, 0.5);
  const auto corners = [](const std::string& off) {
    return off.substr(off.find('\n', 4) + 1, off.find("3 0 2 3") - off.find('\n', 4) - 1);
  };
  std::string faces = one.substr(one.find("3 0 2 3")), moved;
  std::istringstream lines(faces);
  for (int three, a, b, c; lines >> three >> a >> b >> c;)
    moved += "3 " + std::to_string(a + 8) + " " + std::to_string(b + 8) + " " +
             std::to_string(c + 8) + "\n";
  const Judged both =
      judged(folder, "OFF\n16 24 0\n" + corners(one) + corners(other) + faces + moved);
  EXPECT_GT(both.figure("self_intersections"), 0);
#else
  GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
#endif
}

TEST(VerifyInput, ARunFolderCutShortIsNamedWithItsStage) {
  const Folder folder;
  const auto verified = [&] { return run_scan({"verify", folder.path().string()}); };
  EXPECT_EQ(verified().exit_code, input);
  EXPECT_TRUE(says(verified(), "holds no recipe.json")) << verified().err;
  std::filesystem::copy_file(LIBSCAN_SOURCE_DIR "/datasets/recipes/pavilion-lidar.json",
                             folder / "recipe.json");
  EXPECT_TRUE(says(verified(), "ended before simulate was done")) << verified().err;
  std::filesystem::create_directory(folder / "truth");
  spill(folder / "truth" / "surface.json", "{\"shapes\": [");
  EXPECT_EQ(verified().exit_code, input) << verified().err;
}

// Each file of a whole run cut in half, as by a full disk, is named.
TEST(VerifyInput, EachFileCutShortIsNamed) {
  const Folder folder;
  const std::string run = (folder / "run").string();
  std::filesystem::copy(small_run(), run, std::filesystem::copy_options::recursive);
  for (const std::string file : {"surface.ply", "poses.tum", "alignment.json", "scans/001.ply",
                                 "truth/surface.json", "truth/001.ply"}) {
    const std::filesystem::path path = folder / ("run/" + file);
    const std::string whole = slurp(path);
    spill(path, whole.substr(0, whole.size() / 2));
    const Outcome outcome = run_scan({"verify", run});
    EXPECT_EQ(outcome.exit_code, input) << file << outcome.err;
    EXPECT_TRUE(says(outcome, file)) << outcome.err;
    EXPECT_TRUE(says(outcome, "--resume goes on with it")) << outcome.err;
    spill(path, whole);
  }
  std::filesystem::remove(folder / "run/scans/001.ply");
  EXPECT_EQ(run_scan({"verify", run}).exit_code, input);
}

TEST(VerifyInput, ATruthWithHolesIsSaidToHaveThem) {
  const Folder folder;
  std::string open = cube_off(1, 0);
  open.replace(open.find("8 12 0"), 6, "8 11 0");
  open.erase(open.find("3 1 7 5"));
  spill(folder / "measured.off", cube_off(1, 0));
  spill(folder / "open.off", open);
  const Outcome outcome = run_scan({"verify", (folder / "measured.off").string(), "--truth",
                                    (folder / "open.off").string(), "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome, "has holes (3 boundary edges)")) << outcome.err;
  EXPECT_EQ(outcome.out.find("volume_error"), std::string::npos);
  EXPECT_FALSE(says(judged(folder, cube_off(1, 0)).outcome, "holes"));
}

// Of points without coordinates the cloud keeps none; a surface of none is refused.
TEST(VerifyInput, ACloudOfNothingIsRefused) {
  const Folder folder;
  spill(folder / "cloud.xyz", "nan nan nan\nnan 0 0\n");
  spill(folder / "truth.off", cube_off(1, 0));
  const Outcome outcome = run_scan(
      {"verify", (folder / "cloud.xyz").string(), "--truth", (folder / "truth.off").string()});
  EXPECT_EQ(outcome.exit_code, input);
  EXPECT_TRUE(says(outcome, "cloud.xyz")) << outcome.err;
}

// Figures alone are no verdict.
TEST(VerifyInput, WithoutLimitsThereIsNoVerdict) {
  const Folder folder;
  spill(folder / "truth.off", cube_off(1, 0));
  const std::string truth = (folder / "truth.off").string();
  const Outcome figures = run_scan({"verify", truth, "--truth", truth});
  EXPECT_EQ(figures.exit_code, 0) << figures.err;
  EXPECT_EQ(figures.out.find("PASS"), std::string::npos);
  EXPECT_NE(figures.out.find("no limits, no verdict"), std::string::npos) << figures.out;
  spill(folder / "limits.json",
        R"([{"name": "accuracy_rms", "at_most_mm": 1, "reason": "the process"}])");
  const Outcome judged =
      run_scan({"verify", truth, "--truth", truth, "--limits", (folder / "limits.json").string()});
  EXPECT_NE(judged.out.find("PASS"), std::string::npos) << judged.out;
}

TEST(VerifyInput, ALimitOnWhatWasNotMeasuredIsAnError) {
  const Folder folder;
  const auto limits = (folder / "limits.json").string();
  spill(limits, R"([{"name": "accuracy_rmz", "at_most_mm": 1, "reason": "a slip"}])");
  const Judged slip = judged(folder, cube_off(1, 0), {"--limits", limits});
  EXPECT_EQ(slip.outcome.exit_code, input) << slip.outcome.err;
  EXPECT_TRUE(says(slip.outcome, "accuracy_rms")) << slip.outcome.err;
  // a figure of runs, and one that an open surface does not have
  spill(limits, R"([{"name": "pose_error_rms", "at_most_mm": 1, "reason": "the arm"}])");
  const Judged of_runs = judged(folder, cube_off(1, 0), {"--limits", limits});
  EXPECT_EQ(of_runs.outcome.exit_code, input);
  EXPECT_TRUE(says(of_runs.outcome, "which this input does not have")) << of_runs.outcome.err;
  spill(limits, R"([{"name": "genus", "equals": 0, "reason": "a solid"}])");
  std::string open = cube_off(1, 0);
  open.replace(open.find("8 12 0"), 6, "8 11 0");
  open.erase(open.find("3 1 7 5"));
  EXPECT_EQ(judged(folder, open, {"--limits", limits}).outcome.exit_code, failed);
  spill(limits, R"([{"name": "accuracy_rms", "at_most_mm": 1, "reason": "the process"}])");
  EXPECT_EQ(judged(folder, cube_off(1.1, 0), {"--limits", limits}).outcome.exit_code, failed);
}

}  // namespace
}  // namespace scan::test
