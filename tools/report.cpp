// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan report: a run as one page.
#include <nlohmann/json.hpp>

#include "libscan/io/atomic_file.h"
#include "tools/commands.h"
#include "tools/inputs.h"
#include "tools/run_stages.h"

namespace scan {

Action report_command(CommandLine& line) {
  struct Arguments {
    std::string run, output;
  };
  auto arguments = std::make_shared<Arguments>();
  line.input("RUN", arguments->run, "a run folder");
  line.input("OUT.html", arguments->output, "the page to write");
  return [arguments](Console& console) {
    check_output(arguments->output);
    const Stopwatch watch;
    write_file(arguments->output, report_run(arguments->run));
    console.time("report", watch.seconds());
    console.say(arguments->output + ": written");
    console.finish("report", "ok", {{"file", arguments->output}});
    return 0;
  };
}

}  // namespace scan
