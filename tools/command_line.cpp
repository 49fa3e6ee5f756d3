// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "libscan/core/parallel.h"
#include "libscan/io/json_reader.h"
#include "tools/version.h"

namespace scan {
namespace {

struct QuantityTarget {
  std::string name;
  std::shared_ptr<std::string> text;
  double* value;
  double (*parse)(const std::string& text, const std::string& option);
};

// A word of a list; a slip is answered with the list and the nearest word.
CLI::Validator one_of(std::vector<std::string> choices) {
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ",") + choice;
  const auto check = [choices = std::move(choices), list](std::string& word) -> std::string {
    if (std::find(choices.begin(), choices.end(), word) != choices.end()) return {};
    const std::string near = nearest_word(word, choices);
    return "'" + word + "' is none of " + list +
           (near.empty() ? "" : "; did you mean '" + near + "'?");
  };
  return CLI::Validator(check, "{" + list + "}");
}

class CliCommandLine : public CommandLine {
 public:
  explicit CliCommandLine(CLI::App& app) : app_(app) {}

  void input(std::string name, std::string& value, std::string help) override {
    app_.add_option(name, value, help)->required();
  }
  void inputs(std::string name, std::vector<std::string>& values, std::string help) override {
    app_.add_option(name, values, help)->required();
  }
  void option(std::string name, std::string& value, std::string help) override {
    app_.add_option(name, value, help)->capture_default_str();
  }
  void choice(std::string name, std::string& value, std::vector<std::string> choices,
              std::string help) override {
    const bool is_required = !name.starts_with("-") && value.empty();
    app_.add_option(name, value, help)
        ->check(one_of(std::move(choices)))
        ->capture_default_str()
        ->required(is_required);
  }
  void whole(std::string name, long& value, long least, long most, std::string help) override {
    CLI::Option* option = app_.add_option(name, value, help)->check(CLI::Range(least, most));
    if (least <= value && value <= most) option->capture_default_str();  // outside: none is given
  }
  void number(std::string name, double& value, double least, double most,
              std::string help) override {
    app_.add_option(name, value, help)->check(CLI::Range(least, most))->capture_default_str();
  }
  void length(std::string name, double& value_m, std::string help) override {
    quantity(name, value_m, help + " (2mm, 0.1m; a bare number is metres)", parse_length_m);
  }
  void angle(std::string name, double& value_rad, std::string help) override {
    quantity(name, value_rad, help + " (2deg, 35mrad; a bare number is radians)", parse_angle_rad);
  }
  void flag(std::string name, bool& value, std::string help) override {
    app_.add_flag(name, value, help);
  }

  void resolve_quantities() const {
    for (const QuantityTarget& target : quantities_)
      if (!target.text->empty()) *target.value = target.parse(*target.text, target.name);
  }

 private:
  void quantity(const std::string& name, double& value, const std::string& help,
                double (*parse)(const std::string&, const std::string&)) {
    auto text = std::make_shared<std::string>();
    app_.add_option(name, *text, help);
    quantities_.push_back({name, text, &value, parse});
  }

  CLI::App& app_;
  std::vector<QuantityTarget> quantities_;
};

struct Declared {
  const Command* command;
  CLI::App* app;
  std::shared_ptr<CliCommandLine> line;
  Action action;
};

int report_error(const Console& console, const std::string& command, const Error& error) {
  const int code = static_cast<int>(error.trouble());
  const std::string hint = error.hint().empty() ? "" : " (" + error.hint() + ")";
  std::fprintf(stderr, "error: %s%s\n", error.what(), hint.c_str());
  nlohmann::ordered_json details = {{"code", code}, {"message", error.what()}};
  if (!error.hint().empty()) details["hint"] = error.hint();
  console.finish(command, "error", {{"error", details}});
  return code;
}

// A number, not negative, and one of the units directly behind it.
std::optional<double> quantity_of(const std::string& text,
                                  const std::map<std::string, double>& units) {
  std::size_t end = 0;
  double value = 0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  const auto unit = units.find(text.substr(end));
  if (unit == units.end() || !std::isfinite(value) || value < 0) return std::nullopt;
  return value * unit->second;
}

std::string unknown_word_hint(const CLI::App& app, int argc, char** argv,
                              const std::vector<Command>& commands) {
  std::vector<std::string> words;
  words.reserve(commands.size());
  for (const Command& command : commands) words.push_back(command.name);
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
    const std::string near = nearest_word(argv[1], words);
    return near.empty() ? "run 'scan --help' for the list of commands"
                        : "did you mean 'scan " + near + "'?";
  }
  std::vector<std::string> options;
  for (const CLI::App* command : app.get_subcommands()) {
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    for (int i = 2; i < argc; ++i) {
      const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
      if (word.rfind("--", 0) != 0) continue;
      if (std::find(options.begin(), options.end(), word) != options.end()) continue;
      if (const std::string near = nearest_word(word, options); !near.empty())
        return "did you mean '" + near + "'?";
    }
    return "run 'scan " + command->get_name() + " --help'";
  }
  return "run 'scan --help'";
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error, int argc,
                          char** argv) {
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty())
    return "unknown command '" + std::string(argv[1]) + "'";
  std::string message = error.what();
  for (char& c : message)
    if (c == '\n') c = ' ';
  return message;
}

int run_action(const Declared& declared, Console& console) {
  const std::string& name = declared.command->name;
  try {
    declared.line->resolve_quantities();
    const ThreadLimit limit(static_cast<int>(console.threads));
    return declared.action(console);
  } catch (const Error& error) {
    return report_error(console, name, error);
  } catch (const Interrupted&) {
    std::fprintf(stderr, "error: interrupted\n");
    return 130;
  } catch (const std::bad_alloc&) {
    return report_error(console, name, Error(Trouble::resource, "out of memory"));
  } catch (const std::exception& error) {
    return report_error(console, name, Error(Trouble::computation, error.what()));
  }
}

// `scan help align` is `scan align --help`.
int run_help(int argc, char** argv, const std::vector<Command>& commands) {
  std::string help = "--help";
  std::vector<char*> words = {argv[0]};
  if (argc > 2) words.push_back(argv[2]);
  words.push_back(help.data());
  return run_program(static_cast<int>(words.size()), words.data(), commands);
}

}  // namespace

void declare_shared_options(CommandLine& line, Console& console) {
  line.flag("--json", console.json, "print one JSON object on stdout");
  line.flag("-q,--quiet", console.quiet, "no log on stderr");
  line.flag("-v,--verbose", console.verbose, "more log on stderr");
  line.whole("--threads", console.threads, 0, 4096, "threads to use (0: all cores)");
}

double parse_length_m(const std::string& text, const std::string& option) {
  static const std::map<std::string, double> units = {{"", 1},      {"m", 1},     {"mm", 1e-3},
                                                      {"um", 1e-6}, {"cm", 1e-2}, {"km", 1e3}};
  const auto value_m = quantity_of(text, units);
  if (!value_m)
    throw Error(Trouble::usage,
                option + ": '" + text + "' is not a length, such as 2mm, 0.1m or 50um");
  return *value_m;
}

double parse_angle_rad(const std::string& text, const std::string& option) {
  static const std::map<std::string, double> units = {
      {"", 1}, {"rad", 1}, {"mrad", 1e-3}, {"deg", std::numbers::pi / 180}};
  const auto value_rad = quantity_of(text, units);
  if (!value_rad)
    throw Error(Trouble::usage,
                option + ": '" + text + "' is not an angle, such as 2deg, 35mrad or 0.035rad");
  if (*value_rad > std::numbers::pi)
    throw Error(Trouble::usage, option + ": '" + text + "' is more than half a turn, 180deg");
  return *value_rad;
}

double parse_number(const std::string& text, const std::string& option) {
  const auto value = quantity_of(text, {{"", 1}});
  if (!value)
    throw Error(Trouble::usage, option + ": '" + text + "' is not a bare number, such as 0.05");
  return *value;
}

int run_program(int argc, char** argv, const std::vector<Command>& commands) {
  Console console;
  CLI::App app("libscan " + version_text() +
                   ": from a scanner's raw data to a verified surface, real or simulated",
               "scan");
  app.set_version_flag("--version", "scan " + version_text());
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  std::vector<Declared> declared;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    sub->footer("Example:\n  " + command.example);
    auto line = std::make_shared<CliCommandLine>(*sub);
    Action action = command.declare(*line);
    declare_shared_options(*line, console);
    declared.push_back({&command, sub, line, std::move(action)});
  }
  app.footer(
      "Run 'scan COMMAND --help' for a command's arguments and an example.\n"
      "Exit codes: 0 ok; 1 verification failed; 2 usage; 3 input; 4 computation;\n"
      "5 output; 6 resource limit; 130 interrupted.");
  if (argc > 1 && std::string(argv[1]) == "help") return run_help(argc, argv, commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // help and version
  } catch (const CLI::ParseError& error) {
    return report_error(console, "scan",
                        Error(Trouble::usage, usage_message(app, error, argc, argv),
                              unknown_word_hint(app, argc, argv, commands)));
  }
  watch_for_interrupt();
  for (const Declared& entry : declared)
    if (entry.app->parsed()) return run_action(entry, console);
  return static_cast<int>(Trouble::usage);
}

}  // namespace scan
