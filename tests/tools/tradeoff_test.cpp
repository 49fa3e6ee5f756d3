// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// `scan tradeoff` as a user runs it: advice, files, a second call, and slips in its recipe.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

constexpr int failed = 1, usage = 2, input = 3, computation = 4, output = 5;

// Six small phase scans of a lump; only the surface's depth is varied.
std::string recipe(const std::string& vary) {
  return R"({"libscan": 1, "name": "lump", "seed": 5,
    "scene": {"objects": [{"name": "lump", "material": "clay", "shape": {"unite": {"blend_mm": 40,
        "parts": [{"shape": {"sphere": {"radius_mm": 150}}},
                  {"shape": {"box": {"size_mm": [180, 120, 150], "rounding_mm": 20}},
                   "position_mm": [120, 40, -60]}]}}}],
      "materials": {"clay": {"diffuse": 0.8}}},
    "scanner": {"phase_camera": {"camera": {"width_px": 80, "height_px": 60, "focal_px": 90},
      "frequencies_mhz": [60, 100], "electrons_at_1m": 60000, "contrast": 0.6,
      "sensor": {"gain_e_per_dn": 2, "read_noise_e": 20, "full_well_e": 120000, "bits": 16},
      "max_range_m": 7}},
    "viewpoints": {"dome": {"count": 6, "radius_mm": 900, "lowest_deg": -60,
      "pose_noise": {"rotation_deg": 0.2, "translation_mm": 1}}},
    "effects": ["shot-noise"], "verify": {"samples": 2000}, "tradeoff": )" +
         vary + "}";
}

Outcome tradeoff(const Folder& folder, const std::string& vary,
                 const std::vector<std::string>& more = {}) {
  spill(folder / "lump.json", recipe(vary));
  std::vector<std::string> arguments{"tradeoff", (folder / "lump.json").string(),
                                     (folder / "out").string(), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_scan(arguments);
}

const std::string depths =
    R"({"vary": [{"key": "reconstruct/depth", "values": [3, 5]}], "seeds": 2})";

TEST(Tradeoff, AdvisesTheCheapestSettingsWithinTheTolerance) {
  const Folder folder;
  const Outcome outcome = tradeoff(folder, depths, {"--tolerance", "1m"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json.at("runs").size(), 2u);
  const auto& coarse = json.at("runs")[0];
  const auto& fine = json.at("runs")[1];
  EXPECT_LT(fine.at("error_m"), coarse.at("error_m"));
  EXPECT_TRUE(json.at("advice").at("meets"));
  double shares = 0;
  for (const auto& source : json.at("cases")[0].at("sources"))
    shares += source.at("share").get<double>();
  EXPECT_GE(shares, 1 - 1e-9);  // more if a source that is spared makes the error larger
  EXPECT_TRUE(std::filesystem::exists(folder / "out/tradeoff.html"));
  EXPECT_NE(slurp(folder / "out/tradeoff.html").find("<svg"), std::string::npos);
  // runs of one seed share what their settings share: the same points, to the byte
  EXPECT_EQ(slurp(folder / "out/runs/0-seed0/scans/003.ply"),
            slurp(folder / "out/runs/1-seed0/scans/003.ply"));

  EXPECT_EQ(tradeoff(folder, depths).exit_code, output);
  const Outcome again = tradeoff(folder, depths, {"--tolerance", "1um", "--resume"});
  EXPECT_EQ(again.exit_code, failed) << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out).at("runs")[1].at("error_m"), fine.at("error_m"));
}

// The case decides what is advised: clean scans are best at the fine depth, and the few photons of
// the dark case leave errors that are mostly noise.
TEST(Tradeoff, AdvisesEachCaseForItself) {
  const Folder folder;
  const Outcome outcome = tradeoff(folder, R"({
      "vary": [{"key": "reconstruct/depth", "values": [3, 5]}, {"key": "threads", "values": [1]}],
      "cases": [{"name": "clean", "set": {"effects": "none"}},
                {"name": "dark", "set": {"scanner/phase_camera/electrons_at_1m": 1500}}],
      "seeds": 1, "seconds": "reconstruct"})");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json.at("runs").size(), 4u);
  ASSERT_EQ(json.at("cases").size(), 2u);
  EXPECT_EQ(json.at("cases")[0].at("advice").at("settings").at("reconstruct/depth"), 5);
  EXPECT_EQ(json.at("runs")[0].at("seconds"),
            json.at("runs")[0].at("stages").at("reconstruct").at("seconds"));
  EXPECT_GT(json.at("runs")[0].at("stages").at("align").at("peak_mib"), 10);
  const auto share = [&](std::size_t in, const std::string& name) {
    for (const auto& source : json.at("cases")[in].at("sources"))
      if (source.at("source") == name) return source.at("share").get<double>();
    return -1.0;
  };
  EXPECT_EQ(share(0, "noise"), -1);  // nothing to spare: the same run, so no source
  EXPECT_EQ(share(0, "miscalibration"), -1);
  EXPECT_GT(share(0, "reconstruction and sampling"), 0.1);  // cells of an eighth of the box
  EXPECT_GT(share(1, "noise"), 0.1);  // 1,500 electrons leave 8 mm of noise in a reading
  const std::string csv = slurp(folder / "out/tradeoff.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(csv.find("dark,5,1,"), std::string::npos) << csv;
  const std::string svg = slurp(folder / "out/tradeoff.svg");
  EXPECT_EQ(svg.rfind("<svg class='plot' xmlns='http://www.w3.org/2000/svg'", 0), 0u);
  EXPECT_NE(svg.find(">clean<"), std::string::npos);
  EXPECT_NE(svg.find(">dark<"), std::string::npos);
}

// True poses leave nothing of a pose's error and change nothing of a range's: neither can name the
// sources behind them. The runs have shot noise alone.
TEST(Tradeoff, NamesOnlySourcesThatAFigureCanHave) {
  const Folder folder;
  const auto sources = [&](const std::string& figure) {
    const Outcome outcome = tradeoff(
        folder,
        R"({"vary": [{"key": "reconstruct/depth", "values": [3]}], "seeds": 1, "error": ")" +
            figure + "\"}",
        {"--force"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    std::string names;
    for (const auto& source : json.at("cases")[0].at("sources"))
      names += source.at("source").get<std::string>() + ";";
    return names;
  };
  EXPECT_EQ(sources("pose_error_rms_mean"), "noise;registration;");
  EXPECT_EQ(sources("range_error_rms"), "noise;decoding;");
}

std::string study_of(const std::string& figure) {
  return R"({"vary": [{"key": "reconstruct/depth", "values": [3]}], "seeds": 1, "error": ")" +
         figure + "\"}";
}

// A tolerance has the unit of the study's figure; of another one it is refused before a run.
TEST(Tradeoff, TakesItsToleranceInTheFiguresUnit) {
  const Folder folder;
  const struct {
    const char *figure, *tolerance;
    double value;  // below 0: refused
  } cases[] = {{"rotation_error_mean", "3deg", 0.0523598775598298873},
               {"rotation_error_mean", "0.3mm", -1},
               {"unsupported_area", "0.5", 0.5},
               {"unsupported_area", "3mm", -1},
               {"accuracy_mean", "3deg", -1},
               {"accuracy_mean", "0mm", -1}};
  for (const auto& one : cases) {
    SCOPED_TRACE(std::string(one.figure) + " " + one.tolerance);
    std::filesystem::remove_all(folder / "out");
    const Outcome outcome = tradeoff(folder, study_of(one.figure), {"--tolerance", one.tolerance});
    if (one.value < 0) {
      EXPECT_EQ(outcome.exit_code, usage);
      EXPECT_NE(outcome.err.find("--tolerance"), std::string::npos) << outcome.err;
      EXPECT_FALSE(std::filesystem::exists(folder / "out"));
      continue;
    }
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_DOUBLE_EQ(json.at("tolerance"), one.value);
    EXPECT_TRUE(json.at("advice").at("meets"));
  }
}

// Figures that are best when large, or at 1, would be made worst; of a bias its size counts.
TEST(Tradeoff, WantsAFigureThatIsAnError) {
  const Folder folder;
  for (const char* figure : {"f_score", "ray_hit_fraction", "range_error_within_95",
                             "normalised_range_error_rms", "genus", "components"}) {
    const Outcome outcome = tradeoff(folder, study_of(figure));
    EXPECT_EQ(outcome.exit_code, input) << figure;
    EXPECT_NE(outcome.err.find("a study wants an error"), std::string::npos) << outcome.err;
  }
  const Outcome bias = tradeoff(folder, study_of("range_error_bias"));
  ASSERT_EQ(bias.exit_code, 0) << bias.err;
  const double kept = nlohmann::json::parse(bias.out).at("runs")[0].at("error_m");
  const auto verdict = nlohmann::json::parse(slurp(folder / "out/runs/0-seed0/verdict.json"));
  for (const auto& m : verdict.at("measurements"))
    if (m.at("name") == "range_error_bias") {
      EXPECT_DOUBLE_EQ(kept, std::abs(m.at("value").get<double>()));
    }
}

// Before the first run, and without leaving a folder that asks for --resume.
TEST(Tradeoff, NamesAMistakeInItsLastChoiceAtOnce) {
  const Folder folder;
  const Outcome outcome =
      tradeoff(folder, R"({"vary": [{"key": "reconstruct/depth", "values": [3, 5, 99]}]})");
  EXPECT_EQ(outcome.exit_code, input);
  EXPECT_NE(outcome.err.find("99"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("run 1"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out/runs"));
}

TEST(Tradeoff, NamesWhatIsWrongWithItsRecipe) {
  const Folder folder;
  const auto said = [&](const std::string& vary) {
    const Outcome outcome = tradeoff(folder, vary, {"--force"});
    EXPECT_EQ(outcome.exit_code, input) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(said(R"({"vary": [{"key": "reconstruct/deph", "values": [3]}]})").find("depth"),
            std::string::npos);
  EXPECT_NE(said(R"({"vary": [{"key": "reconstruct/depth", "values": [99]}]})").find("99"),
            std::string::npos);
  EXPECT_NE(said(R"({"vary": [{"key": "reconstruct/depth", "values": [3]}], "seeds": 1,
                     "error": "accuracy_rmz"})")
                .find("did you mean 'accuracy_rms'"),
            std::string::npos);
  EXPECT_NE(said(R"({"vary": [{"key": "threads", "values": [1, 100000]}]})").find("100000"),
            std::string::npos);
}

TEST(Tradeoff, WantsAFolderToWriteInto) {
  const Folder folder;
  spill(folder / "out", "a file");
  const Outcome outcome = tradeoff(folder, depths);
  EXPECT_EQ(outcome.exit_code, output) << outcome.err;
  EXPECT_NE(outcome.err.find("is a file, a folder is needed"), std::string::npos) << outcome.err;
}

// A scanner that sees nothing within its range: each run fails, and the first reason is given.
TEST(Tradeoff, OfRunsThatAllFailSaysWhy) {
  const Folder folder;
  const Outcome outcome = tradeoff(
      folder, R"({"vary": [{"key": "scanner/phase_camera/electrons_at_1m", "values": [1e-3]}],
                  "seeds": 1})");
  EXPECT_EQ(outcome.exit_code, computation) << outcome.err;
  EXPECT_NE(outcome.err.find("no ray gave a point"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace scan::test
