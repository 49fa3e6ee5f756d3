// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The keys of the four scanners.
#include "libscan/core/error.h"
#include "tools/recipe_fields.h"

namespace scan {
namespace {

using synth::LaserLine;
using synth::PhaseCamera;
using synth::PulsedLidar;
using synth::StereoPair;

// Changes the variant's alternative unless it is the one already.
template <class Variant, std::size_t... I>
void select(Variant& variant, int index, std::index_sequence<I...>) {
  (void)((static_cast<int>(I) == index && variant.index() != I
              ? (variant.template emplace<I>(), true)
              : false) ||
         ...);
}

template <class Variant>
void select(Variant& variant, int index) {
  select(variant, index, std::make_index_sequence<std::variant_size_v<Variant>>{});
}

// focal_px serves both axes unless focal_y_px is given; the principal point is the image's middle.
void camera_fields(Fields& f, Camera& c) {
  f.integer("width_px", c.width_px, Need::required);
  f.integer("height_px", c.height_px, Need::required);
  f.number("focal_px", c.fx_px, Need::required);
  if (c.fy_px == 0) c.fy_px = c.fx_px;
  f.number("focal_y_px", c.fy_px);
  if (c.cx_px == 0) c.cx_px = (c.width_px - 1) / 2.0;
  if (c.cy_px == 0) c.cy_px = (c.height_px - 1) / 2.0;
  f.number("cx_px", c.cx_px);
  f.number("cy_px", c.cy_px);
  f.number("k1", c.k1);
  f.number("k2", c.k2);
  f.number("p1", c.p1);
  f.number("p2", c.p2);
  f.number("k3", c.k3);
}

void sensor_fields(Fields& f, Sensor& s) {
  f.number("gain_e_per_dn", s.gain_e_per_dn);
  f.number("offset_dn", s.offset_dn);
  f.number("read_noise_e", s.read_noise_e);
  f.number("full_well_e", s.full_well_e);
  f.integer("bits", s.bits);
}

void scanner_fields(Fields& f, LaserLine& s) {
  f.object(
      "camera", [&](Fields& c) { camera_fields(c, s.camera); }, Need::required);
  f.length("baseline", s.baseline_m, Need::required);
  f.angle("triangulation", s.triangulation_rad, Need::required);
  f.angle("fan", s.fan_rad);
  f.length("beam_radius", s.beam_radius_m);
  f.number("peak_electrons", s.peak_electrons);
  f.integer("steps", s.steps);
  f.length("step", s.step_m);
  f.direction("stage_direction", s.stage_direction);
  f.angle("turn", s.turn_rad);
  f.direction("turn_axis", s.turn_axis);
  f.vector("turn_centre", s.turn_centre_m);
  f.integer("sub_rays", s.sub_rays);
  f.object("sensor", [&](Fields& c) { sensor_fields(c, s.sensor); });
  f.length("min_range", s.min_range_m);
  f.length("max_range", s.max_range_m);
}

void scanner_fields(Fields& f, StereoPair& s) {
  StereoCalibration& c = s.calibration;
  f.integer("width_px", c.width_px, Need::required);
  f.integer("height_px", c.height_px, Need::required);
  f.number("focal_px", c.focal_px, Need::required);
  if (c.cx_px == 0) c.cx_px = (c.width_px - 1) / 2.0;
  if (c.cy_px == 0) c.cy_px = (c.height_px - 1) / 2.0;
  f.number("cx_px", c.cx_px);
  f.number("cy_px", c.cy_px);
  f.number("doffs_px", c.doffs_px);
  f.length("baseline", c.baseline_m, Need::required);
  f.integer("min_disparity_px", c.min_disparity_px);
  f.integer("disparities_px", c.disparities_px, Need::required);
  f.number("ambient_electrons", s.ambient_electrons);
  f.number("projector_electrons", s.projector_electrons);
  f.integer("projector_dots", s.projector_dots);
  f.length("focus", s.focus_m);
  f.integer("sub_rays", s.sub_rays);
  f.object("sensor", [&](Fields& inner) { sensor_fields(inner, s.sensor); });
}

void scanner_fields(Fields& f, PhaseCamera& s) {
  f.object(
      "camera", [&](Fields& c) { camera_fields(c, s.camera); }, Need::required);
  f.frequencies("frequencies", s.frequencies_hz);
  f.number("electrons_at_1m", s.electrons_at_1m);
  f.number("contrast", s.contrast);
  f.number("ambient_electrons", s.ambient_electrons);
  f.length("emitter_offset", s.emitter_offset_m);
  f.integer("sub_rays", s.sub_rays);
  f.object("sensor", [&](Fields& c) { sensor_fields(c, s.sensor); });
  f.length("max_range", s.max_range_m);
}

void pattern_fields(Fields& f, synth::RasterPattern& p) {
  f.integer("rows", p.rows);
  f.integer("columns", p.columns);
  f.angle("height", p.height_rad);
  f.angle("width", p.width_rad);
}

void pattern_fields(Fields& f, synth::SpinningPattern& p) {
  f.integer("rows", p.rows);
  f.integer("columns", p.columns);
  f.angle("lowest", p.lowest_rad);
  f.angle("highest", p.highest_rad);
}

void scanner_fields(Fields& f, PulsedLidar& s) {
  int pattern = static_cast<int>(s.pattern.index());
  f.one_of({"raster", "spinning"}, pattern, [&](int index, Fields& inner) {
    select(s.pattern, index);
    std::visit([&](auto& p) { pattern_fields(inner, p); }, s.pattern);
  });
  f.time("pulse_sigma", s.pulse_sigma_s);
  f.time("sample_interval", s.sample_interval_s);
  f.number("electrons_at_10m", s.electrons_at_10m);
  f.number("ambient_electrons", s.ambient_electrons);
  f.angle("divergence", s.divergence_rad);
  f.length("exit_radius", s.exit_radius_m);
  f.integer("sub_rays", s.sub_rays);
  f.object("sensor", [&](Fields& c) { sensor_fields(c, s.sensor); });
  f.length("min_range", s.min_range_m);
  f.length("max_range", s.max_range_m);
}

void layout_fields(Fields& f, synth::Turntable& l) {
  f.integer("count", l.count);
  f.length("radius", l.radius_m);
  f.length("height", l.height_m);
  f.vector("centre", l.centre_m);
}

void layout_fields(Fields& f, synth::Ring& l) {
  f.integer("count", l.count);
  f.length("radius", l.radius_m);
  f.length("height", l.height_m);
  f.angle("start", l.start_rad);
  f.angle("sweep", l.sweep_rad);
  f.vector("centre", l.centre_m);
}

void layout_fields(Fields& f, synth::Dome& l) {
  f.integer("count", l.count);
  f.length("radius", l.radius_m);
  f.angle("lowest", l.lowest_rad);
  f.vector("centre", l.centre_m);
}

void layout_fields(Fields& f, synth::PoseList& l) {
  f.poses("world_from_scanner", l.world_from_scanner);
}

}  // namespace

void fields(Fields& f, synth::Scanner& scanner) {
  int kind = static_cast<int>(scanner.index());
  f.one_of({"laser_line", "stereo_pair", "phase_camera", "pulsed_lidar"}, kind,
           [&](int index, Fields& inner) {
             select(scanner, index);
             std::visit([&](auto& s) { scanner_fields(inner, s); }, scanner);
           });
}

void fields(Fields& f, synth::Viewpoints& viewpoints) {
  int kind = static_cast<int>(viewpoints.layout.index());
  f.one_of({"turntable", "ring", "dome", "list"}, kind, [&](int index, Fields& inner) {
    select(viewpoints.layout, index);
    std::visit([&](auto& layout) { layout_fields(inner, layout); }, viewpoints.layout);
    inner.object("pose_noise", [&](Fields& noise) {
      noise.angle("rotation", viewpoints.pose_noise.rotation_rad);
      noise.length("translation", viewpoints.pose_noise.translation_m);
    });
  });
}

}  // namespace scan
