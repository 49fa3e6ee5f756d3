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

void three_numbers(Fields& f, const std::string& key, Eigen::Vector3d& value) {
  std::vector<double> numbers(value.data(), value.data() + 3);
  f.numbers(key, numbers);
  if (numbers.size() != 3)
    throw Error(Trouble::input, f.place() + "/" + key + ": " + std::to_string(numbers.size()) +
                                    " numbers, must be 3");
  value = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
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
  f.length("wavelength", s.wavelength_m);
  f.number("beam_quality", s.beam_quality);
  f.length("plane_bow", s.plane_bow_m);
  f.length("plane_shift", s.plane_shift_m);
  f.angle("plane_turn", s.plane_turn_rad);
  f.length("aperture", s.aperture_m);
  f.length("lens_focus", s.lens_focus_m);
  f.number("speckle_contrast", s.speckle_contrast);
  f.number("exposure_share", s.exposure_share);
  f.number("blooming_share", s.blooming_share);
  f.number("ambient_electrons", s.ambient_electrons);
  f.number("electrons_per_w_m2", s.electrons_per_w_m2);
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
  f.length("wavelength", s.wavelength_m);
  f.number("electrons_per_w_m2", s.electrons_per_w_m2);
  f.length("aperture", s.aperture_m);
  f.number("vignetting", s.vignetting);
  three_numbers(f, "right_rotation_error_rad", s.right_rotation_error_rad);
  f.vector("right_position_error", s.right_position_error_m);
  three_numbers(f, "velocity_m_s", s.velocity_m_s);
  three_numbers(f, "angular_velocity_rad_s", s.angular_velocity_rad_s);
  f.time("row_time", s.row_time_s);
  f.time("exposure", s.exposure_s);
  f.object("sensor", [&](Fields& inner) { sensor_fields(inner, s.sensor); });
}

void scanner_fields(Fields& f, PhaseCamera& s) {
  f.object(
      "camera", [&](Fields& c) { camera_fields(c, s.camera); }, Need::required);
  f.frequencies("frequencies", s.frequencies_hz);
  f.length("wavelength", s.wavelength_m);
  f.number("electrons_at_1m", s.electrons_at_1m);
  f.number("contrast", s.contrast);
  f.number("ambient_electrons", s.ambient_electrons);
  f.number("electrons_per_w_m2", s.electrons_per_w_m2);
  f.length("emitter_offset", s.emitter_offset_m);
  f.numbers("harmonics", s.harmonics);
  f.time("tap_interval", s.tap_interval_s);
  three_numbers(f, "velocity_m_s", s.velocity_m_s);
  three_numbers(f, "angular_velocity_rad_s", s.angular_velocity_rad_s);
  f.number("vignetting", s.vignetting);
  f.length("aperture", s.aperture_m);
  f.length("focus", s.focus_m);
  f.length("range_offset", s.range_offset_m);
  f.length("pixel_offset", s.pixel_offset_m);
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

void motion_fields(Fields& f, synth::LidarMotion& m) {
  f.time("interval", m.interval_s);
  three_numbers(f, "velocity_m_s", m.velocity_m_s);
  three_numbers(f, "angular_velocity_rad_s", m.angular_velocity_rad_s);
  f.boolean("measured", m.is_measured);
}

void range_walk_fields(Fields& f, synth::RangeWalk& w) {
  f.time("per_decade", w.per_decade_s);
  f.number("at_electrons", w.at_electrons);
  f.boolean("calibrated", w.is_calibrated);
}

void gate_fields(Fields& f, synth::LidarGate& g) {
  f.integer("samples", g.samples);
  f.number("threshold_electrons", g.threshold_electrons);
}

void scanner_fields(Fields& f, PulsedLidar& s) {
  int pattern = static_cast<int>(s.pattern.index());
  f.one_of({"raster", "spinning"}, pattern, [&](int index, Fields& inner) {
    select(s.pattern, index);
    std::visit([&](auto& p) { pattern_fields(inner, p); }, s.pattern);
  });
  f.length("wavelength", s.wavelength_m);
  f.time("pulse_sigma", s.pulse_sigma_s);
  f.time("sample_interval", s.sample_interval_s);
  f.number("electrons_at_10m", s.electrons_at_10m);
  f.number("ambient_electrons", s.ambient_electrons);
  f.number("electrons_per_w_m2", s.electrons_per_w_m2);
  f.angle("divergence", s.divergence_rad);
  f.length("exit_radius", s.exit_radius_m);
  f.integer("sub_rays", s.sub_rays);
  f.object("motion", [&](Fields& c) { motion_fields(c, s.motion); });
  f.object("range_walk", [&](Fields& c) { range_walk_fields(c, s.range_walk); });
  f.object("gate", [&](Fields& c) { gate_fields(c, s.gate); });
  f.length("overlap", s.overlap_m);
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
