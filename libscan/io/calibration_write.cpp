// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "libscan/io/calibration_json.h"
#include "libscan/io/shape_json.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json camera_json(const Camera& c) {
  return {{"width_px", c.width_px},
          {"height_px", c.height_px},
          {"fx_px", c.fx_px},
          {"fy_px", c.fy_px},
          {"cx_px", c.cx_px},
          {"cy_px", c.cy_px},
          {"k1", c.k1},
          {"k2", c.k2},
          {"p1", c.p1},
          {"p2", c.p2},
          {"k3", c.k3}};
}

ordered_json sensor_json(const Sensor& s) {
  return {{"gain_e_per_dn", s.gain_e_per_dn},
          {"offset_dn", s.offset_dn},
          {"read_noise_e", s.read_noise_e},
          {"full_well_e", s.full_well_e},
          {"bits", s.bits}};
}

ordered_json laser_json(const LaserLineCalibration& c,
                        const std::vector<Pose>& scanner_from_camera) {
  const Eigen::Vector3d& n = c.plane_normal;
  ordered_json steps = ordered_json::array();
  for (const Pose& pose : scanner_from_camera) steps.push_back(to_json(pose));
  return {{"device", "laser-line"},
          {"camera", camera_json(c.camera)},
          {"sensor", sensor_json(c.sensor)},
          {"light_plane", {{"normal", {n.x(), n.y(), n.z()}}, {"offset_m", c.plane_offset_m}}},
          {"min_range_m", c.min_range_m},
          {"max_range_m", c.max_range_m},
          {"scanner_from_camera", steps}};
}

ordered_json rows_of(const Eigen::MatrixXd& matrix) {
  ordered_json rows = ordered_json::array();
  for (const auto& row : matrix.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

}  // namespace

ordered_json calibration_json(const StripeImages& frames) {
  return laser_json(frames.calibration, frames.scanner_from_camera);
}

ordered_json calibration_json(const LaserLineSetup& setup, const LightPlaneCalibration& found) {
  ordered_json json = laser_json(setup.calibration, setup.scanner_from_camera);
  json["uncertainty"] = {{"rms_m", found.rms_m},
                         {"misfit", found.misfit},
                         {"points", found.points},
                         {"covariance", rows_of(found.covariance)}};
  return json;
}

ordered_json calibration_json(const CameraCalibration& found) {
  return {{"device", "camera"},
          {"camera", camera_json(found.camera)},
          {"uncertainty",
           {{"rms_px", found.rms_px},
            {"sigma_px", found.sigma_px},
            {"covariance", rows_of(found.covariance)}}}};
}

ordered_json calibration_json(const RigCalibration& found, double nearest_m, double farthest_m) {
  return {{"device", "stereo"},
          {"left", camera_json(found.rig.left)},
          {"right", camera_json(found.rig.right)},
          {"right_from_left", to_json(found.rig.right_from_left)},
          {"nearest_m", nearest_m},
          {"farthest_m", farthest_m},
          {"uncertainty",
           {{"rms_px", found.rms_px},
            {"sigma_px", found.sigma_px},
            {"epipolar_rms_px", found.epipolar_rms_px},
            {"baseline_sigma_m", found.baseline_sigma_m},
            {"covariance", rows_of(found.covariance)}}}};
}
ordered_json calibration_json(const ImagePair& frames) {
  const StereoCalibration& c = frames.calibration;
  return {{"device", "stereo"},
          {"width_px", c.width_px},
          {"height_px", c.height_px},
          {"focal_px", c.focal_px},
          {"cx_px", c.cx_px},
          {"cy_px", c.cy_px},
          {"doffs_px", c.doffs_px},
          {"baseline_m", c.baseline_m},
          {"min_disparity_px", c.min_disparity_px},
          {"disparities_px", c.disparities_px}};
}

ordered_json calibration_json(const PhaseTaps& frames) {
  const PhaseCalibration& c = frames.calibration;
  return {{"device", "phase"},
          {"camera", camera_json(c.camera)},
          {"sensor", sensor_json(c.sensor)},
          {"frequencies_hz", c.frequencies_hz},
          {"max_range_m", c.max_range_m}};
}

ordered_json calibration_json(const Waveforms& frames) {
  const WaveformCalibration& c = frames.calibration;
  return {{"device", "waveform"},
          {"sensor", sensor_json(c.sensor)},
          {"sample_interval_s", c.sample_interval_s},
          {"window_start_s", c.window_start_s},
          {"pulse_sigma_s", c.pulse_sigma_s},
          {"range_walk_s", c.range_walk_s},
          {"range_walk_electrons", c.range_walk_electrons},
          {"gated", !frames.first_sample.empty()},
          {"moving", !frames.scanner_from_ray.empty()},
          {"rows", frames.grid.rows},
          {"columns", frames.grid.columns}};
}

}  // namespace scan
