// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// CloudCompare by its command line, without a window.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/benchmarks/metrics_peers.h"

namespace scan {
namespace {

bool run(const std::string& arguments) {
  const std::string command =
      "QT_QPA_PLATFORM=offscreen CloudCompare -SILENT -AUTO_SAVE OFF -C_EXPORT_FMT ASC -PREC 12 "
      "-SEP SPACE " +
      arguments + " >/dev/null 2>&1";
  return std::system(command.c_str()) == 0;
}

// The last number of each line.
std::vector<double> last_column(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<double> values;
  for (std::string line; std::getline(file, line);) {
    std::istringstream numbers(line);
    double value = NAN;
    while (numbers >> value) continue;
    values.push_back(std::abs(value));
  }
  return values;
}

}  // namespace

std::optional<std::vector<double>> cloudcompare_distances_m(const MetricsCase& of,
                                                            std::size_t count) {
  const auto samples = of.measured_file.parent_path() / "samples.asc",
             distances = of.measured_file.parent_path() / "distances.asc";
  std::filesystem::remove(samples);
  std::filesystem::remove(distances);
  const bool ran = run("-O " + of.measured_file.string() + " -SAMPLE_MESH POINTS " +
                       std::to_string(count) + " -SAVE_CLOUDS FILE " + samples.string()) &&
                   run("-O " + samples.string() + " -O " + of.truth_file.string() +
                       " -C2M_DIST -SAVE_CLOUDS FILE " + distances.string());
  if (!ran || !std::filesystem::exists(distances)) return std::nullopt;
  return last_column(distances);
}

}  // namespace scan
