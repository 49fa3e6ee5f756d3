// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/console.h"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"
#include "libscan/io/json_output.h"
#include "tools/version.h"

namespace scan {
namespace {

std::atomic<bool> interrupted{false};

void on_interrupt(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

std::string three_digits(double value, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3g %s", value, unit);
  return text;
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGINT, on_interrupt);
}

void Console::log(const std::string& text) const {
  if (!quiet) std::fprintf(stderr, "%s\n", text.c_str());
}

void Console::detail(const std::string& text) const {
  if (verbose) std::fprintf(stderr, "%s\n", text.c_str());
}

void Console::warn(const std::string& text) {
  if (!is_inner) std::fprintf(stderr, "warning: %s\n", text.c_str());
  warnings_.push_back(text);
}

void Console::say(const std::string& text) const {
  if (!json) std::printf("%s\n", text.c_str());
}

Progress Console::progress() const {
  const bool bar = !quiet && isatty(fileno(stderr));
  auto last_percent = std::make_shared<std::atomic<int>>(-1);
  return [bar, last_percent](std::string_view step, double share) {
    if (interrupted) throw Interrupted{};
    const int percent = static_cast<int>(std::floor(100 * share));
    if (!bar || last_percent->exchange(percent) == percent) return;
    char filled[31];
    for (int i = 0; i < 30; ++i) filled[i] = i < share * 30 ? '=' : ' ';
    filled[30] = 0;
    std::fprintf(stderr, "\r%-24.*s [%s] %3d %%", static_cast<int>(step.size()), step.data(),
                 filled, percent);
    if (percent >= 100) std::fprintf(stderr, "\r\033[K");
  };
}

void Console::time(const std::string& stage, double seconds) {
  seconds_[stage] += seconds;
}

void Console::finish(const std::string& command, const std::string& status,
                     const nlohmann::ordered_json& result) const {
  if (!json) return;
  nlohmann::ordered_json object = {
      {"command", command}, {"version", version_text()}, {"status", status}};
  object["warnings"] = warnings_;
  for (const auto& [key, value] : result.items()) object[key] = value;
  nlohmann::ordered_json seconds(seconds_);
  seconds["total"] = total_.seconds();
  object["seconds"] = seconds;
  object["peak_mib"] = peak_memory_mib();
  object["threads"] = thread_count();
  std::printf("%s", json_text(object).c_str());
}

std::string readable_length(double metres) {
  const double size = std::abs(metres);
  if (!std::isfinite(metres)) return "unknown";
  if (size == 0) return "0 m";
  // from 999.5 on three digits are 1000, which is 1 of the next unit
  if (size < 0.9995e-12) return three_digits(metres, "m");  // rounding
  if (size < 0.9995e-6) return three_digits(metres * 1e9, "nm");
  if (size < 0.9995e-3) return three_digits(metres * 1e6, "um");
  if (size < 0.9995) return three_digits(mm_from_m(metres), "mm");
  return three_digits(metres, "m");
}

std::string readable_value(double value, std::string_view unit) {
  if (unit == "m") return readable_length(value);
  if (unit == "rad") return three_digits(deg_from_rad(value), "deg");
  char text[64];
  std::snprintf(text, sizeof text, unit == "count" ? "%.0f" : "%.4g", value);
  return text;
}

}  // namespace scan
