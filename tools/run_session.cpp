// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/run_session.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/json_reader.h"
#include "tools/left_out.h"
#include "tools/report_stage.h"
#include "tools/run_files.h"
#include "tools/run_stages.h"
#include "tools/verdict_text.h"
#include "tools/version.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// What each stage leaves behind, as files or folders. The timings belong to none: they alone may
// differ between equal runs.
const std::map<std::string, std::vector<std::string>> stage_outputs = {
    {"simulate", {"effects.json", "simulation", "simulation.json", "scans", "truth", "raw"}},
    {"align", {"alignment.json", "pose_trace.json", "poses.tum"}},
    {"reconstruct", {"surface.ply", "reconstruction.json"}},
    {"verify", {"verdict.json"}}};

// The run in a folder is of this recipe, or not, or nobody can tell.
void check_same_recipe(const fs::path& run, const std::string& recipe) {
  const fs::path path = recipe_path(run);
  if (!fs::exists(path) || read_file(path) == recipe) return;
  try {
    (void)read_json(path);
  } catch (const Error& error) {
    throw Error(error.trouble(), error.what(),
                "nobody can tell whose run it is; --force replaces it");
  }
  throw Error(Trouble::input, run.string() + ": holds a run of another recipe",
              "--force replaces it");
}

RunFolder open_folder(const fs::path& run, const RunSettings& settings, const std::string& recipe) {
  const bool joins = !settings.force && (settings.resume || !settings.shard.empty());
  if (joins) check_same_recipe(run, recipe);
  return open_run_folder(run, settings.force ? RunStart::force
                              : joins        ? RunStart::resume
                                             : RunStart::fresh);
}

// The files of a stage that are there, relative to the folder.
std::vector<std::string> output_files(const fs::path& run, const std::string& stage) {
  std::vector<std::string> files;
  for (const std::string& output : stage_outputs.at(stage)) {
    if (fs::is_regular_file(run / output)) files.push_back(output);
    if (!fs::is_directory(run / output)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(run / output))
      if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), run).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

ordered_json read_or_empty(const fs::path& path) {
  return fs::exists(path) ? read_ordered_json(path) : ordered_json::object();
}

synth::EffectChoice effect_choice(const std::string& word) {
  using Kind = synth::EffectChoice::Kind;
  if (word == "auto") return {Kind::automatic, {}};
  if (word == "all") return {Kind::all, {}};
  if (word == "none") return {Kind::none, {}};
  synth::EffectChoice choice{Kind::named, {}};
  std::istringstream list(word);
  for (std::string name; std::getline(list, name, ',');) choice.names.push_back(name);
  return choice;
}

Recipe adjusted(Recipe recipe, const RunSettings& settings) {
  if (settings.seed >= 0) recipe.seed = static_cast<std::uint64_t>(settings.seed);
  if (!settings.effects.empty()) {
    recipe.effects = effect_choice(settings.effects);
    check(recipe.effects);
  }
  return recipe;
}

// No stage needs the seconds of those before it: where they cannot be read, they begin anew.
void drop_broken_timings(const fs::path& run, Console& console) {
  try {
    (void)read_or_empty(run / "timings.json");
  } catch (const Error& error) {
    console.warn(std::string(error.what()) + "; dropped, what earlier stages cost is unknown");
    fs::remove(run / "timings.json");
  }
}

double rays_of(const ordered_json& scans) {
  double rays = 0;
  for (const auto& scan : scans) rays += scan.at("rays").get<double>();
  return rays;
}

}  // namespace

void declare_run_settings(CommandLine& line, RunSettings& settings) {
  line.flag("--keep-raw", settings.keep_raw, "keep the raw frames in RUN/raw");
  line.flag("--resume", settings.resume, "continue an earlier run of the same recipe in RUN");
  line.flag("--force", settings.force, "replace an earlier run in RUN");
  line.option("--effects", settings.effects,
              "auto, all, none, or a list such as shot-noise,interreflection");
  line.whole("--seed", settings.seed, 0, 1L << 62, "another seed than the recipe's");
}

RunSession::RunSession(const fs::path& recipe, const fs::path& run, const RunSettings& settings,
                       Console& console)
    : run_(run),
      recipe_(adjusted(read_recipe(recipe), settings)),
      console_(console),
      settings_(settings) {
  const std::string as_run = json_text(to_json(recipe_));
  folder_ = open_folder(run_, settings, as_run);
  drop_broken_timings(run_, console_);
  write_file(recipe_path(run_), as_run);
  inputs_ = fingerprint(as_run + version_text() + (settings.keep_raw ? " raw" : ""));
}

void RunSession::stage(const std::string& name, const Work& work) {
  (void)part_of_stage(name, [&] {
    work(run_, recipe_);
    return true;
  });
}

bool RunSession::simulate() {
  const Shard shard = settings_.shard.empty() ? Shard() : parse_shard(settings_.shard);
  return part_of_stage("simulate", [&] {
    return simulate_run(run_, recipe_, {settings_.keep_raw, shard, inputs_}, console_);
  });
}

bool RunSession::part_of_stage(const std::string& name, const std::function<bool()>& work) {
  if (is_done(folder_, name, inputs_)) {
    console_.log(name + ": already done");
    return true;
  }
  a_stage_ran_ = true;
  const Stopwatch watch;
  const bool whole = work();
  const double seconds = watch.seconds();
  char text[64];
  std::snprintf(text, sizeof text, "%s: %.1f s", name.c_str(), seconds);
  console_.log(text);
  if (!whole) return false;
  if (!console_.seconds().contains(name)) console_.time(name, seconds);
  ordered_json timings = read_or_empty(run_ / "timings.json");
  for (const auto& [step, value] : console_.seconds()) timings[step] = value;
  timings["machine"] = machine_text();
  timings["threads"] = thread_count();
  write_json(run_ / "timings.json", timings);
  record_stage(folder_, name, inputs_, output_files(run_, name));
  return true;
}

void RunSession::report() {
  const fs::path page = run_ / "report.html";
  if (!a_stage_ran_ && fs::exists(page)) return;
  write_report(run_, page);
}

int RunSession::finish(const std::string& command) {
  return finish(command, ordered_json::object(), true);
}

int RunSession::finish(const std::string& command, const ordered_json& more, bool pass) {
  ordered_json result = {{"run", run_.string()}, {"seed", recipe_.seed}};
  result["scans"] = ordered_json::array();
  const auto scans = read_run_scans(run_);
  for (std::size_t i = 0; i < scans.size(); ++i)
    result["scans"].push_back(scan_json("scans/" + scan_name(i) + ".ply", scans[i]));
  result["effects"] = read_or_empty(run_ / "effects.json");
  const ordered_json timings = read_or_empty(run_ / "timings.json");
  const ordered_json costs = timings.value("effects", ordered_json::object());
  for (auto& effect : result["effects"])
    effect["cost_s"] = costs.value(effect.value("effect", ""), ordered_json());
  const ordered_json simulation = read_or_empty(run_ / "simulation.json");
  for (const auto& [key, value] : simulation.items()) result[key] = value;
  if (const double seconds = timings.value("simulate", 0.0); seconds > 0)
    result["rays_per_second"] = rays_of(result["scans"]) / seconds;
  for (const auto& [key, value] : more.items()) result[key] = value;
  if (fs::exists(run_ / "verdict.json")) {
    ordered_json verdict = read_or_empty(run_ / "verdict.json");
    tell_left_out(run_, verdict, console_);
    for (const auto& [key, value] : verdict.items()) result[key] = value;
    pass = pass && verdict.value("pass", false);
    say_verdict(verdict, console_);
  }
  console_.say(run_.string() + ": " + std::to_string(scans.size()) + " scans" +
               (fs::exists(run_ / "report.html") ? "; look at report.html" : ""));
  console_.finish(command, pass ? "ok" : "failed", result);
  return pass ? 0 : 1;
}

}  // namespace scan
