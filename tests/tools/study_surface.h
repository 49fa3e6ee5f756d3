// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Studies that are never run: tables of what their runs would give.
#pragma once

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "libscan/core/random.h"
#include "tools/study_search.h"

namespace scan::test {

// A table of what a study of its own would measure: of `count` values for each of the fields.
class Surface {
 public:
  Surface(std::uint64_t number, const std::vector<std::size_t>& counts) : random_(77, 0, number) {
    nlohmann::json vary = nlohmann::json::array();
    for (std::size_t k = 0; k < counts.size(); ++k) {
      nlohmann::json values = nlohmann::json::array();
      for (std::size_t i = 0; i < counts[k]; ++i) values.push_back(i + 1);
      vary.push_back({{"key", std::string(1, static_cast<char>('a' + k))}, {"values", values}});
    }
    const nlohmann::json json = {{"vary", vary}, {"seeds", 3}};
    study = read_study(JsonReader(json, "surface"));
    tell_runs(number);
  }

  StudyPoint measure(const Setting& setting, int seeds) {
    StudyPoint p{.setting = setting, .runs = static_cast<std::size_t>(seeds)};
    for (int i = 0; i < seeds; ++i) {
      const auto& [error, seconds] = runs_.at({setting, i});
      p.errors.push_back(error);
      p.seed_seconds.push_back(seconds);
      p.error += error / seeds;
      p.seconds += seconds / seeds;
      looked_at.insert({setting, i});
    }
    return p;
  }

  Study study;
  std::set<std::pair<Setting, int>> looked_at;

 private:
  // Per step of a field an error of exp(-0.1) to exp(-0.9) times as much, and seconds of 1.05 to
  // 2.2; a stage that a field does not touch adds its own; every two fields change each other's
  // effect by exp(0.1 normal) at each couple of values; 3 % of chance in the errors, half of it
  // that of the seed, and 1 % in the seconds.
  void tell_runs(std::uint64_t number) {
    const std::size_t fields = study.vary.size();
    std::vector<double> better(fields), dearer(fields), floors(fields);
    for (std::size_t k = 0; k < fields; ++k) {
      better[k] = 0.1 + 0.8 * random_.uniform();
      dearer[k] = 0.05 + 0.75 * random_.uniform();
      floors[k] = 0.5 * random_.uniform();
    }
    const double stage = 3 * random_.uniform();
    for (const Setting& setting : grid(study)) {
      double log_error = 0, log_seconds = 0;
      for (std::size_t k = 0; k < fields; ++k) {
        const auto step = static_cast<double>(setting[k]);
        log_error += std::log(std::exp(-better[k] * step) + floors[k]);
        log_seconds += dearer[k] * step;
        for (std::size_t l = 0; l < k; ++l) {
          RandomStream couple(number, static_cast<std::uint32_t>(10 * k + l),
                              10 * setting[k] + setting[l]);
          log_error += 0.1 * couple.normal();
        }
      }
      for (int i = 0; i < study.seeds; ++i) {
        const double of_seed = RandomStream(number, 1000, static_cast<std::uint64_t>(i)).normal();
        const double of_run = random_.normal(), of_clock = random_.normal();
        runs_[{setting, i}] = {std::exp(log_error + 0.02 * of_seed + 0.02 * of_run),
                               (std::exp(log_seconds) + stage) * (1 + 0.01 * of_clock)};
      }
    }
  }

  RandomStream random_;
  std::map<std::pair<Setting, int>, std::pair<double, double>> runs_;
};

}  // namespace scan::test
