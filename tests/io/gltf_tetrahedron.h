// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A small glTF file, in its two forms.
#pragma once

#include <bit>
#include <string>

#include "libscan/io/byte_order.h"

namespace scan {

// A tetrahedron whose faces carry their own copies of the corners, as exporters write it, in a node
// that is moved by (10, 0, 0).
inline std::string gltf_buffer() {
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string bytes;
  for (const auto& face : faces)
    for (const int corner : face)
      for (const float x : corners[corner]) store(bytes, x, std::endian::little);
  for (std::uint16_t i = 0; i < 12; ++i) store(bytes, i, std::endian::little);
  return bytes;
}

inline std::string gltf_document(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
         R"("nodes":[{"children":[1],"translation":[10,0,0]},{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":12,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
         R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":144},{"buffer":0,"byteOffset":144,"byteLength":24}],)"
         R"("buffers":[{)" +
         uri + R"("byteLength":168}]})";
}

inline std::string glb() {
  std::string json = gltf_document("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string binary = gltf_buffer();
  std::string bytes = "glTF";
  const auto put = [&](std::size_t number) {
    store(bytes, static_cast<std::uint32_t>(number), std::endian::little);
  };
  put(2), put(12 + 8 + json.size() + 8 + binary.size());
  put(json.size()), bytes += "JSON" + json;
  put(binary.size()), bytes += std::string("BIN\0", 4) + binary;
  return bytes;
}

}  // namespace scan
