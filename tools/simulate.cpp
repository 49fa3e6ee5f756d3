// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan simulate: raw frames, scans and truth of a recipe.
#include <nlohmann/json.hpp>

#include "tools/commands.h"
#include "tools/effect_check.h"
#include "tools/run_session.h"
#include "tools/run_stages.h"

namespace scan {

Action simulate_command(CommandLine& line) {
  struct Arguments {
    std::string recipe, run;
    RunSettings settings;
    bool check = false;
  };
  auto arguments = std::make_shared<Arguments>();
  line.input("RECIPE", arguments->recipe, "the experiment (JSON)");
  line.input("RUN", arguments->run, "the folder to write into");
  declare_run_settings(line, arguments->settings);
  line.flag("--check", arguments->check,
            "switch on what the plan left out, on a part of the rays, and hold it to its bounds");
  return [arguments](Console& console) {
    RunSession session(arguments->recipe, arguments->run, arguments->settings, console);
    session.stage("simulate", [&](const auto& run, const Recipe& recipe) {
      simulate_run(run, recipe, {.keep_raw = arguments->settings.keep_raw}, console);
    });
    if (!arguments->check) return session.finish("simulate");
    const auto comparisons = check_plan(session.recipe());
    say(comparisons, console);
    return session.finish("simulate", {{"check", to_json(comparisons)}}, all_pass(comparisons));
  };
}

}  // namespace scan
