// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The keys of the stages behind the scanner.
#include "tools/recipe_fields.h"

namespace scan {
namespace {

// A choice among the values of an enumeration that counts from zero.
template <class Enum>
void enumeration(Fields& f, std::string_view key, Enum& value,
                 const std::vector<std::string>& names) {
  int index = static_cast<int>(value);
  f.choice(key, index, names);
  value = static_cast<Enum>(index);
}

}  // namespace

void fields(Fields& f, AcquireOptions& o) {
  f.object("laser_line", [&](Fields& s) {
    enumeration(s, "peak", o.laser_line.peak, {"centroid", "gaussian", "parabola"});
    s.number("threshold_sigmas", o.laser_line.threshold_sigmas);
    s.number("max_shape_error", o.laser_line.max_shape_error);
  });
  f.object("stereo", [&](Fields& s) {
    s.integer("block_px", o.stereo.block_px);
    s.number("max_left_right_px", o.stereo.max_left_right_px);
    s.integer("edge_margin_px", o.stereo.edge_margin_px);
    s.number("disparity_sigma_px", o.stereo.disparity_sigma_px);
  });
  f.object("phase", [&](Fields& s) {
    s.number("min_amplitude_sigmas", o.phase.min_amplitude_sigmas);
    s.number("max_inconsistency_sigmas", o.phase.max_inconsistency_sigmas);
  });
  f.object("waveform", [&](Fields& s) {
    enumeration(s, "pulse", o.waveform.pulse, {"leading_edge", "centroid", "matched_filter"});
    s.number("threshold_sigmas", o.waveform.threshold_sigmas);
  });
  f.object("normals", [&](Fields& s) { s.integer("neighbours", o.normals.neighbours); });
}

void fields(Fields& f, MultiviewOptions& o) {
  enumeration(f, "method", o.icp.method,
              {"point-to-point", "point-to-plane", "symmetric", "plane-to-plane"});
  enumeration(f, "search", o.icp.search,
              {"kd-tree", "octree", "brute-force", "flann", "pcl-octree"});
  f.length("max_distance", o.icp.max_pair_distance_m);
  f.angle("max_normal_angle", o.icp.max_normal_angle_rad);
  f.number("trim_fraction", o.icp.trim_fraction);
  f.integer("max_iterations", o.icp.max_iterations);
  f.length("thin", o.thin_m);
  f.integer("max_rounds", o.max_rounds);
  f.number("min_overlap", o.icp.min_overlap);
}

void fields(Fields& f, ReconstructSettings& s) {
  enumeration(f, "method", s.method, reconstruct_method_names());
  f.integer("depth", s.ssd.depth);
  f.length("sigma", s.ssd.sigma_m);
  f.length("smoothing_length", s.ssd.smoothing_length_m);
  f.boolean("sharp", s.sharp);
  f.boolean("quads", s.quads);
  f.length("thin", s.thin_m);
  f.length("trim", s.trim_m);
  f.length("decimate", s.decimate_m);
  f.length("max_sigma", s.max_sigma_m);
}

void fields(Fields& f, synth::Artefacts& a) {
  f.vector("volume", a.volume_m);
  f.vector("centre", a.centre_m);
  f.length("ball_diameter", a.ball_diameter_m);
  f.length("bar_length", a.bar_length_m);
  f.length("plate", a.plate_m);
  f.length("cylinder_diameter", a.cylinder_diameter_m);
  f.length("step", a.step_m);
}

void fields(Fields& f, VerifySettings& s) {
  f.length("seen_distance", s.seen_distance_m);
  f.length("f_score_threshold", s.f_score_threshold_m);
  f.integer("samples", s.samples);
}

}  // namespace scan
