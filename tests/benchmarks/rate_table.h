// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rates of rivals on the same work, and their ratios in a table after the usual lines.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace scan {

// Times `work`, which does `items` things and returns their checksum; the first rival of a case to
// run sets the checksum that the others must meet to the relative `tolerance`.
inline void add_rate(const std::string& name, const std::string& rival, std::size_t items,
                     double tolerance, const std::function<double()>& work) {
  static std::map<std::string, double> sums;
  benchmark::RegisterBenchmark((name + "/" + rival).c_str(), [=](benchmark::State& state) {
    double sum = 0;
    for (auto _ : state) benchmark::DoNotOptimize(sum = work());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
    state.counters["checksum"] = sum;
    const double reference = sums.try_emplace(name, sum).first->second;
    if (!(std::abs(sum - reference) <= tolerance * std::abs(reference)))
      state.SkipWithError("checksum differs");
  })->Unit(benchmark::kMillisecond);
}

class RateReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      failed_ |= run.error_occurred;
      if (run.error_occurred || run.run_type != Run::RT_Iteration) continue;
      const std::string name = run.benchmark_name();
      const std::size_t slash = name.rfind('/');
      double& best = best_[name.substr(0, slash)][name.substr(slash + 1)];
      best = std::max(best, run.counters.at("items_per_second").value);
    }
  }

  // Each rival's rate in millions per second and, behind it, as a fraction of each base's.
  void print(const std::vector<std::string>& bases) const {
    for (const auto& [name, rates] : best_) {
      std::printf("%-22s", name.c_str());
      for (const auto& [rival, rate] : rates) {
        std::printf("  %s %.2f", rival.c_str(), rate * 1e-6);
        if (std::find(bases.begin(), bases.end(), rival) != bases.end()) continue;
        for (const std::string& base : bases)
          if (rates.contains(base)) std::printf(" (%.2f)", rate / rates.at(base));
      }
      std::printf("\n");
    }
  }
  bool failed() const { return failed_; }

 private:
  std::map<std::string, std::map<std::string, double>> best_;
  bool failed_ = false;
};

inline int run_rates(const std::vector<std::string>& bases) {
  RateReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  std::printf("\nmillion rays per second (fractions of");
  for (const std::string& base : bases) std::printf(" %s", base.c_str());
  std::printf(")\n");
  reporter.print(bases);
  return reporter.failed() ? 1 : 0;
}

}  // namespace scan
