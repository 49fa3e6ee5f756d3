// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A recipe with a slip in it is refused at once, with the place and a hint, and no run folder is
// made.
#include <gtest/gtest.h>

#include "tests/tools/small_run.h"

namespace scan::test {
namespace {

const char* const good_recipe = R"({
  "libscan": 1, "name": "small", "seed": 3,
  "scene": {
    "objects": [ { "shape": "bud", "material": "clay" },
                 { "shape": { "sphere": { "radius_mm": 25 } }, "position_mm": [60, 0, 0], "material": "clay" } ],
    "materials": { "clay": { "diffuse": 0.6 } } },
  "scanner": { "phase_camera": {
    "camera": { "width_px": 80, "height_px": 60, "focal_px": 160 },
    "frequencies_mhz": [80], "max_range_m": 1.5 } },
  "viewpoints": { "ring": { "count": 8, "radius_mm": 400 } },
  "reconstruct": { "method": "ssd", "depth": 4 } })";

struct Slip {
  std::string from, to, mentions;
};

// How GoogleTest names a case in its messages.
void PrintTo(const Slip& slip, std::ostream* out) {
  *out << slip.to;
}

class BadRecipe : public testing::TestWithParam<Slip> {};

TEST_P(BadRecipe, IsRefusedWithThePlace) {
  const Slip& slip = GetParam();
  std::string text = good_recipe;
  const auto place = text.find(slip.from);
  ASSERT_NE(place, std::string::npos) << slip.from;
  text.replace(place, slip.from.size(), slip.to);
  const Folder folder;
  spill(folder / "recipe.json", text);
  const Outcome outcome =
      run_scan({"run", (folder / "recipe.json").string(), (folder / "run").string()});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_EQ(outcome.err.rfind("error: ", 0), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find("recipe.json"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(slip.mentions), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

INSTANTIATE_TEST_SUITE_P(
    Slips, BadRecipe,
    testing::Values(
        Slip{"\"seed\"", "\"sede\"", "did you mean 'seed'"},
        Slip{"radius_mm\": 25", "radius_inch\": 1", "radius"},
        Slip{"radius_mm\": 25", "radius_mm\": -25", "must be positive"},
        Slip{"radius_mm\": 25", "radius_mm\": \"25\"", "must be a number"},
        Slip{"radius_mm\": 25", "radius_mm\": 25, \"radius_m\": 0.025", "two units"},
        Slip{"\"diffuse\": 0.6", "\"diffuse\": 1.6", "albedo"},
        Slip{"\"diffuse\": 0.6", "\"diffuse\": -0.1", "albedo"},
        Slip{"\"diffuse\": 0.6", "\"dielectric\": 0.9", "index"},
        Slip{"\"diffuse\": 0.6", "\"dielectric\": \"bk8\"", "did you mean 'bk7'"},
        Slip{"\"diffuse\": 0.6", "\"conductor\": \"iron\", \"roughness\": -1", "roughness"},
        Slip{"\"diffuse\": 0.6", "\"dielectric\": 1.4, \"interior\": { \"absorption_per_m\": -1 }",
             "absorption_per_m"},
        Slip{"\"diffuse\": 0.6",
             "\"diffuse\": 0.6, \"texture\": { \"picture\": { \"file\": \"no.png\", "
             "\"width_mm\": 5 } }",
             "no.png"},
        Slip{"\"diffuse\": 0.6",
             "\"diffuse\": 0.6, \"texture\": { \"picture\": { \"file\": \"" LIBSCAN_SOURCE_DIR
             "/docs/bracket-deviation.png\" } }",
             "a picture without a width"},
        Slip{"\"depth\": 4 }",
             "\"depth\": 4 }, \"limits\": [ { \"name\": \"accuracy_rms\", \"at_most_deg\": 1, "
             "\"reason\": \"\" } ]",
             "recipe.json/limits/0/at_most_deg: 'accuracy_rms' is a length: at_most_mm or such"},
        Slip{"\"depth\": 4 }",
             "\"depth\": 4 }, \"limits\": [ { \"name\": \"accuracy_rms\", \"at_most\": 1, "
             "\"reason\": \"\" } ]",
             "at_most: 'accuracy_rms' is a length: at_most_mm or such"},
        Slip{"\"depth\": 4 }",
             "\"depth\": 4 }, \"limits\": [ { \"name\": \"rotation_error\", \"at_most_mm\": 1, "
             "\"reason\": \"\" } ]",
             "at_most_mm: 'rotation_error' is an angle: at_most_deg or such"},
        Slip{"\"depth\": 4 }",
             "\"depth\": 4 }, \"limits\": [ { \"name\": \"genus\", \"equals_mm\": 1, "
             "\"reason\": \"\" } ]",
             "equals_mm: 'genus' is without a unit: equals"},
        Slip{"\"depth\": 4 }",
             "\"depth\": 4 }, \"limits\": [ { \"name\": \"probing_form\", \"at_most_mm\": 1, "
             "\"reason\": \"\" } ]",
             "'probing_form' is a figure of a data sheet (artefact_limits), not of a surface or a "
             "run"},
        Slip{"\"frequencies_mhz\": [80]", "\"frequencies_mhz\": [0]", "frequencies_hz"},
        Slip{"\"radius_mm\": 400", "\"radius_mm\": 60", "stands inside"},
        Slip{"{ \"sphere\": { \"radius_mm\": 25 } }", "\"brakcet\"", "did you mean 'bracket'"},
        Slip{"\"shape\": { \"sphere\": { \"radius_mm\": 25 } }",
             "\"mesh\": \"gone.stl\", \"unit\": \"mm\"", "gone.stl"},
        Slip{"\"material\": \"clay\"", "\"material\": \"caly\"", "did you mean 'clay'"},
        Slip{"phase_camera", "phase_camrea", "did you mean 'phase_camera'"},
        Slip{"\"width_px\": 80", "\"width_px\": 0", "width_px"},
        Slip{"\"width_px\": 80", "\"width_px\": 4.5", "whole number"},
        Slip{"\"count\": 8", "\"count\": 0", "count"},
        Slip{"\"depth\": 4", "\"depth\": 40", "depth"},
        Slip{"\"method\": \"ssd\"", "\"method\": \"sdd\"", "did you mean 'ssd'"},
        Slip{"\"libscan\": 1,",
             "\"libscan\": 1, \"limits\": [{ \"name\": \"acuracy_rms\", \"at_most_mm\": 1, "
             "\"reason\": \"why\" }],",
             "limits/0/name: 'acuracy_rms' is no figure of a verdict (did you mean 'accuracy_rms'"},
        Slip{"\"libscan\": 1", "\"libscan\": 2", "version 1"},
        Slip{"\"libscan\": 1,", "\"libscan\": 1", "not valid JSON"}));

// What a stage would refuse after minutes, or take for something else.
INSTANTIATE_TEST_SUITE_P(
    Settings, BadRecipe,
    testing::Values(
        Slip{"\"libscan\": 1,", "\"libscan\": 1, \"acquire\": { \"stereo\": { \"block_px\": 4 } },",
             "block_px: 4"},
        Slip{"\"libscan\": 1,",
             "\"libscan\": 1, \"acquire\": { \"stereo\": { \"disparity_sigma_px\": -1 } },",
             "disparity_sigma_px: -1"},
        Slip{"\"libscan\": 1,",
             "\"libscan\": 1, \"acquire\": { \"normals\": { \"neighbours\": 2 } },",
             "acquire/normals/neighbours is 2, must be 3 or more"},
        Slip{"\"libscan\": 1,",
             "\"libscan\": 1, \"acquire\": { \"laser_line\": { \"threshold_sigmas\": -1 } },",
             "laser_line/threshold_sigmas is -1"},
        Slip{"\"libscan\": 1,",
             "\"libscan\": 1, \"acquire\": { \"phase\": { \"min_amplitude_sigmas\": -1 } },",
             "min_amplitude_sigmas is -1"},
        Slip{"\"libscan\": 1,", "\"libscan\": 1, \"align\": { \"max_rounds\": 0 },",
             "max_rounds: 0"},
        Slip{"\"libscan\": 1,", "\"libscan\": 1, \"align\": { \"thin_mm\": -1 },",
             "thin_m: -0.001"},
        Slip{"\"libscan\": 1,", "\"libscan\": 1, \"verify\": { \"samples\": 0 },",
             "verify/samples is 0, must be 1 or more"},
        Slip{"\"libscan\": 1,", "\"libscan\": 1, \"verify\": { \"samples\": -5 },",
             "verify/samples is -5"},
        Slip{"\"libscan\": 1,", "\"libscan\": 1, \"verify\": { \"seen_distance_mm\": -1 },",
             "verify/seen_distance_m is -0.001"},
        Slip{"\"libscan\": 1,", "\"libscan\": 1, \"verify\": { \"f_score_threshold_mm\": -1 },",
             "f_score_threshold_m is -0.001"},
        Slip{"\"depth\": 4 }", "\"depth\": 4, \"thin_mm\": -1 }", "reconstruct/thin_m is -0.001"},
        Slip{"\"depth\": 4 }", "\"depth\": 4, \"trim_mm\": -1 }", "reconstruct/trim_m is -0.001"},
        Slip{"\"depth\": 4 }", "\"depth\": 4, \"decimate_mm\": -1 }",
             "reconstruct/decimate_m is -0.001"},
        Slip{"\"depth\": 4 }", "\"depth\": 4, \"max_sigma_mm\": -1 }",
             "reconstruct/max_sigma_m is -0.001"}));

TEST(GoodRecipe, RunsAndRefusesToOverwrite) {
  const Folder folder;
  spill(folder / "recipe.json", good_recipe);
  const std::string recipe = (folder / "recipe.json").string(), run = (folder / "run").string();
  const Outcome first = run_scan({"run", recipe, run});
  EXPECT_EQ(first.exit_code, 0) << first.err;
  const auto files = files_below(run);
  const Outcome second = run_scan({"run", recipe, run});
  EXPECT_EQ(second.exit_code, 5) << second.err;
  EXPECT_NE(second.err.find("--force"), std::string::npos) << second.err;
  EXPECT_EQ(files_below(run), files);
  EXPECT_EQ(run_scan({"run", recipe, run, "--resume"}).exit_code, 0);
  EXPECT_EQ(run_scan({"run", recipe, run, "--force"}).exit_code, 0);
}

// A run that was cut short goes on, or says which file it cannot go on from.
TEST(ResumedRun, MakesCutScansAnewAndNamesWhatIsBroken) {
  const Folder folder;
  std::filesystem::copy(small_run(), folder / "run", std::filesystem::copy_options::recursive);
  const std::string recipe = LIBSCAN_SOURCE_DIR "/tests/tools/small_run.json",
                    run = (folder / "run").string();
  const std::string scan = slurp(folder / "run/scans/003.ply");
  spill(folder / "run/scans/003.ply", scan.substr(0, scan.size() / 2));
  EXPECT_EQ(run_scan({"run", recipe, run, "--resume"}).exit_code, 0);
  EXPECT_EQ(slurp(folder / "run/scans/003.ply"), scan);
  spill(folder / "run/timings.json", "[1, 2");
  const std::string page = (folder / "page.html").string();
  const Outcome report = run_scan({"report", run, page});
  EXPECT_EQ(report.exit_code, 3) << report.err;
  EXPECT_NE(report.err.find("--resume goes on with it"), std::string::npos) << report.err;
  const Outcome timings = run_scan({"run", recipe, run, "--resume"});
  EXPECT_EQ(timings.exit_code, 0) << timings.err;
  EXPECT_NE(timings.err.find("run/timings.json: not valid JSON"), std::string::npos);
  const Outcome again = run_scan({"report", run, page});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(slurp(page).find("what it cost is unknown"), std::string::npos);

  const std::string as_run = slurp(folder / "run/recipe.json");
  spill(folder / "run/recipe.json", as_run.substr(0, as_run.size() / 2));
  const Outcome broken = run_scan({"run", recipe, run, "--resume"});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_NE(broken.err.find("run/recipe.json: not valid JSON near line"), std::string::npos)
      << broken.err;
  EXPECT_EQ(broken.err.find("another recipe"), std::string::npos) << broken.err;
  spill(folder / "run/recipe.json", "{}");
  EXPECT_NE(run_scan({"run", recipe, run, "--resume"}).err.find("another recipe"),
            std::string::npos);
}

}  // namespace
}  // namespace scan::test
