// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Names and limits of what icp.h declares.
#include "libscan/align/icp.h"
#include "libscan/core/error.h"
#include "libscan/core/shortest.h"

namespace scan {

std::string_view name_of(IcpMethod method) {
  switch (method) {
    case IcpMethod::point_to_point:
      return "point-to-point";
    case IcpMethod::point_to_plane:
      return "point-to-plane";
    case IcpMethod::symmetric:
      return "symmetric";
    case IcpMethod::plane_to_plane:
      return "plane-to-plane";
  }
  return "";
}

std::optional<IcpMethod> icp_method_from(std::string_view name) {
  for (const IcpMethod method : {IcpMethod::point_to_point, IcpMethod::point_to_plane,
                                 IcpMethod::symmetric, IcpMethod::plane_to_plane})
    if (name == name_of(method)) return method;
  return std::nullopt;
}

std::string_view name_of(Stop stop) {
  switch (stop) {
    case Stop::converged:
      return "converged";
    case Stop::iteration_limit:
      return "iteration limit";
    case Stop::too_few_points:
      return "too few points";
    case Stop::no_correspondences:
      return "no correspondences";
    case Stop::degenerate:
      return "degenerate";
    case Stop::low_overlap:
      return "low overlap";
  }
  return "";
}

void check(const IcpOptions& options) {
  const auto need = [](bool good, const char* name, double value, const char* limit) {
    if (!good)
      throw Error(Trouble::usage,
                  std::string("icp: ") + name + ": " + shortest(value) + ", " + limit);
  };
  need(options.max_pair_distance_m >= 0, "max_pair_distance_m", options.max_pair_distance_m,
       "must be at least 0");
  need(options.max_normal_angle_rad > 0 && options.max_normal_angle_rad <= 3.1416,
       "max_normal_angle_rad", options.max_normal_angle_rad, "must be above 0 and at most pi");
  need(options.trim_fraction >= 0 && options.trim_fraction < 1, "trim_fraction",
       options.trim_fraction, "must be at least 0 and below 1");
  need(options.min_overlap >= 0 && options.min_overlap <= 1, "min_overlap", options.min_overlap,
       "must be at least 0 and at most 1");
  need(options.max_iterations >= 1, "max_iterations", options.max_iterations, "must be at least 1");
  need(options.stop_rotation_rad > 0, "stop_rotation_rad", options.stop_rotation_rad,
       "must be above 0");
  need(options.stop_translation_fraction > 0, "stop_translation_fraction",
       options.stop_translation_fraction, "must be above 0");
}

}  // namespace scan
