// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan run: all stages of a recipe.
#include <nlohmann/json.hpp>

#include "libscan/io/json_output.h"
#include "tools/commands.h"
#include "tools/run_session.h"
#include "tools/run_stages.h"

namespace scan {

Action run_command(CommandLine& line) {
  struct Arguments {
    std::string recipe, run;
    RunSettings settings;
  };
  auto arguments = std::make_shared<Arguments>();
  line.input("RECIPE", arguments->recipe, "the experiment (JSON)");
  line.input("RUN", arguments->run, "the folder to write into");
  declare_run_settings(line, arguments->settings);
  return [arguments](Console& console) {
    RunSession session(arguments->recipe, arguments->run, arguments->settings, console);
    (void)session.simulate();
    session.stage("align",
                  [&](const auto& run, const Recipe& recipe) { align_run(run, recipe, console); });
    session.stage("reconstruct", [&](const auto& run, const Recipe& recipe) {
      reconstruct_run(run, recipe, console);
    });
    session.stage("verify", [&](const auto& run, const Recipe&) { verify_run(run, console); });
    session.report();
    return session.finish("run");
  };
}

}  // namespace scan
