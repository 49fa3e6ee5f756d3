// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/mesh_text.h"

#include <optional>

#include "libscan/core/error.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

// A text file by lines, with what a message needs.
class MeshLines {
 public:
  MeshLines(std::string_view text, const std::string& name) : lines_(text), name_(name) {}

  // The next line that is neither empty nor a comment.
  std::optional<std::string_view> next() {
    while (const auto line = lines_.next()) {
      const std::string_view content = line->substr(0, line->find('#'));
      std::string_view words = content;
      if (!take_word(words).empty()) return content;
    }
    return std::nullopt;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Trouble::input, name_ + ": line " + std::to_string(lines_.number()) + ": " + what);
  }

  std::string_view require(const std::string& what) {
    const auto line = next();
    if (!line) fail("the file ends where " + what + " should be");
    return *line;
  }

  template <int Count>
  Eigen::Matrix<double, Count, 1> numbers(std::string_view words) const {
    Eigen::Matrix<double, Count, 1> x;
    for (double& coordinate : x) {
      const std::string_view word = take_word(words);
      const auto number = number_from<double>(word);
      if (!number || !std::isfinite(*number))
        fail("'" + std::string(word.substr(0, 40)) + "' is no coordinate");
      coordinate = *number;
    }
    return x;
  }

  template <class Whole>
  Whole whole(std::string_view word, const char* what) const {
    const auto number = number_from<Whole>(word);
    if (!number) fail("'" + std::string(word.substr(0, 40)) + "' is no " + what);
    return *number;
  }

 private:
  Lines lines_;
  const std::string& name_;
};

void append_fan(Mesh& mesh, const std::vector<std::uint32_t>& corners) {
  for (std::size_t k = 2; k < corners.size(); ++k)
    mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

// OBJ counts from 1, or backwards from -1, the one read last.
std::uint32_t obj_index(const MeshLines& lines, std::string_view word, std::size_t listed,
                        const char* what) {
  const long index = lines.whole<long>(word, what);
  const long count = static_cast<long>(listed);
  const long from_zero = index < 0 && index >= -count ? count + index : index - 1;
  if (from_zero < 0 || from_zero >= count)
    lines.fail(std::string(what) + " " + std::to_string(index) + ", there are " +
               std::to_string(listed));
  return static_cast<std::uint32_t>(from_zero);
}

// An OBJ as far as it is read.
class ObjReader {
 public:
  explicit ObjReader(MeshLines& lines) : lines_(lines) {}

  void read_face(std::string_view words) {
    std::vector<std::uint32_t> corners;
    std::vector<Eigen::Vector2d> places;
    for (auto word = take_word(words); !word.empty(); word = take_word(words)) {
      const std::size_t slash = std::min(word.find('/'), word.size());
      corners.push_back(
          obj_index(lines_, word.substr(0, slash), result_.mesh.vertices.size(), "vertex"));
      std::string_view place = word.substr(std::min(slash + 1, word.size()));
      place = place.substr(0, place.find('/'));
      if (!place.empty())
        places.push_back(places_[obj_index(lines_, place, places_.size(), "texture coordinate")]);
    }
    if (corners.size() < 3) lines_.fail("a face has fewer than three corners");
    append_fan(result_.mesh, corners);
    is_textured_ = is_textured_ && places.size() == corners.size();
    for (std::size_t k = 2; is_textured_ && k < places.size(); ++k)
      result_.corners.push_back({places[0], places[k - 1], places[k]});
  }
  void read_vertex(std::string_view words) {
    result_.mesh.vertices.push_back(lines_.numbers<3>(words));
  }
  // OBJ counts upwards from the picture's lower edge.
  void read_place(std::string_view words) {
    const Eigen::Vector2d place = lines_.numbers<2>(words);
    places_.emplace_back(place.x(), 1 - place.y());
  }
  TexturedMesh take() {
    if (!is_textured_) result_.corners.clear();
    return std::move(result_);
  }

 private:
  MeshLines& lines_;
  std::vector<Eigen::Vector2d> places_;
  bool is_textured_ = true;
  TexturedMesh result_;
};

// Joins lines that end in a backslash with the next one.
std::string without_continuations(std::string_view text) {
  std::string joined;
  joined.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_end = text.substr(i, 2) == "\\\n" || text.substr(i, 3) == "\\\r\n";
    if (!is_end) {
      joined += text[i];
      continue;
    }
    joined += ' ';
    i += text[i + 1] == '\r' ? 2 : 1;
  }
  return joined;
}

void read_off_faces(MeshLines& lines, std::size_t faces, Mesh& mesh) {
  for (std::size_t i = 0; i < faces; ++i) {
    std::string_view words = lines.require("face " + std::to_string(i));
    const auto count = lines.whole<std::uint32_t>(take_word(words), "number of corners");
    if (count > words.size())
      lines.fail("the line ends before its " + std::to_string(count) + " corners");
    std::vector<std::uint32_t> corners;
    for (std::uint32_t k = 0; k < count; ++k) {
      const auto corner = lines.whole<std::uint32_t>(take_word(words), "vertex");
      if (corner >= mesh.vertices.size())
        lines.fail("vertex " + std::to_string(corner) + ", there are " +
                   std::to_string(mesh.vertices.size()));
      corners.push_back(corner);
    }
    append_fan(mesh, corners);
  }
}

}  // namespace

TexturedMesh parse_obj(std::string_view text, const std::string& name) {
  const std::string joined = without_continuations(text);
  MeshLines lines(joined, name);
  ObjReader reader(lines);
  while (auto words = lines.next()) {
    const std::string_view keyword = take_word(*words);
    if (keyword == "v") reader.read_vertex(*words);
    if (keyword == "vt") reader.read_place(*words);
    if (keyword == "f") reader.read_face(*words);
  }
  return reader.take();
}

// Colours, normals and texture (COFF, NOFF, STOFF) stand behind the coordinates and are left out.
Mesh parse_off(std::string_view text, const std::string& name) {
  MeshLines lines(text, name);
  std::string_view words = lines.require("'OFF'");
  const std::size_t keyword_at = words.find("OFF");
  const std::string_view prefix = words.substr(0, keyword_at);
  if (keyword_at == std::string_view::npos ||
      prefix.find_first_not_of(" STCN") != std::string_view::npos)
    lines.fail("is not an OFF file (its first line is not 'OFF')");
  words.remove_prefix(keyword_at + 3);  // some writers put the counts right behind
  std::string_view first = words;
  if (take_word(first).empty()) words = lines.require("the counts");
  first = words;
  if (take_word(first) == "BINARY") lines.fail("binary OFF is not understood");
  const auto vertices = lines.whole<std::uint32_t>(take_word(words), "count of vertices");
  const auto faces = lines.whole<std::uint32_t>(take_word(words), "count of faces");
  Mesh mesh;
  for (std::uint32_t i = 0; i < vertices; ++i)
    mesh.vertices.push_back(lines.numbers<3>(lines.require("vertex " + std::to_string(i))));
  read_off_faces(lines, faces, mesh);
  if (lines.next()) lines.fail("data behind the last face that the header promises");
  return mesh;
}

std::string obj_text(const Mesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    text += 'v';
    for (const double x : v) append_number(text += ' ', x);
    text += '\n';
  }
  for_each_polygon(mesh, [&](std::span<const std::uint32_t> corners) {
    text += 'f';
    for (const std::uint32_t corner : corners)
      append_number(text += ' ', std::uint64_t{corner} + 1);
    text += '\n';
  });
  return text;
}

std::string off_text(const Mesh& mesh) {
  std::string text = "OFF\n" + std::to_string(mesh.vertices.size()) + " " +
                     std::to_string(mesh.triangles.size() - mesh.quads) + " 0\n";
  for (const Eigen::Vector3d& v : mesh.vertices) {
    for (const double x : v) append_number(text, x), text += ' ';
    text.back() = '\n';
  }
  for_each_polygon(mesh, [&](std::span<const std::uint32_t> corners) {
    append_number(text, std::uint64_t{corners.size()});
    for (const std::uint32_t corner : corners) append_number(text += ' ', corner);
    text += '\n';
  });
  return text;
}

}  // namespace scan
