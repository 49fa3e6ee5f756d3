// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/version.h"

#include <fstream>

#ifdef LIBSCAN_WITH_CGAL
#include <CGAL/version.h>
#endif
#include <ceres/version.h>
#include <embree3/rtcore_config.h>
#include <pcl/pcl_config.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>

#include "tools/commands.h"

namespace scan {
namespace {

std::string dotted(int major, int minor, int patch) {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

}  // namespace

std::string machine_text() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

std::string version_text() {
  return LIBSCAN_VERSION;
}

nlohmann::ordered_json version_json() {
  nlohmann::ordered_json libraries = {
      {"Embree", RTC_VERSION_STRING},
      {"Eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"OpenCV", CV_VERSION},
      {"PCL", dotted(PCL_MAJOR_VERSION, PCL_MINOR_VERSION, PCL_REVISION_VERSION)},
      {"Ceres", CERES_VERSION_STRING}};
#ifdef LIBSCAN_WITH_CGAL
  libraries["CGAL"] = CGAL_VERSION_STR;
#endif
  return {{"compiler", __VERSION__}, {"libraries", libraries}};
}

Action version_command(CommandLine&) {
  return [](Console& console) {
    const auto version = version_json();
    console.say("scan " + version_text() + " (" + version["compiler"].get<std::string>() + ")");
    for (const auto& [library, number] : version["libraries"].items())
      console.say("  " + library + " " + number.get<std::string>());
    console.finish("version", "ok", version);
    return 0;
  };
}

}  // namespace scan
