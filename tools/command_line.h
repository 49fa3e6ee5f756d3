// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The command line: what a command declares, and how it is read.
//
// A thin layer over CLI11 that adds quantities with units, one exit code for every usage error, and
// hints for mistyped words.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/console.h"

namespace scan {

// Runs a command once its arguments are read; returns the exit code.
using Action = std::function<int(Console&)>;

// What one command accepts. Every reference must live until the action has run.
class CommandLine {
 public:
  virtual ~CommandLine() = default;
  virtual void input(std::string name, std::string& value, std::string help) = 0;
  virtual void inputs(std::string name, std::vector<std::string>& values, std::string help) = 0;
  virtual void option(std::string name, std::string& value, std::string help) = 0;
  virtual void choice(std::string name, std::string& value, std::vector<std::string> choices,
                      std::string help) = 0;
  virtual void whole(std::string name, long& value, long least, long most, std::string help) = 0;
  virtual void number(std::string name, double& value, double least, double most,
                      std::string help) = 0;
  virtual void length(std::string name, double& value_m, std::string help) = 0;
  virtual void angle(std::string name, double& value_rad, std::string help) = 0;
  virtual void flag(std::string name, bool& value, std::string help) = 0;
};

// To add a command: tools/<verb>.cpp with one function of this type, and its line in scan.cpp.
struct Command {
  std::string name;
  std::string summary;
  std::string example;
  Action (*declare)(CommandLine&);
};

// What every command accepts beside its own.
void declare_shared_options(CommandLine& line, Console& console);

// Reads the arguments, runs the command that they name and returns the exit code. Every error ends
// in one line `error: ...` on stderr, and with --json in one object on stdout.
int run_program(int argc, char** argv, const std::vector<Command>& commands);

// "2mm", "0.1m", "50um", "0.3" (metres). Throws scan::Error (usage) naming the option.
double parse_length_m(const std::string& text, const std::string& option);

// "2deg", "35mrad", "0.035rad", "0.035" (radians), at most half a turn.
double parse_angle_rad(const std::string& text, const std::string& option);

// "0.05": not negative, without a unit.
double parse_number(const std::string& text, const std::string& option);

}  // namespace scan
