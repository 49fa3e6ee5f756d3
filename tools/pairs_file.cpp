// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/pairs_file.h"

#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_output.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/shape_json.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

constexpr Stop stops[] = {Stop::converged,          Stop::iteration_limit, Stop::too_few_points,
                          Stop::no_correspondences, Stop::degenerate,      Stop::low_overlap};

ordered_json to_json(const ScanEdge& edge) {
  const auto& centre = edge.centre;
  const auto information = edge.information.reshaped();
  return {{"source", edge.source},
          {"target", edge.target},
          {"target_from_source_guess", scan::to_json(edge.target_from_source_guess)},
          {"target_from_source", scan::to_json(edge.target_from_source)},
          {"stop", name_of(edge.stop)},
          {"overlap", edge.overlap},
          {"agreement", edge.agreement},
          {"rms_m", edge.rms_m},
          {"centre_m", std::vector<double>(centre.begin(), centre.end())},
          {"information", std::vector<double>(information.begin(), information.end())}};
}

Stop stop_from(JsonReader& reader) {
  const std::string name = reader.text("stop");
  for (const Stop stop : stops)
    if (name == name_of(stop)) return stop;
  reader.fail("stop", "'" + name + "' is no reason to stop");
}

std::vector<double> numbers(JsonReader& reader, const char* key, std::size_t count) {
  std::vector<double> values = reader.numbers(key);
  if (values.size() != count) reader.fail(key, "must hold " + std::to_string(count) + " numbers");
  return values;
}

ScanEdge edge_from(JsonReader& reader) {
  const auto pose = [&](const char* key) {
    return pose_from_json(reader.value(key), reader.place() + "/" + key);
  };
  ScanEdge edge;
  edge.source = static_cast<std::size_t>(reader.integer("source"));
  edge.target = static_cast<std::size_t>(reader.integer("target"));
  edge.target_from_source_guess = pose("target_from_source_guess");
  edge.target_from_source = pose("target_from_source");
  edge.stop = stop_from(reader);
  edge.overlap = reader.number("overlap");
  edge.agreement = reader.number("agreement");
  edge.rms_m = reader.number("rms_m");
  edge.centre = Eigen::Vector3d(numbers(reader, "centre_m", 3).data());
  edge.information = Matrix6(numbers(reader, "information", 36).data());
  reader.finish();
  return edge;
}

}  // namespace

void write_pairs(const std::filesystem::path& path, const std::string& inputs,
                 const std::vector<ScanEdge>& edges) {
  ordered_json pairs = ordered_json::array();
  for (const ScanEdge& edge : edges) pairs.push_back(to_json(edge));
  write_json(path, {{"inputs", inputs}, {"pairs", pairs}});
}

std::vector<ScanEdge> read_pairs(const std::filesystem::path& path, const std::string& inputs) {
  if (!std::filesystem::exists(path)) return {};
  const nlohmann::json document = read_json(path);
  JsonReader reader(document, path.string());
  if (reader.text("inputs") != inputs)
    throw Error(Trouble::input, path.string() + ": holds pairs of other scans or settings",
                "without --resume they are replaced");
  std::vector<ScanEdge> edges;
  for (JsonReader& entry : reader.objects("pairs")) edges.push_back(edge_from(entry));
  reader.finish();
  return edges;
}

}  // namespace scan
