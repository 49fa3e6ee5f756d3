// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/shape_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "libscan/io/poses.h"

namespace scan {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using Operation = CombinedShape::Operation;

const std::vector<std::string> shape_names = {"plane", "sphere", "cylinder",  "box",
                                              "torus", "unite",  "intersect", "subtract"};
constexpr int max_nesting = 32;

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // clang 14 does not deduce aggregates

Shape read_nested(JsonReader& reader, int depth);

PlacedShape read_part(JsonReader& part, int depth) {
  PlacedShape placed;
  placed.parent_from_shape =
      part.has("parent_from_shape")
          ? pose_from_json(part.value("parent_from_shape"), part.place() + "/parent_from_shape")
          : part.placement();
  JsonReader shape = part.object("shape");
  placed.shape = read_nested(shape, depth + 1);
  part.finish();
  return placed;
}

CombinedShape read_combined(JsonReader& sizes, Operation operation, int depth) {
  CombinedShape combined{operation, sizes.length_m("blend", 0), {}};
  for (JsonReader& part : sizes.objects("parts")) combined.parts.push_back(read_part(part, depth));
  return combined;
}

Shape read_kind(const std::string& kind, JsonReader& sizes, int depth) {
  if (kind == "plane") return PlaneShape{};
  if (kind == "sphere") return SphereShape{sizes.length_m("radius")};
  if (kind == "cylinder") return CylinderShape{sizes.length_m("radius"), sizes.length_m("height")};
  if (kind == "box") return BoxShape{sizes.vector_m("size"), sizes.length_m("rounding", 0)};
  if (kind == "torus")
    return TorusShape{sizes.length_m("major_radius"), sizes.length_m("minor_radius")};
  if (kind == "unite") return read_combined(sizes, Operation::unite, depth);
  if (kind == "intersect") return read_combined(sizes, Operation::intersect, depth);
  return read_combined(sizes, Operation::subtract, depth);
}

Shape read_nested(JsonReader& reader, int depth) {
  const auto keys = reader.keys();
  if (keys.size() != 1)
    throw Error(Trouble::input, reader.place() + ": a shape has one key, its kind; this has " +
                                    std::to_string(keys.size()));
  const std::string& kind = keys.front();
  if (std::find(shape_names.begin(), shape_names.end(), kind) == shape_names.end()) {
    const std::string near = nearest_word(kind, shape_names);
    throw Error(Trouble::input, reader.place() + "/" + kind + ": unknown shape",
                near.empty() ? "" : "did you mean '" + near + "'?");
  }
  if (depth > max_nesting)
    reader.fail(kind, "shapes are nested deeper than " + std::to_string(max_nesting));
  JsonReader sizes = reader.object(kind);
  Shape shape = read_kind(kind, sizes, depth);
  sizes.finish();
  try {
    check(shape);
  } catch (const Error& error) {
    throw Error(error.trouble(), sizes.place() + ": " + error.what());
  }
  return shape;
}

const char* name_of(Operation operation) {
  switch (operation) {
    case Operation::unite:
      return "unite";
    case Operation::intersect:
      return "intersect";
    case Operation::subtract:
      break;
  }
  return "subtract";
}

ordered_json combined_to_json(const CombinedShape& combined) {
  ordered_json parts = ordered_json::array();
  for (const PlacedShape& part : combined.parts) parts.push_back(to_json(part));
  return {{name_of(combined.operation), {{"blend_m", combined.blend_m}, {"parts", parts}}}};
}

}  // namespace

Shape read_shape(JsonReader& reader) {
  return read_nested(reader, 0);
}

PlacedShape read_placed_shape(JsonReader& reader) {
  return read_part(reader, 0);
}

ordered_json to_json(const PlacedShape& placed) {
  return {{"shape", to_json(placed.shape)},
          {"parent_from_shape", to_json(placed.parent_from_shape)}};
}

ordered_json to_json(const Shape& shape) {
  return std::visit(
      Overloaded{
          [](const PlaneShape&) -> ordered_json {
            return {{"plane", ordered_json::object()}};
          },
          [](const SphereShape& s) -> ordered_json {
            return {{"sphere", {{"radius_m", s.radius_m}}}};
          },
          [](const CylinderShape& c) -> ordered_json {
            return {{"cylinder", {{"radius_m", c.radius_m}, {"height_m", c.height_m}}}};
          },
          [](const BoxShape& b) -> ordered_json {
            return {{"box",
                     {{"size_m", {b.size_m.x(), b.size_m.y(), b.size_m.z()}},
                      {"rounding_m", b.rounding_m}}}};
          },
          [](const TorusShape& t) -> ordered_json {
            return {{"torus",
                     {{"major_radius_m", t.major_radius_m}, {"minor_radius_m", t.minor_radius_m}}}};
          },
          [](const CombinedShape& c) { return combined_to_json(c); }},
      shape);
}

ordered_json to_json(const Pose& pose) {
  ordered_json matrix = ordered_json::array();
  for (int row = 0; row < 4; ++row)
    matrix.push_back({pose(row, 0), pose(row, 1), pose(row, 2), pose(row, 3)});
  return matrix;
}

Pose pose_from_json(const json& matrix, const std::string& place) {
  const auto fail = [&](const std::string& what) {
    throw Error(Trouble::input, place + ": " + what);
  };
  if (!matrix.is_array() || matrix.size() != 4) fail("must be a 4x4 matrix, four rows of numbers");
  Eigen::Matrix4d m;
  for (int row = 0; row < 4; ++row) {
    const json& numbers = matrix[static_cast<std::size_t>(row)];
    if (!numbers.is_array() || numbers.size() != 4)
      fail("row " + std::to_string(row) + " must have four numbers");
    for (int column = 0; column < 4; ++column) {
      const json& number = numbers[static_cast<std::size_t>(column)];
      if (!number.is_number() || !std::isfinite(number.get<double>()))
        fail("row " + std::to_string(row) + ", column " + std::to_string(column) +
             " must be a finite number");
      m(row, column) = number.get<double>();
    }
  }
  return pose_from_matrix(m, place);
}

}  // namespace scan
