// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/poses.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/shape_json.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

constexpr double max_distance_from_rotation = 1e-6;  // of any entry
// A quaternion of any length means one rotation: few digits do no harm, a wrong column does.
constexpr double max_off_length = 5e-4;

struct Line {
  std::size_t number;
  std::vector<std::string_view> words;
};

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> all;
  Lines lines(text);
  while (const auto line = lines.next()) {
    std::string_view rest = line->substr(0, line->find('#'));
    Line& entry = all.emplace_back(Line{lines.number(), {}});
    for (auto word = take_word(rest, ","); !word.empty(); word = take_word(rest, ","))
      entry.words.push_back(word);
    if (entry.words.empty()) all.pop_back();
  }
  return all;
}

std::string place_of(const std::string& file, const Line& line) {
  return file + ": line " + std::to_string(line.number);
}

double number_at(const Line& line, std::size_t word, const std::string& file) {
  const auto number = number_from<double>(line.words[word]);
  if (!number || !std::isfinite(*number))
    throw Error(Trouble::input, place_of(file, line) + ", word " + std::to_string(word + 1) +
                                    ": '" + std::string(line.words[word].substr(0, 40)) +
                                    "' is not a finite number");
  return *number;
}

// Exact rotations stay as they are; what is a rotation to rounding only is put back on SO(3).
Eigen::Matrix3d rotation_near(const Eigen::Matrix3d& matrix, const std::string& place) {
  if (matrix.determinant() < 0)
    throw Error(Trouble::input, place + ": the 3x3 part is left-handed, it mirrors the scan");
  const Eigen::Matrix3d rotation = nearest_rotation(matrix);
  const double distance = (matrix - rotation).cwiseAbs().maxCoeff();
  if (!(distance <= max_distance_from_rotation))
    throw Error(Trouble::input, place + ": the 3x3 part is " + shortest(distance) +
                                    " away from a rotation, at most 1e-6");
  return distance < 1e-12 ? matrix : rotation;
}

Eigen::Matrix3d rotation_of(const std::array<double, 4>& q, const std::string& place) {
  const Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
  const double length = quaternion.norm();
  if (!(std::abs(length - 1) <= max_off_length))
    throw Error(Trouble::input, place + ": the quaternion's length is " + shortest(length) +
                                    ", must be 1 within 0.0005");
  return quaternion.normalized().toRotationMatrix();
}

NamedPose parse_tum(const Line& line, const std::string& file) {
  std::array<double, 8> v;
  for (std::size_t i = 1; i < 8; ++i) v[i] = number_at(line, i, file);
  const Eigen::Matrix3d rotation = rotation_of({v[4], v[5], v[6], v[7]}, place_of(file, line));
  return {std::string(line.words[0]), make_pose(rotation, {v[1], v[2], v[3]})};
}

NamedPose parse_kitti(const Line& line, std::size_t index, const std::string& file) {
  Eigen::Matrix<double, 3, 4> matrix;
  for (int i = 0; i < 12; ++i)
    matrix(i / 4, i % 4) = number_at(line, static_cast<std::size_t>(i), file);
  const Eigen::Matrix3d rotation = rotation_near(matrix.leftCols<3>(), place_of(file, line));
  return {std::to_string(index), make_pose(rotation, matrix.col(3))};
}

// A .xf (VripPack, trimesh2) and a .txt hold 4x4 matrices; a line of three whole numbers before a
// matrix (Redwood's .log) is its heading.
std::vector<NamedPose> parse_matrices(const std::vector<Line>& lines, const std::string& file) {
  std::vector<NamedPose> poses;
  for (std::size_t at = 0; at < lines.size();) {
    std::string name = std::to_string(poses.size());
    if (lines[at].words.size() == 3) name = lines[at++].words[0];
    Eigen::Matrix4d matrix;
    for (int row = 0; row < 4; ++row, ++at) {
      if (at == lines.size())
        throw Error(Trouble::input,
                    file + ": ends inside a 4x4 matrix, after row " + std::to_string(row));
      if (lines[at].words.size() != 4)
        throw Error(Trouble::input, place_of(file, lines[at]) + ": has " +
                                        std::to_string(lines[at].words.size()) +
                                        " numbers, a row of a 4x4 matrix has four");
      for (int column = 0; column < 4; ++column)
        matrix(row, column) = number_at(lines[at], static_cast<std::size_t>(column), file);
    }
    poses.push_back({name, pose_from_matrix(matrix, place_of(file, lines[at - 1]))});
  }
  return poses;
}

std::vector<NamedPose> parse_conf(const std::vector<Line>& lines, const std::string& file) {
  std::vector<NamedPose> poses;
  for (const Line& line : lines) {
    if (line.words[0] != "bmesh") continue;
    if (line.words.size() != 9)
      throw Error(Trouble::input, place_of(file, line) + ": has " +
                                      std::to_string(line.words.size()) +
                                      " words, must be 'bmesh FILE tx ty tz qx qy qz qw'");
    std::array<double, 7> v;
    for (std::size_t i = 0; i < 7; ++i) v[i] = number_at(line, i + 2, file);
    const Eigen::Matrix3d rotation = rotation_of({v[3], v[4], v[5], v[6]}, place_of(file, line));
    poses.push_back(
        {std::string(line.words[1]), make_pose(rotation.transpose(), {v[0], v[1], v[2]})});
  }
  return poses;
}

std::vector<NamedPose> parse_alignment(const std::filesystem::path& path) {
  const nlohmann::json document = read_json(path);
  JsonReader reader(document, path.string());
  std::vector<NamedPose> poses;
  for (JsonReader& entry : reader.objects("scans")) {
    const Pose pose =
        pose_from_json(entry.value("world_from_scan"), entry.place() + "/world_from_scan");
    poses.push_back({entry.text("file"), pose});
  }
  return poses;
}

std::vector<NamedPose> parse_lines(const std::vector<Line>& lines, const std::string& file) {
  const std::size_t words = lines.front().words.size();
  if (words == 3 || words == 4) return parse_matrices(lines, file);
  if (words != 8 && words != 12)
    throw Error(Trouble::input,
                place_of(file, lines.front()) + ": has " + std::to_string(words) +
                    " words; poses have 4 (rows of 4x4 matrices), 8 (TUM) or 12 (KITTI) a line");
  std::vector<NamedPose> poses;
  for (const Line& line : lines) {
    if (line.words.size() != words)
      throw Error(Trouble::input, place_of(file, line) + ": has " +
                                      std::to_string(line.words.size()) +
                                      " numbers, the lines before have " + std::to_string(words));
    poses.push_back(words == 8 ? parse_tum(line, file) : parse_kitti(line, poses.size(), file));
  }
  return poses;
}

std::string digits17(double number) {
  char buffer[40];
  const auto [end, error] =
      std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::general, 17);
  return {buffer, end};
}

}  // namespace

Pose pose_from_matrix(const Eigen::Matrix4d& matrix, const std::string& place) {
  if (!matrix.allFinite()) throw Error(Trouble::input, place + ": the matrix is not finite");
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() > 1e-9)
    throw Error(Trouble::input, place + ": the last row of the matrix must be 0 0 0 1");
  return make_pose(rotation_near(matrix.topLeftCorner<3, 3>(), place),
                   matrix.topRightCorner<3, 1>());
}

std::vector<NamedPose> read_poses(const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  std::vector<NamedPose> poses;
  if (ending == ".json") {
    poses = parse_alignment(path);
  } else {
    const std::string text = read_file(path);
    const std::vector<Line> lines = lines_of(text);
    const bool is_conf =
        !lines.empty() && (lines[0].words[0] == "bmesh" || lines[0].words[0] == "camera");
    if (!lines.empty())
      poses = ending == ".conf" || is_conf ? parse_conf(lines, path.string())
                                           : parse_lines(lines, path.string());
  }
  if (poses.empty()) throw Error(Trouble::input, path.string() + ": holds no pose");
  return poses;
}

void write_poses_tum(const std::filesystem::path& path, const std::vector<NamedPose>& poses) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool is_number = number_from<double>(poses[i].name).has_value();
    text += is_number ? poses[i].name : std::to_string(i);
    Eigen::Quaterniond q(poses[i].pose.linear());
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    for (const double x : poses[i].pose.translation()) text += " " + digits17(x);
    for (const double x : {q.x(), q.y(), q.z(), q.w()}) text += " " + digits17(x);
    text += '\n';
  }
  write_file(path, text);
}

void write_poses_kitti(const std::filesystem::path& path, const std::vector<NamedPose>& poses) {
  std::string text;
  for (const NamedPose& named : poses) {
    for (int i = 0; i < 12; ++i) text += digits17(named.pose(i / 4, i % 4)) + " ";
    text.back() = '\n';
  }
  write_file(path, text);
}

void write_matrix(const std::filesystem::path& path, const Pose& pose) {
  std::string text;
  for (int i = 0; i < 16; ++i) text += digits17(pose(i / 4, i % 4)) + (i % 4 == 3 ? "\n" : " ");
  write_file(path, text);
}

}  // namespace scan
