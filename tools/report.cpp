// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan report: a run as one page, and the same numbers for machines.
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "tools/commands.h"
#include "tools/inputs.h"
#include "tools/report_stage.h"

namespace scan {

Action report_command(CommandLine& line) {
  struct Arguments {
    std::string run, output, artefacts, tradeoff;
  };
  auto arguments = std::make_shared<Arguments>();
  line.input("RUN", arguments->run, "a run folder");
  line.input("OUT.html", arguments->output, "the page to write; OUT.json and OUT.csv beside it");
  line.option("--artefacts", arguments->artefacts,
              "what `scan verify --artefacts RECIPE --json` printed; else RUN/artefacts.json");
  line.option("--tradeoff", arguments->tradeoff,
              "the tradeoff.json of a study; else RUN/tradeoff.json");
  return [arguments](Console& console) {
    const std::filesystem::path page = arguments->output;
    if (page.extension() == ".json" || page.extension() == ".csv")
      throw Error(Trouble::usage, arguments->output + ": is the name of the page, which is HTML");
    check_output(arguments->output);
    const Stopwatch watch;
    write_report(arguments->run, page, arguments->artefacts, arguments->tradeoff);
    console.time("report", watch.seconds());
    console.say(arguments->output + ": written, its numbers as .json and .csv beside it");
    console.finish("report", "ok", {{"file", arguments->output}});
    return 0;
  };
}

}  // namespace scan
