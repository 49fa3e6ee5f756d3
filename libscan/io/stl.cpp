// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// STL, text and binary: triangles without topology.
#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/mesh_text.h"
#include "libscan/io/text.h"
#include "libscan/io/welder.h"

namespace scan {
namespace {

constexpr std::size_t header_bytes = 80;
constexpr std::size_t triangle_bytes = 50;  // normal, three vertices, attribute

Mesh parse_binary(std::string_view bytes, std::size_t triangles, const std::string& name) {
  Welder welder;
  for (std::size_t i = 0; i < triangles; ++i) {
    const char* at = bytes.data() + header_bytes + 4 + i * triangle_bytes + 12;
    std::array<Eigen::Vector3d, 3> corners;
    for (auto& corner : corners)
      for (double& x : corner) {
        x = load<float>(at, std::endian::little);
        at += 4;
        if (!std::isfinite(x))
          throw Error(Trouble::input, name + ": triangle " + std::to_string(i) +
                                          " has a coordinate that is not finite");
      }
    welder.add(corners);
  }
  return welder.take();
}

Mesh parse_text(std::string_view text, const std::string& name) {
  Welder welder;
  Lines lines(text);
  std::array<Eigen::Vector3d, 3> corners;
  std::size_t corner = 0;
  const auto fail = [&](const std::string& what) {
    throw Error(Trouble::input, name + ": line " + std::to_string(lines.number()) + ": " + what);
  };
  while (auto words = lines.next()) {
    const std::string keyword = lower_case(take_word(*words));
    if (keyword == "vertex") {
      if (corner == 3) fail("a facet has more than three vertices");
      for (double& x : corners[corner]) {
        const auto number = number_from<double>(take_word(*words));
        if (!number || !std::isfinite(*number)) fail("a vertex must have three finite numbers");
        x = *number;
      }
      ++corner;
    } else if (keyword == "endfacet") {
      if (corner != 3) fail("a facet has fewer than three vertices");
      welder.add(corners);
      corner = 0;
    } else if (!keyword.empty() && keyword != "facet" && keyword != "outer" &&
               keyword != "endloop" && keyword != "solid" && keyword != "endsolid") {
      fail("unknown word '" + keyword.substr(0, 40) + "'");
    }
  }
  if (corner != 0) fail("the file ends inside a facet");
  return welder.take();
}

void store_vector(std::string& bytes, const Eigen::Vector3d& vector) {
  for (const double x : vector) {
    if (!(std::abs(x) <= std::numeric_limits<float>::max()))
      throw Error(Trouble::input,
                  "stl: coordinate " + shortest(x) + " is beyond the range of float");
    store(bytes, static_cast<float>(x), std::endian::little);
  }
}

}  // namespace

// Binary files may begin with "solid" too: only the size tells.
Mesh parse_stl(std::string_view bytes, const std::string& name) {
  if (bytes.size() >= header_bytes + 4) {
    const std::size_t triangles =
        load<std::uint32_t>(bytes.data() + header_bytes, std::endian::little);
    if (bytes.size() == header_bytes + 4 + triangles * triangle_bytes)
      return parse_binary(bytes, triangles, name);
  }
  std::string_view words = bytes.substr(0, 256);
  if (take_word(words, "\n") == "solid") return parse_text(bytes, name);
  throw Error(Trouble::input,
              name + ": is neither a text STL ('solid ...') nor a binary one (its " +
                  std::to_string(bytes.size()) + " bytes do not fit its count of triangles)");
}

std::string stl_bytes(const Mesh& mesh) {
  check(mesh);
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(Trouble::input, "stl: more than 2^32 - 1 triangles");
  std::string bytes = "libscan binary STL, metres";
  bytes.resize(header_bytes, ' ');
  store(bytes, static_cast<std::uint32_t>(mesh.triangles.size()), std::endian::little);
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d area = area_vector(mesh, triangle);
    store_vector(bytes, area.norm() > 0 ? area.normalized() : area);
    for (const std::uint32_t corner : triangle) store_vector(bytes, mesh.vertices[corner]);
    store(bytes, std::uint16_t{0}, std::endian::little);
  }
  return bytes;
}

}  // namespace scan
