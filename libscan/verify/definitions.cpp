// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/definitions.h"

#include <string_view>
#include <utility>
#include <vector>

#include "libscan/core/nearest_word.h"

namespace scan {
namespace {

using Line = std::pair<std::string_view, std::string_view>;

constexpr Line distances[] = {
    {"accuracy", "distances |d| of the measured surface from the true one"},
    {"completeness", "distances |d| of the true surface from the measured one"}};

constexpr Line statistics[] = {{"_mean", "mean of the "},
                               {"_rms", "root mean square of the "},
                               {"_median", "median (nearest rank) of the "},
                               {"_p95", "smallest value that 95 % do not exceed of the "},
                               {"_p997", "smallest value that 99.7 % do not exceed of the "},
                               {"_max", "largest of the "}};

constexpr Line figures[] = {
    {"hausdorff", "distance of the farthest point of either surface from the other"},
    {"f_score", "2 P R / (P + R); P, R: shares of accuracy, completeness within the threshold"},
    {"normal_error_mean", "mean angle between measured and true outward normals"},
    {"area_error", "measured over true area, less 1"},
    {"volume_error", "measured over true volume, less 1"},
    {"components", "parts of the mesh that share no vertex"},
    {"boundary_edges", "edges of one triangle only"},
    {"non_manifold_edges", "edges of three triangles or more"},
    {"genus", "handles, by Euler's formula"},
    {"self_intersections", "pairs of triangles that meet beside their shared vertices and edges"},
    {"unsupported_area", "share of area in triangles with a vertex away from all data"},
    {"rotation_error", "angle between estimated and true rotation, largest"},
    {"rotation_error_mean", "angle between estimated and true rotation, mean"},
    {"translation_error", "how far the centroid of a scan's points is off, largest"},
    {"translation_error_mean", "how far the centroid of a scan's points is off, mean"},
    {"pose_error_rms", "how far a scan's points are off, root mean square, largest"},
    {"pose_error_rms_mean", "how far a scan's points are off, root mean square, mean"},
    {"relative_rotation_error", "rotation_error of the motion between neighbours, largest"},
    {"relative_rotation_error_mean", "rotation_error of the motion between neighbours, mean"},
    {"relative_translation_error", "translation_error of the motion between neighbours, largest"},
    {"relative_translation_error_mean", "translation_error of the motion between neighbours, mean"},
    {"target_registration_error", "how far targets are off, root mean square, largest"},
    {"target_registration_error_max", "how far the farthest target is off"},
    {"range_error_bias", "mean of measured less true range"},
    {"range_error_rms", "root mean square of measured less true range"},
    {"range_error_p95", "smallest value that 95 % of |measured less true range| do not exceed"},
    {"ray_hit_fraction", "share of the rays that gave a point"},
    {"normalised_range_error_rms",
     "root mean square of range error over stated sigma; 1 is honest"},
    {"range_error_within_95", "share of ranges inside their stated 95 % interval"},
    {"normalised_pose_error_rms", "root of mean e' C^-1 e / 6, C stated covariance; 1 is honest"},
    {"pose_error_within_95", "share of poses inside their stated 95 % ellipsoid"},
    {"normalised_surface_error_rms",
     "root mean square of d over standard error (points, poses, smoothing); 1 is honest"},
    {"surface_error_within_95", "share of vertices inside their stated 95 % interval"},
    {"probing_form", "range of the residuals to the Gauss sphere, 0.3 % left out"},
    {"probing_form_95", "narrowest width that holds 95 % of the residuals to the Gauss sphere"},
    {"probing_size", "fitted less calibrated diameter of the ball"},
    {"sphere_spacing_error", "measured less calibrated distance of the ball centres"},
    {"flatness", "range of the residuals to the Gauss plane, 0.3 % left out"},
    {"flatness_95", "narrowest width that holds 95 % of the residuals to the Gauss plane"},
    {"cylinder_diameter_error", "fitted less calibrated diameter of the cylinder"},
    {"cylindricity", "range of the residuals to the Gauss cylinder, 0.3 % left out"},
    {"cylindricity_95", "narrowest width that holds 95 % of the residuals to the Gauss cylinder"},
    {"cylinder_axis_error", "angle between fitted and true axis"},
    {"step_error", "measured less calibrated height of the step"},
    {"structural_resolution", "smallest wave period shown with half its amplitude or more"},
    {"length_error", "measured less calibrated distance of two ball centres in the volume"},
    {"relative_range_error", "measured less true distance behind the first plate, along the sight"},
    {"disparity_bad_2px", "share of the matched pixels off by more than 2 px"},
    {"disparity_bad_2px_all", "share of all pixels off by more than 2 px or not matched"},
    {"disparity_density", "share of the pixels that were matched"},
    {"disparity_error_median", "median of |measured less true disparity|"},
    {"relative_depth_error_median", "median of |measured over true depth, less 1|"}};

std::string of_one(const std::string& name) {
  for (const auto& [known, text] : figures)
    if (name == known) return std::string(text);
  for (const auto& [way, what] : distances)
    for (const auto& [suffix, statistic] : statistics)
      if (name == std::string(way) + std::string(suffix))
        return std::string(statistic) + std::string(what);
  return {};
}

}  // namespace

std::string definition(const std::string& name) {
  constexpr std::string_view merged = "merged_", repeated = "_repeatability";
  std::string text;
  if (name.starts_with(merged)) {
    text = of_one(name.substr(merged.size()));
    if (!text.empty()) text += ", of several views together";
  } else if (name.ends_with(repeated)) {
    text = of_one(name.substr(0, name.size() - repeated.size()));
    if (!text.empty()) text = "standard deviation of " + text;
  } else {
    text = of_one(name);
  }
  return text;
}

std::string figure_hint(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [known, text] : figures) names.emplace_back(known);
  for (const auto& [way, what] : distances)
    for (const auto& [suffix, statistic] : statistics)
      names.push_back(std::string(way) + std::string(suffix));
  const std::string nearest = nearest_word(name, names);
  return nearest.empty() ? nearest : "did you mean '" + nearest + "'?";
}

}  // namespace scan
