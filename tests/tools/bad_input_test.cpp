// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Every kind of broken input gets one clear line, the documented exit code, and leaves nothing
// behind.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

constexpr int usage = 2, input = 3, computation = 4, output = 5;

// The last line of stderr is the error; there is exactly one such line, and no crash trace.
void expect_failure(const Outcome& outcome, int code, const std::string& mentions) {
  EXPECT_EQ(outcome.exit_code, code) << outcome.err;
  std::size_t errors = 0;
  std::istringstream lines(outcome.err);
  std::string line, last;
  while (std::getline(lines, line)) {
    errors += line.rfind("error: ", 0) == 0;
    last = line;
  }
  EXPECT_EQ(errors, 1u) << outcome.err;
  EXPECT_EQ(last.rfind("error: ", 0), 0u) << outcome.err;
  EXPECT_NE(last.find(mentions), std::string::npos) << "expected '" << mentions << "' in: " << last;
}

std::string ply_header(const std::string& vertices) {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices +
         "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
}

// A sphere's points with normals: good input for align and reconstruct.
std::string sphere_ply(int count, double x_offset) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
      "\nproperty double x\nproperty double y\nproperty double z\nproperty double nx\n"
      "property double ny\nproperty double nz\nend_header\n";
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), a = 2.399963 * i;
    const double x = r * std::cos(a), y = r * std::sin(a);
    char line[200];
    std::snprintf(line, sizeof line, "%.17g %.17g %.17g %.17g %.17g %.17g\n", x + x_offset, y, z, x,
                  y, z);
    text += line;
  }
  return text;
}

struct BadFile {
  std::string name;
  std::string file;
  std::string content;
};

std::vector<BadFile> bad_files() {
  std::string garbage;
  for (int i = 0; i < 4096; ++i) garbage += static_cast<char>((i * 7919 + 13) >> 3);
  return {
      {"empty", "a.ply", ""},
      {"garbage", "a.ply", garbage},
      {"not a PLY", "a.ply", "solid cube\nendsolid\n"},
      {"no end of header", "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"},
      {"truncated", "a.ply", ply_header("3") + "0 0 0\n1 0 0\n"},
      {"lying count", "a.ply", ply_header("1000000000000") + "0 0 0\n"},
      {"negative count", "a.ply", ply_header("-1") + "0 0 0\n"},
      {"zero points", "a.ply", ply_header("0")},
      {"letters for numbers", "a.ply", ply_header("2") + "0 0 0\n1 zwei 0\n"},
      {"only NaN", "a.ply", ply_header("2") + "nan nan nan\ninf 0 0\n"},
      {"no coordinates", "a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty double u\nend_header\n0\n"},
      {"empty XYZ", "a.xyz", ""},
      {"letters in XYZ", "a.xyz", "0 0 0\n1 2 drei\n"},
      {"garbage PCD", "a.pcd", garbage},
      {"lying PCD", "a.pcd",
       "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1000000000\nHEIGHT 1\n"
       "POINTS 1000000000\nDATA binary\nxyz"},
      {"garbage STL", "a.stl", garbage},
      {"garbage OBJ", "a.obj", garbage},
      {"unknown ending", "a.foo", "0 0 0\n"},
  };
}

TEST(BadInput, BrokenFilesGetOneLineAndNothingIsWritten) {
  for (const BadFile& bad : bad_files()) {
    SCOPED_TRACE(bad.name);
    const Folder folder;
    const std::string file = (folder / bad.file).string();
    spill(file, bad.content);
    expect_failure(run_scan({"info", file}), input, bad.file);
    expect_failure(run_scan({"reconstruct", file, (folder / "out.ply").string()}), input, bad.file);
    expect_failure(run_scan({"align", file, file, (folder / "aligned").string()}), input, bad.file);
    EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{bad.file});
  }
}

TEST(BadInput, MissingFilesAndFoldersAreNamed) {
  const Folder folder;
  const std::string missing = (folder / "missing.ply").string();
  expect_failure(run_scan({"info", missing}), input, "missing.ply");
  expect_failure(run_scan({"info", folder.path().string()}), input, "is a folder");
  expect_failure(run_scan({"acquire", "stereo", missing, missing, (folder / "p.ply").string()}),
                 usage, "--calibration: is missing");
  expect_failure(run_scan({"reconstruct", missing, (folder / "s.stl").string(), "--quads"}), usage,
                 "--quads");
  expect_failure(run_scan({"run", (folder / "missing.json").string(), (folder / "run").string()}),
                 input, "missing.json");
  EXPECT_TRUE(files_below(folder.path()).empty());
}

// `scan reconstruct a.ply b.ply` by someone who forgot the output must not cost b.ply.
TEST(BadInput, AnOutputThatIsAnInputIsRefused) {
  const Folder folder;
  spill(folder / "a.ply", sphere_ply(500, 0));
  const std::string a = (folder / "a.ply").string(), same = (folder / "./a.ply").string();
  expect_failure(run_scan({"reconstruct", a, same}), usage, "is an input, too");
  expect_failure(run_scan({"align", a, a}), usage, "is an input, too");
  EXPECT_EQ(slurp(a), sphere_ply(500, 0));
}

TEST(BadInput, HelpIsACommandToo) {
  const Outcome help = run_scan({"help", "align"});
  EXPECT_EQ(help.exit_code, 0) << help.err;
  EXPECT_EQ(help.out, run_scan({"align", "--help"}).out);
  EXPECT_EQ(run_scan({"help"}).out, run_scan({"--help"}).out);
}

TEST(BadInput, NamesThatAreNoTextAreReportedTooInJson) {
  const Folder folder;
  const Outcome outcome = run_scan({"info", (folder / "bad\xff.ply").string(), "--json"});
  expect_failure(outcome, input, "no such file");
  EXPECT_NE(outcome.out.find("no such file"), std::string::npos) << outcome.out;
}

TEST(BadInput, OnePointIsTooFew) {
  const Folder folder;
  const std::string one = (folder / "one.ply").string();
  spill(one, ply_header("1") + "0 0 0\n");
  expect_failure(run_scan({"reconstruct", one, (folder / "out.ply").string()}), input, "one.ply: ");
  expect_failure(run_scan({"align", one, one, (folder / "aligned").string()}), computation,
                 "alignment.json");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.ply"));
}

TEST(BadInput, ScansWithoutOverlapAreNotCalledAligned) {
  const Folder folder;
  const std::string a = (folder / "a.ply").string(), b = (folder / "b.ply").string();
  spill(a, sphere_ply(500, 0));
  spill(b, sphere_ply(500, 100));
  const Outcome outcome =
      run_scan({"align", a, b, (folder / "aligned").string(), "--max-distance", "1cm", "--json"});
  expect_failure(outcome, computation, "aligned");
  EXPECT_NE(outcome.out.find("\"status\": \"error\""), std::string::npos) << outcome.out;
  const std::string alignment = slurp(folder / "aligned/alignment.json");
  EXPECT_NE(alignment.find("no correspondences"), std::string::npos) << alignment;
}

// Waves of 0.2 m seen between two x, the whole scan shifted by `x_offset`.
std::string waves_ply(double from_m, double to_m, double x_offset_m) {
  constexpr int cells = 60;
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(cells * cells) +
                     "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (int i = 0; i < cells * cells; ++i) {
    const double x = from_m + (to_m - from_m) * (i % cells + 0.5) / cells;
    const double y = 2 * (i / cells + 0.5) / cells - 1;
    const double z = 0.2 * std::sin(4 * x) * std::cos(3 * y) + 0.1 * x * y;
    char line[120];
    std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", x + x_offset_m, y, z);
    text += line;
  }
  return text;
}

// Two scans that belong together, the second off by 1 cm, and one that meets neither: an error, and
// yet the two poses are there. Grids 27 mm apart of waves of 1 / (0.2 * 16) = 0.3 m radius find
// each other within a tenth of their spacing.
TEST(BadInput, AScanThatMeetsNoOtherLeavesTheOthersAligned) {
  const Folder folder;
  const std::string a = (folder / "a.ply").string(), b = (folder / "b.ply").string(),
                    far = (folder / "far.ply").string();
  spill(a, waves_ply(-1, 0.6, 0));
  spill(b, waves_ply(-0.6, 1, 0.01));
  spill(far, waves_ply(-1, 1, 100));
  const Outcome outcome = run_scan({"align", a, b, far, (folder / "aligned").string(), "--json"});
  expect_failure(outcome, computation, "alignment.json");
  const auto alignment = nlohmann::json::parse(slurp(folder / "aligned/alignment.json"));
  const auto& scans = alignment.at("scans");
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_EQ(scans[0].at("stop"), "converged");
  EXPECT_EQ(scans[1].at("stop"), "converged");
  EXPECT_EQ(scans[2].at("stop"), "no correspondences");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto shift_m = [&](std::size_t i) {
      return scans[i].at("world_from_scan").at(axis).at(3).get<double>();
    };
    EXPECT_NEAR(shift_m(1), axis == 0 ? -0.01 : 0, 0.0027);
    EXPECT_EQ(shift_m(2), 0);  // the guess
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "aligned/poses.tum"));
}

// A sphere and a piece of a saddle: nothing ties them. What is known is still written.
TEST(BadInput, ScansThatShareNothingAreNotTiedGlobally) {
  const Folder folder;
  const std::string a = (folder / "a.ply").string(), b = (folder / "b.ply").string();
  spill(a, sphere_ply(2000, 0));
  std::string saddle =
      "ply\nformat ascii 1.0\nelement vertex 2500\nproperty double x\nproperty double y\n"
      "property double z\nend_header\n";
  for (int i = 0; i < 2500; ++i) {
    const double x = 0.04 * (i % 50) - 1, y = 0.04 * (i / 50) - 1;
    saddle += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(x * y - 3) + "\n";
  }
  spill(b, saddle);
  const Outcome outcome = run_scan({"align", a, b, (folder / "aligned").string(), "--global"});
  EXPECT_EQ(outcome.exit_code, computation) << outcome.err;
  const std::string alignment = slurp(folder / "aligned/alignment.json");
  EXPECT_NE(alignment.find("\"global\": \"no overlap\""), std::string::npos) << alignment;
  EXPECT_NE(alignment.find("no correspondences"), std::string::npos) << alignment;
}

// Two spheres fit in any rotation.
TEST(BadInput, AnAmbiguousTieIsSaidToBe) {
  const Folder folder;
  const std::string a = (folder / "a.ply").string(), b = (folder / "b.ply").string();
  spill(a, sphere_ply(2000, 0));
  spill(b, sphere_ply(1800, 100));
  const Outcome outcome = run_scan({"align", a, b, (folder / "aligned").string(), "--global"});
  EXPECT_NE(outcome.err.find("several poses"), std::string::npos) << outcome.err;
  EXPECT_NE(slurp(folder / "aligned/alignment.json").find("\"global\": \"ambiguous\""),
            std::string::npos);
}

TEST(BadInput, OutputThatCannotBeWrittenIsFoundBeforeTheWork) {
  const Folder folder;
  const std::string points = (folder / "points.ply").string();
  spill(points, sphere_ply(500, 0));
  expect_failure(run_scan({"reconstruct", points, (folder / "no/such/folder.ply").string()}),
                 output, "folder.ply");
  expect_failure(run_scan({"reconstruct", points, folder.path().string()}), output,
                 folder.path().string());
  expect_failure(run_scan({"convert", points, "/proc/points.xyz"}), output, "/proc/points.xyz");
  expect_failure(run_scan({"reconstruct", points, (folder / "s.xyz").string()}), output,
                 "format '.xyz' is not one of .ply .obj .stl .off");
  expect_failure(run_scan({"acquire", "stereo", "l.png", "r.png", (folder / "s.stl").string(),
                           "--calibration", "c.json"}),
                 output, "format '.stl' is not one of .ply .pcd .xyz .txt .asc");
  expect_failure(run_scan({"verify", points, "--truth", points, "--picture",
                           (folder / "no/such/folder.png").string()}),
                 output, "folder.png");
}

TEST(Usage, MistypedWordsGetAHint) {
  expect_failure(run_scan({"recontruct"}), usage, "reconstruct");
  expect_failure(run_scan({"reconstruct", "a.ply", "b.ply", "--deph", "8"}), usage, "--depth");
  expect_failure(run_scan({"reconstruct", "a.ply", "b.ply", "--trim", "2furlongs"}), usage,
                 "--trim");
  expect_failure(run_scan({"reconstruct", "a.ply", "b.ply", "--depth", "99"}), usage, "99");
  expect_failure(run_scan({"align", "a.ply", "b.ply", "--method", "magic"}), usage, "magic");
  expect_failure(run_scan({"align", "a.ply", "b.ply", "--method", "symetric"}), usage,
                 "did you mean 'symmetric'?");
  expect_failure(run_scan({"align", "a.ply", "b.ply", "--guess-rotation", "2mm"}), usage,
                 "'2mm' is not an angle, such as 2deg");
  expect_failure(run_scan({"align", "a.ply", "b.ply", "--guess-rotation", "181deg"}), usage,
                 "half a turn");
  expect_failure(run_scan({"align", "a.ply", "b.ply", "out", "--global", "--init", "p.txt"}), usage,
                 "--init");
  expect_failure(run_scan({}), usage, "scan --help");
}

TEST(Usage, HelpAndVersionSucceed) {
  for (const char* command : {"run", "simulate", "acquire", "align", "reconstruct", "verify",
                              "report", "info", "convert", "version"}) {
    const Outcome outcome = run_scan({command, "--help"});
    EXPECT_EQ(outcome.exit_code, 0) << command;
    EXPECT_NE(outcome.out.find("Example:\n  scan " + std::string(command)), std::string::npos)
        << outcome.out;
  }
  EXPECT_EQ(run_scan({"--help"}).exit_code, 0);
  EXPECT_EQ(run_scan({"--version"}).out.rfind("scan ", 0), 0u);
}

}  // namespace
}  // namespace scan::test
