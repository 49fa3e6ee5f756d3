// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/run_session.h"

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_reader.h"
#include "tools/json_output.h"
#include "tools/run_files.h"
#include "tools/run_stages.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// What each stage leaves behind. timings.json belongs to none: it alone may differ between equal runs.
const std::map<std::string, std::vector<std::string>> stage_outputs = {
    {"simulate", {"effects.json", "scans", "truth", "raw"}},
    {"align", {"alignment.json", "poses.tum"}},
    {"reconstruct", {"surface.ply", "reconstruction.json"}},
    {"verify", {"verdict.json"}},
    {"report", {"report.html"}}};
const std::vector<std::string> own_files = {"recipe.json", "stages.json", "timings.json"};

bool holds_run(const fs::path& folder) {
  return fs::exists(folder / "recipe.json") && fs::exists(folder / "stages.json");
}

// Removes what a run wrote and nothing else.
void clear_run(const fs::path& folder) {
  std::error_code error;
  for (const auto& [stage, outputs] : stage_outputs)
    for (const std::string& output : outputs) fs::remove_all(folder / output, error);
  for (const std::string& file : own_files) fs::remove(folder / file, error);
}

void open_folder(const fs::path& run, const RunSettings& settings, const std::string& recipe) {
  std::error_code error;
  if (fs::exists(run) && !fs::is_directory(run))
    throw Error(Trouble::output, run.string() + ": is a file, a run needs a folder");
  const bool occupied = fs::is_directory(run) && !fs::is_empty(run, error);
  if (occupied && !holds_run(run))
    throw Error(Trouble::output, run.string() + ": is not empty and holds no run",
                "give a new or empty folder");
  if (occupied && settings.force) {
    clear_run(run);
  } else if (occupied && settings.resume) {
    if (read_file(run / "recipe.json") != recipe)
      throw Error(Trouble::input, run.string() + ": holds a run of another recipe",
                  "--force replaces it");
  } else if (occupied) {
    throw Error(Trouble::output, run.string() + ": holds an earlier run",
                "--resume continues it, --force replaces it");
  }
  fs::create_directories(run, error);
  if (error) throw Error(Trouble::output, run.string() + ": " + error.message());
}

// Fingerprint over names and bytes of a stage's outputs, in the order of their names.
std::string outputs_fingerprint(const fs::path& run, const std::string& stage) {
  std::map<std::string, fs::path> files;
  for (const std::string& output : stage_outputs.at(stage)) {
    const fs::path path = run / output;
    if (fs::is_regular_file(path)) files[output] = path;
    if (!fs::is_directory(path)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(path))
      if (entry.is_regular_file()) files[fs::relative(entry.path(), run).string()] = entry.path();
  }
  std::string all;
  for (const auto& [name, path] : files) all += name + " " + fingerprint(read_file(path)) + "\n";
  return fingerprint(all);
}

ordered_json read_or_empty(const fs::path& path) {
  if (!fs::exists(path)) return ordered_json::object();
  return ordered_json::parse(read_file(path), nullptr, false);
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
    synth::plan_effects(recipe.scanner, recipe.effects);  // refuses unknown names
  }
  return recipe;
}

}  // namespace

void declare_run_settings(CommandLine& line, RunSettings& settings) {
  line.flag("--keep-raw", settings.keep_raw, "keep the raw frames in RUN/raw");
  line.flag("--resume", settings.resume, "continue an earlier run of the same recipe in RUN");
  line.flag("--force", settings.force, "replace an earlier run in RUN");
  line.option("--effects", settings.effects,
              "auto, all, none, or a list (shot noise,read noise,quantisation)");
  line.whole("--seed", settings.seed, 0, 1L << 62, "another seed than the recipe's");
}

RunSession::RunSession(const fs::path& recipe, const fs::path& run, const RunSettings& settings,
                       Console& console)
    : run_(run), recipe_(adjusted(read_recipe(recipe), settings)), console_(console) {
  const std::string as_run = json_text(to_json(recipe_));
  open_folder(run_, settings, as_run);
  write_file(recipe_path(run_), as_run);
  if (!fs::exists(run_ / "stages.json")) write_json(run_ / "stages.json", ordered_json::object());
}

void RunSession::stage(const std::string& name, const Work& work) {
  ordered_json stages = read_or_empty(run_ / "stages.json");
  const bool done = all_done_so_far_ && stages.value(name, "") == outputs_fingerprint(run_, name);
  if (done) return console_.log(name + ": already done");
  all_done_so_far_ = false;
  const Stopwatch watch;
  work(run_, recipe_);
  const double seconds = watch.seconds();
  char text[64];
  std::snprintf(text, sizeof text, "%s: %.1f s", name.c_str(), seconds);
  console_.log(text);
  if (!console_.seconds().contains(name)) console_.time(name, seconds);
  ordered_json timings = read_or_empty(run_ / "timings.json");
  for (const auto& [step, value] : console_.seconds()) timings[step] = value;
  write_json(run_ / "timings.json", timings);
  stages[name] = outputs_fingerprint(run_, name);
  write_json(run_ / "stages.json", stages);
}

int RunSession::finish(const std::string& command) {
  ordered_json result = {{"run", run_.string()}, {"seed", recipe_.seed}};
  result["scans"] = ordered_json::array();
  const auto scans = read_run_scans(run_);
  for (std::size_t i = 0; i < scans.size(); ++i)
    result["scans"].push_back(scan_json("scans/" + scan_name(i) + ".ply", scans[i]));
  result["effects"] = read_or_empty(run_ / "effects.json");
  bool pass = true;
  if (fs::exists(run_ / "verdict.json")) {
    const ordered_json verdict = read_or_empty(run_ / "verdict.json");
    for (const auto& [key, value] : verdict.items()) result[key] = value;
    pass = verdict.value("pass", false);
    say_verdict(verdict, console_);
  }
  console_.say(run_.string() + ": " + std::to_string(scans.size()) + " scans" +
               (fs::exists(run_ / "report.html") ? "; look at report.html" : ""));
  console_.finish(command, pass ? "ok" : "failed", result);
  return pass ? 0 : 1;
}

}  // namespace scan
