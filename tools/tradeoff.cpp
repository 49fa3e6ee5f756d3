// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan tradeoff: a recipe's settings varied, error against seconds, and what to choose.
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "libscan/verify/definitions.h"
#include "tools/commands.h"
#include "tools/report/tradeoff_page.h"
#include "tools/study_work.h"
#include "tools/tradeoff_json.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Arguments {
  std::string recipe, out;
  std::string search = "grid";
  std::string tolerance;
  bool resume = false, force = false;
};

void open_study(const Arguments& arguments) {
  const fs::path out = arguments.out;
  make_folder(out);
  if (fs::exists(out / "runs") && !arguments.resume && !arguments.force)
    throw Error(Trouble::output, arguments.out + ": holds an earlier study",
                "--resume goes on with it, --force replaces it");
  if (!arguments.force) return;
  fs::remove_all(out / "runs");
  for (const char* file : {"tradeoff.json", "tradeoff.csv", "tradeoff.svg", "tradeoff.html"})
    fs::remove(out / file);
}

// In the unit of the study's figure; 0 for no text.
double tolerance_of(const std::string& text, const std::string& figure) {
  const std::string option = "--tolerance";
  if (text.empty()) return 0;
  const std::string unit = figure_definition(figure).value().unit;
  double value = 0;
  try {
    value = unit == "m"     ? parse_length_m(text, option)
            : unit == "rad" ? parse_angle_rad(text, option)
                            : parse_number(text, option);
  } catch (const Error& error) {
    throw Error(Trouble::usage, error.what() + ("; this study's error is " + figure));
  }
  if (!(value > 0))
    throw Error(Trouble::usage, option + ": is " + text + ", no run is as good as that");
  return value;
}

CaseResult search_case(StudyWork& work, const Case& in, const Arguments& arguments,
                       double tolerance) {
  const std::size_t before = work.runs_done();
  const Measure measure = [&](const Setting& setting, int seeds) {
    return work.measure(in, setting, seeds);
  };
  CaseResult result{.name = in.name,
                    .points = arguments.search == "grid"
                                  ? search_grid(work.study(), measure)
                                  : search_adaptively(work.study(), tolerance, measure),
                    .chosen = {},
                    .sources = {},
                    .runs = work.runs_done() - before};
  result.chosen = advised(result.points, tolerance);
  if (result.chosen) result.sources = work.sources(in, result.points[*result.chosen].setting);
  return result;
}

int tradeoff(const Arguments& arguments, Console& console) {
  StudyWork work(arguments.recipe, arguments.out, console);
  const double tolerance = tolerance_of(arguments.tolerance, work.study().error);
  open_study(arguments);
  StudyResult result{.study = work.study(),
                     .cases = {},
                     .tolerance = tolerance,
                     .search = arguments.search,
                     .runs_of_grid = work.runs_of_grid() / work.study().cases.size()};
  for (const Case& in : work.study().cases)
    result.cases.push_back(search_case(work, in, arguments, tolerance));
  const ordered_json json = tradeoff_json(result);
  const fs::path out = arguments.out;
  write_json(out / "tradeoff.json", json);
  write_file(out / "tradeoff.csv", tradeoff_csv(json));
  write_file(out / "tradeoff.svg", tradeoff_picture(json));
  write_file(out / "tradeoff.html", tradeoff_page(work.name(), json));
  const std::string advice = json.at("advice").at("text").get<std::string>();
  console.say(advice);
  console.say((out / "tradeoff.html").string() + " shows the curve");
  bool is_any_chosen = false;
  for (const CaseResult& in : result.cases) is_any_chosen |= in.chosen.has_value();
  if (!is_any_chosen) throw Error(Trouble::computation, advice);
  const bool pass = meets_tolerance(result);
  console.finish("tradeoff", pass ? "ok" : "failed", json);
  return pass ? 0 : 1;
}

}  // namespace

Action tradeoff_command(CommandLine& line) {
  auto arguments = std::make_shared<Arguments>();
  line.input("RECIPE", arguments->recipe, "an experiment (JSON) with a \"tradeoff\"");
  line.input("OUT", arguments->out, "the folder to write into");
  line.option("--tolerance", arguments->tolerance,
              "advise the cheapest settings whose error is within this: 0.3mm, 0.1deg, or a bare "
              "number for shares and counts (of lengths metres, of angles radians)");
  line.choice("--search", arguments->search, {"grid", "adaptive"},
              "try every setting, or only those on the way to the advice");
  line.flag("--resume", arguments->resume, "go on with an earlier study in OUT");
  line.flag("--force", arguments->force, "replace an earlier study in OUT");
  return [arguments](Console& console) { return tradeoff(*arguments, console); };
}

}  // namespace scan
