// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the program says: results on stdout, everything else on stderr.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "libscan/core/cost.h"
#include "libscan/core/progress.h"

namespace scan {

// Thrown through the running stage when the user asks to stop (Ctrl-C); exit code 130.
struct Interrupted {};

// From now on Ctrl-C makes the next progress report throw Interrupted; a second one ends at once.
void watch_for_interrupt();

// The settings that every command shares, and the stages' seconds.
class Console {
 public:
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  long threads = 0;       // 0: all cores
  bool is_inner = false;  // of a run within another command: its warnings are kept, not shown

  void log(const std::string& text) const;     // stderr, unless quiet
  void detail(const std::string& text) const;  // stderr, with -v
  void warn(const std::string& text);       // stderr unless inner, and into the JSON's "warnings"
  void say(const std::string& text) const;  // stdout, unless --json

  // Shows a bar on a terminal, nothing elsewhere; throws Interrupted after Ctrl-C.
  Progress progress() const;

  // Takes note of a stage's wall time.
  void time(const std::string& stage, double seconds);
  const std::map<std::string, double>& seconds() const { return seconds_; }

  // With --json: prints `result` behind the keys that every object has.
  void finish(const std::string& command, const std::string& status,
              const nlohmann::ordered_json& result) const;

 private:
  std::map<std::string, double> seconds_;
  std::vector<std::string> warnings_;
  Stopwatch total_;
};

// "12.3 um", "1.23 mm", "4.5 m": three significant digits with the unit that suits.
std::string readable_length(double metres);

// A measurement's value with a readable unit.
std::string readable_value(double value, std::string_view unit);

}  // namespace scan
