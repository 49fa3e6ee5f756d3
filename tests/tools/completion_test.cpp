// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the shells are told to complete is what the program takes.
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

// What bash offers behind these words, the last of which is being typed.
std::string offered(const std::string& words) {
  const Folder folder;
  spill(folder / "script", run_scan({"completion", "bash"}).out);
  const std::string command =
      "source " + (folder / "script").string() + "; COMP_WORDS=(" + words +
      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _scan; echo \"${COMPREPLY[*]}\"";
  EXPECT_EQ(std::system(("bash -c " + quoted(command) + " >" + (folder / "out").string()).c_str()),
            0);
  std::string text = slurp(folder / "out");
  if (!text.empty()) text.pop_back();  // the line's end
  return text;
}

std::set<std::string> long_options(const std::string& text) {
  const std::regex option("--[a-z][a-z-]*");
  return {std::sregex_token_iterator(text.begin(), text.end(), option),
          std::sregex_token_iterator()};
}

TEST(Completion, OffersCommandsOptionsAndTheirWords) {
  EXPECT_EQ(offered("scan re"), "reconstruct report");
  EXPECT_EQ(offered("scan align --m"), "--method --max-distance");
  EXPECT_EQ(offered("scan reconstruct --method s"), "ssd scale-space");
  EXPECT_EQ(offered("scan acquire st"), "stereo");
  EXPECT_EQ(offered("scan calibrate l"), "light-plane");
  EXPECT_EQ(offered("scan info ''"), "");  // files, which are the shell's affair
}

// The help is made by the parser itself, so it is what the program takes.
TEST(Completion, HasTheOptionsOfEachCommandsHelp) {
  for (const char* command :
       {"run", "simulate", "calibrate", "acquire", "align", "reconstruct", "verify", "tradeoff",
        "report", "info", "convert", "schema", "version"}) {
    std::string help = run_scan({command, "--help"}).out;
    help = help.substr(0, help.find("Example:"));
    EXPECT_EQ(long_options(offered(std::string("scan ") + command + " --")), long_options(help))
        << command;
  }
}

TEST(Completion, OfFishNamesEveryCommandAndEveryOption) {
  const std::string script = run_scan({"completion", "fish"}).out;
  for (const char* line :
       {"-a align -d", "__fish_seen_subcommand_from align' -l global -d",
        "__fish_seen_subcommand_from tradeoff' -l search -r -f -a 'grid adaptive'"})
    EXPECT_NE(script.find(line), std::string::npos) << line;
}

}  // namespace
}  // namespace scan::test
