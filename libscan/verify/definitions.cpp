// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/definitions.h"

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "libscan/core/nearest_word.h"

namespace scan {
namespace {

using Line = std::pair<std::string_view, std::string_view>;

struct Figure {
  std::string_view name, unit, text;
};

constexpr Line distances[] = {
    {"accuracy", "distances |d| of the measured surface from the true one"},
    {"completeness", "distances |d| of the true surface from the measured one"}};

constexpr Line statistics[] = {{"_mean", "mean of the "},
                               {"_rms", "root mean square of the "},
                               {"_median", "median (nearest rank) of the "},
                               {"_p95", "smallest value that 95 % do not exceed of the "},
                               {"_p997", "smallest value that 99.7 % do not exceed of the "},
                               {"_max", "largest of the "}};

constexpr Figure of_surfaces_and_runs[] = {
    {"hausdorff", "m", "distance of the farthest point of either surface from the other"},
    {"f_score", "1",
     "2 P R / (P + R); P, R: shares of accuracy, completeness within the threshold"},
    {"normal_error_mean", "rad", "mean angle between measured and true outward normals"},
    {"area_error", "1", "measured over true area, less 1"},
    {"volume_error", "1", "measured over true volume, less 1"},
    {"components", "count", "parts of the mesh that share no vertex"},
    {"boundary_edges", "count", "edges of one triangle only"},
    {"non_manifold_edges", "count", "edges of three triangles or more"},
    {"genus", "count", "handles, by Euler's formula"},
    {"self_intersections", "count",
     "pairs of triangles that meet beside their shared vertices and edges"},
    {"unsupported_area", "1", "share of area in triangles with a vertex away from all data"},
    {"rotation_error", "rad", "angle between estimated and true rotation, largest"},
    {"rotation_error_mean", "rad", "angle between estimated and true rotation, mean"},
    {"translation_error", "m", "how far the centroid of a scan's points is off, largest"},
    {"translation_error_mean", "m", "how far the centroid of a scan's points is off, mean"},
    {"pose_error_rms", "m", "how far a scan's points are off, root mean square, largest"},
    {"pose_error_rms_mean", "m", "how far a scan's points are off, root mean square, mean"},
    {"relative_rotation_error", "rad", "rotation_error of the motion between neighbours, largest"},
    {"relative_rotation_error_mean", "rad",
     "rotation_error of the motion between neighbours, mean"},
    {"relative_translation_error", "m",
     "translation_error of the motion between neighbours, largest"},
    {"relative_translation_error_mean", "m",
     "translation_error of the motion between neighbours, mean"},
    {"target_registration_error", "m", "how far targets are off, root mean square, largest"},
    {"target_registration_error_max", "m", "how far the farthest target is off"},
    {"range_error_bias", "m", "mean of measured less true range"},
    {"range_error_rms", "m", "root mean square of measured less true range"},
    {"range_error_p95", "m",
     "smallest value that 95 % of |measured less true range| do not exceed"},
    {"ray_hit_fraction", "1", "share of the rays that gave a point"},
    {"normalised_range_error_rms", "1",
     "root mean square of range error over stated sigma; 1 is honest"},
    {"range_error_within_95", "1", "share of ranges inside their stated 95 % interval"},
    {"normalised_pose_error_rms", "1",
     "root of mean e' C^-1 e / 6, C stated covariance; 1 is honest"},
    {"pose_error_within_95", "1", "share of poses inside their stated 95 % ellipsoid"},
    {"normalised_surface_error_rms", "1",
     "root mean square of d over standard error (points, poses, smoothing); 1 is honest"},
    {"surface_error_within_95", "1", "share of vertices inside their stated 95 % interval"}};

constexpr Figure of_artefacts[] = {
    {"probing_form", "m", "range of the residuals to the Gauss sphere, 0.3 % left out"},
    {"probing_form_95", "m",
     "narrowest width that holds 95 % of the residuals to the Gauss sphere"},
    {"probing_size", "m", "fitted less calibrated diameter of the ball"},
    {"sphere_spacing_error", "m", "measured less calibrated distance of the ball centres"},
    {"flatness", "m", "range of the residuals to the Gauss plane, 0.3 % left out"},
    {"flatness_95", "m", "narrowest width that holds 95 % of the residuals to the Gauss plane"},
    {"cylinder_diameter_error", "m", "fitted less calibrated diameter of the cylinder"},
    {"cylindricity", "m", "range of the residuals to the Gauss cylinder, 0.3 % left out"},
    {"cylindricity_95", "m",
     "narrowest width that holds 95 % of the residuals to the Gauss cylinder"},
    {"cylinder_axis_error", "rad", "angle between fitted and true axis"},
    {"step_error", "m", "measured less calibrated height of the step"},
    {"structural_resolution", "m", "smallest wave period shown with half its amplitude or more"},
    {"length_error", "m", "measured less calibrated distance of two ball centres in the volume"},
    {"relative_range_error", "m",
     "measured less true distance behind the first plate, along the sight"}};

constexpr Figure of_disparities[] = {
    {"disparity_bad_2px", "1", "share of the matched pixels off by more than 2 px"},
    {"disparity_bad_2px_all", "1", "share of all pixels off by more than 2 px or not matched"},
    {"disparity_density", "1", "share of the pixels that were matched"},
    {"disparity_error_median", "px", "median of |measured less true disparity|"},
    {"relative_depth_error_median", "1", "median of |measured over true depth, less 1|"}};

const std::pair<FigureSource, std::span<const Figure>> tables[] = {
    {FigureSource::surface_or_run, of_surfaces_and_runs},
    {FigureSource::artefact, of_artefacts},
    {FigureSource::disparity, of_disparities}};

std::optional<FigureDefinition> plain_figure(const std::string& name) {
  for (const auto& [source, table] : tables)
    for (const Figure& figure : table)
      if (name == figure.name)
        return FigureDefinition{std::string(figure.text), std::string(figure.unit), source};
  for (const auto& [way, what] : distances)
    for (const auto& [suffix, statistic] : statistics)
      if (name == std::string(way) + std::string(suffix))
        return FigureDefinition{std::string(statistic) + std::string(what), "m",
                                FigureSource::surface_or_run};
  return std::nullopt;
}

}  // namespace

std::optional<FigureDefinition> figure_definition(const std::string& name) {
  constexpr std::string_view merged = "merged_", repeated = "_repeatability";
  const bool is_merged = name.starts_with(merged), is_repeated = name.ends_with(repeated);
  if (!is_merged && !is_repeated) return plain_figure(name);
  auto figure = plain_figure(is_merged ? name.substr(merged.size())
                                       : name.substr(0, name.size() - repeated.size()));
  if (!figure) return figure;
  figure->text = is_merged ? figure->text + ", of several views together"
                           : "standard deviation of " + figure->text;
  return figure;
}

std::string definition(const std::string& name) {
  const auto figure = figure_definition(name);
  return figure ? figure->text : "";
}

std::string figure_hint(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [source, table] : tables)
    for (const Figure& figure : table) names.emplace_back(figure.name);
  for (const auto& [way, what] : distances)
    for (const auto& [suffix, statistic] : statistics)
      names.push_back(std::string(way) + std::string(suffix));
  const std::string nearest = nearest_word(name, names);
  return nearest.empty() ? nearest : "did you mean '" + nearest + "'?";
}

}  // namespace scan
