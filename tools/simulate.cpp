// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan simulate: raw frames, scans and truth of a recipe.
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "tools/commands.h"
#include "tools/effect_check.h"
#include "tools/run_session.h"
#include "tools/run_stages.h"

namespace scan {
namespace {

void check_shard(const RunSettings& settings, bool check_plan) {
  if (settings.shard.empty()) return;
  (void)parse_shard(settings.shard);
  if (settings.force)
    throw Error(Trouble::usage, "--shard cannot stand with --force, which would clear other parts");
  if (check_plan)
    throw Error(Trouble::usage, "--shard cannot stand with --check, which needs no scans");
}

}  // namespace

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
  line.option(
      "--shard", arguments->settings.shard,
      "make only part 2 of 4 (2/4) of the scans; the parts share RUN, the last one ends it");
  line.flag("--check", arguments->check,
            "switch on what the plan left out, on a part of the rays, and hold it to its bounds");
  return [arguments](Console& console) {
    check_shard(arguments->settings, arguments->check);
    RunSession session(arguments->recipe, arguments->run, arguments->settings, console);
    if (!session.simulate()) {
      console.say(arguments->run + ": scans of other shards are still to come");
      console.finish("simulate", "ok", {{"run", arguments->run}, {"whole", false}});
      return 0;
    }
    if (!arguments->check) return session.finish("simulate");
    const auto comparisons = check_plan(session.recipe());
    say(comparisons, console);
    return session.finish("simulate", {{"check", to_json(comparisons)}}, all_pass(comparisons));
  };
}

}  // namespace scan
