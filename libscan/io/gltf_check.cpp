// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/gltf_check.h"

#include <bit>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/byte_order.h"
#include "libscan/io/json_reader.h"

namespace scan {
namespace {

using nlohmann::json;

class Checker {
 public:
  explicit Checker(const std::filesystem::path& path) : path_(path) {}

  void check() {
    parse();
    if (!document_.is_object() || !document_.contains("asset")) fail("is not glTF (no 'asset')");
    if (document_.contains("extensionsRequired") && !document_["extensionsRequired"].empty())
      fail("needs extension " + document_["extensionsRequired"].dump());
    for (const json& buffer : list("buffers")) check_buffer(buffer);
    for (const json& view : list("bufferViews")) check_view(view);
    for (const json& accessor : list("accessors")) check_accessor(accessor);
    for (const json& mesh : list("meshes")) check_mesh(mesh);
    check_nodes();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Trouble::input, path_.string() + ": glTF: " + what);
  }

  // A .glb holds a JSON chunk and perhaps a binary one behind a header of 12 bytes.
  void parse() {
    const std::string bytes = read_file(path_);
    std::string_view text = bytes;
    if (text.substr(0, 4) == "glTF") {
      const auto u32 = [&](std::size_t at) {
        return load<std::uint32_t>(bytes.data() + at, std::endian::little);
      };
      if (bytes.size() < 20 || u32(8) != bytes.size() || u32(12) > bytes.size() - 20)
        fail("the lengths of the GLB container are wrong");
      const std::size_t chunk = 20 + std::size_t{u32(12)};
      text = text.substr(20, u32(12));
      if (chunk + 8 <= bytes.size()) {
        binary_bytes_ = u32(chunk);
        if (*binary_bytes_ > bytes.size() - chunk - 8) fail("the binary chunk ends early");
      }
    }
    document_ = parse_json(text, path_.string());
  }

  const json& list(const char* key) const {
    static const json nothing = json::array();
    const auto found = document_.find(key);
    if (found == document_.end()) return nothing;
    if (!found->is_array()) fail(std::string(key) + " is no list");
    for (const json& entry : *found)
      if (!entry.is_object()) fail(std::string(key) + " holds something else than objects");
    return *found;
  }

  std::uint64_t whole(const json& object, const char* key,
                      std::optional<std::uint64_t> otherwise) const {
    const auto found = object.find(key);
    if (found == object.end() && otherwise) return *otherwise;
    if (found == object.end() || !found->is_number_unsigned() ||
        found->get<std::uint64_t>() > std::uint64_t{1} << 40)
      fail(std::string(key) + " must be a whole number from 0");
    return found->get<std::uint64_t>();
  }

  void check_index(const json& object, const char* key, std::size_t limit, bool required) const {
    if (!required && !object.contains(key)) return;
    if (whole(object, key, std::nullopt) >= limit)
      fail(std::string(key) + " is " + object[key].dump() + ", there are " + std::to_string(limit));
  }

  void check_buffer(const json& buffer) {
    const std::uint64_t bytes = whole(buffer, "byteLength", std::nullopt);
    std::uint64_t available = binary_bytes_.value_or(0);
    if (buffer.contains("uri")) {
      if (!buffer["uri"].is_string()) fail("uri must be a text");
      const auto& uri = buffer["uri"].get_ref<const std::string&>();
      const std::size_t comma = uri.find(',');
      std::error_code error;
      if (!uri.starts_with("data:"))
        available = std::filesystem::file_size(path_.parent_path() / uri, error);
      else if (comma == std::string::npos ||
               uri.substr(0, comma).find("base64") == std::string::npos)
        fail("a data: uri must be base64");
      else
        available = (uri.size() - comma - 1) / 4 * 3;
      if (error) fail("buffer '" + uri.substr(0, 80) + "' cannot be read");
    }
    if (bytes > available)
      fail("a buffer of " + std::to_string(bytes) + " bytes, there are " +
           std::to_string(available));
  }

  void check_view(const json& view) const {
    const json& buffers = list("buffers");
    check_index(view, "buffer", buffers.size(), true);
    const std::uint64_t end =
        whole(view, "byteOffset", 0) + whole(view, "byteLength", std::nullopt);
    if (whole(view, "byteStride", 0) > 252) fail("byteStride is over 252");
    if (end > whole(buffers[view["buffer"].get<std::size_t>()], "byteLength", std::nullopt))
      fail("a bufferView ends behind its buffer");
  }

  void check_accessor(const json& accessor) const {
    static const std::map<std::uint64_t, std::uint64_t> sizes = {{5120, 1}, {5121, 1}, {5122, 2},
                                                                 {5123, 2}, {5125, 4}, {5126, 4}};
    static const std::map<std::string, std::uint64_t> parts = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
        {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const json& views = list("bufferViews");
    check_index(accessor, "bufferView", views.size(), true);
    if (accessor.contains("sparse")) fail("sparse accessors are not understood");
    const auto size = sizes.find(whole(accessor, "componentType", std::nullopt));
    const auto type = accessor.find("type");
    if (size == sizes.end() || type == accessor.end() || !type->is_string() ||
        !parts.contains(type->get<std::string>()))
      fail("an accessor of unknown type");
    const json& view = views[accessor["bufferView"].get<std::size_t>()];
    const std::uint64_t entry = size->second * parts.at(type->get<std::string>());
    const std::uint64_t stride = whole(view, "byteStride", 0);
    const std::uint64_t step = stride == 0 ? entry : stride;
    const std::uint64_t count = whole(accessor, "count", std::nullopt);
    const std::uint64_t bytes = count == 0 ? 0 : step * (count - 1) + entry;
    if (count == 0 || step < entry ||
        whole(accessor, "byteOffset", 0) + bytes > whole(view, "byteLength", std::nullopt))
      fail("an accessor of " + std::to_string(count) + " entries does not fit its bufferView");
  }

  void check_mesh(const json& mesh) const {
    if (!mesh.contains("primitives") || !mesh["primitives"].is_array())
      fail("a mesh without primitives");
    const std::size_t accessors = list("accessors").size();
    for (const json& primitive : mesh["primitives"]) {
      if (!primitive.is_object() || !primitive.contains("attributes") ||
          !primitive["attributes"].is_object())
        fail("a primitive without attributes");
      check_index(primitive, "indices", accessors, false);
      check_index(primitive, "material", list("materials").size(), false);
      if (whole(primitive, "mode", 4) > 6) fail("mode is over 6");
      if (primitive.contains("targets")) fail("morph targets are not understood");
      check_positions(primitive["attributes"], accessors);
    }
  }

  void check_positions(const json& attributes, std::size_t accessors) const {
    std::optional<std::uint64_t> count;
    for (const auto& [name, index] : attributes.items()) {
      check_index(attributes, name.c_str(), accessors, true);
      const json& accessor = list("accessors")[index.get<std::size_t>()];
      if (count && whole(accessor, "count", std::nullopt) != *count)
        fail("the attributes of a primitive differ in count");
      count = whole(accessor, "count", std::nullopt);
      if (name == "POSITION" && (accessor["type"] != "VEC3" || accessor["componentType"] != 5126))
        fail("POSITION must be VEC3 of floats");
    }
    if (!attributes.contains("POSITION")) fail("a primitive without POSITION");
  }

  // Each node has at most one parent and no node is its own ancestor: the scene is a forest.
  void check_nodes() const {
    const json& nodes = list("nodes");
    std::vector<char> has_parent(nodes.size(), 0);
    for (const json& node : nodes) {
      check_index(node, "mesh", list("meshes").size(), false);
      if (!node.contains("children")) continue;
      if (!node["children"].is_array()) fail("children is no list");
      for (const json& child : node["children"]) {
        if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size())
          fail("a node names child " + child.dump() + ", there are " +
               std::to_string(nodes.size()));
        if (std::exchange(has_parent[child.get<std::size_t>()], 1)) fail("a node has two parents");
      }
    }
    check_acyclic(nodes, has_parent);
  }

  void check_acyclic(const json& nodes, const std::vector<char>& has_parent) const {
    std::vector<std::pair<std::size_t, int>> open;  // node and its depth
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!has_parent[i]) open.emplace_back(i, 0);
    std::size_t reached = 0;
    while (!open.empty()) {
      const auto [node, depth] = open.back();
      open.pop_back();
      ++reached;
      if (depth > 500) fail("nodes are nested deeper than 500");
      if (!nodes[node].contains("children")) continue;
      for (const json& child : nodes[node]["children"])
        open.emplace_back(child.get<std::size_t>(), depth + 1);
    }
    if (reached != nodes.size()) fail("a node is its own ancestor");
  }

  const std::filesystem::path& path_;
  json document_;
  std::optional<std::uint64_t> binary_bytes_;
};

}  // namespace

void check_gltf(const std::filesystem::path& path) {
  try {
    Checker(path).check();
  } catch (const json::exception& error) {
    throw Error(Trouble::input, path.string() + ": glTF: " + error.what());
  }
}

}  // namespace scan
