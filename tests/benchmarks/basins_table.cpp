// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/basins_table.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "libscan/io/atomic_file.h"
#include "libscan/io/text.h"

namespace scan::test {
namespace {

constexpr double normal_quantile = 1.96;  // of 97.5 %
constexpr double solved_percent = 1;

double wilson(const Share& share, double side) {
  if (share.trials == 0) return side < 0 ? 0 : 1;
  const double n = double(share.trials), p = share.value(), z = normal_quantile;
  const double middle = p + z * z / (2 * n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return std::clamp((middle + side * half) / (1 + z * z / n), 0.0, 1.0);
}

std::string rounded(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

double median_seconds(const std::vector<Trial>& trials,
                      const std::function<bool(const Trial&)>& among) {
  std::vector<double> seconds;
  for (const Trial& trial : trials)
    if (among(trial)) seconds.push_back(trial.seconds);
  if (seconds.empty()) return 0;
  std::nth_element(seconds.begin(), seconds.begin() + std::ptrdiff_t(seconds.size() / 2),
                   seconds.end());
  return seconds[seconds.size() / 2];
}

std::string success_rows(const std::vector<Trial>& trials, const std::string& shape,
                         const std::string& method) {
  std::string rows;
  for (const double overlap : values_of(trials, &Trial::overlap))
    for (const double turn : values_of(trials, &Trial::turn_deg))
      for (const double shift : values_of(trials, &Trial::shift_percent)) {
        const auto here = [&](const Trial& trial) {
          return trial.shape == shape && trial.method == method && trial.overlap == overlap &&
                 trial.turn_deg == turn && trial.shift_percent == shift;
        };
        const Share solved = share_of(trials, here, is_solved);
        if (solved.trials == 0) continue;
        const Share wrong = share_of(trials, here, [](const Trial& trial) {
          return !is_solved(trial) && trial.claims_success;
        });
        rows += shape + "," + method + "," + rounded(100 * overlap, 0) + "," + rounded(turn, 0) +
                "," + rounded(shift, 0) + "," + std::to_string(solved.trials) + "," +
                std::to_string(solved.hits) + "," + rounded(solved.low(), 3) + "," +
                rounded(solved.high(), 3) + "," + std::to_string(wrong.hits) + "," +
                rounded(1e3 * median_seconds(trials, here), 1) + "\n";
      }
  return rows;
}

}  // namespace

bool is_solved(const Trial& trial) {
  return trial.error_percent <= solved_percent;
}

double Share::low() const {
  return wilson(*this, -1);
}

double Share::high() const {
  return wilson(*this, 1);
}

Share share_of(const std::vector<Trial>& trials, const std::function<bool(const Trial&)>& among,
               const std::function<bool(const Trial&)>& hit) {
  Share share;
  for (const Trial& trial : trials) {
    if (!among(trial)) continue;
    ++share.trials;
    share.hits += hit(trial);
  }
  return share;
}

void write_trials(const std::filesystem::path& file, const std::vector<Trial>& trials) {
  std::string text;
  for (const Trial& t : trials) {
    text += t.shape + "," + t.method;
    for (const double value : {t.overlap, t.turn_deg, t.shift_percent, t.error_percent, t.seconds})
      text += "," + shortest(value);
    text += t.claims_success ? ",1\n" : ",0\n";
  }
  write_file(file, text);
}

std::vector<Trial> read_trials(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Trial> trials;
  for (const auto& file : files) {
    std::istringstream lines(read_file(file));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::vector<std::string> cells;
      for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
      const auto number = [&](std::size_t k) { return *number_from<double>(cells.at(k)); };
      trials.push_back({cells.at(0), cells.at(1), number(2), number(3), number(4), number(5),
                        number(6), number(7) == 1});
    }
  }
  return trials;
}

void write_tables(const std::filesystem::path& folder, const std::vector<Trial>& trials) {
  std::string success =
      "shape,method,overlap_percent,turn_deg,shift_percent,trials,solved,wilson_low,wilson_high,"
      "wrong_but_claimed,median_ms\n";
  for (const std::string& shape : values_of(trials, &Trial::shape))
    for (const std::string& method : values_of(trials, &Trial::method))
      success += success_rows(trials, shape, method);
  write_file(folder / "success.csv", success);
}

}  // namespace scan::test
