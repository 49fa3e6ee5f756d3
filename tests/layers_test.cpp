// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The layers, read off the include lines: dependencies point one way, estimators are blind to the
// truth, foreign libraries stay out of public headers. The test names file and line of a breach.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

bool starts_with_any(const std::string& text, const Names& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& prefix) { return text.starts_with(prefix); });
}

// What a folder may include of ours, as prefixes of the include path. README's layer table in code.
struct Layer {
  std::string folder;
  Names may_include;
};

const std::vector<Layer>& layers() {
  static const std::vector<Layer> all = {
      {"libscan/core/", {"libscan/core/"}},
      {"libscan/search/", {"libscan/search/", "libscan/core/"}},
      {"libscan/acquire/", {"libscan/acquire/", "libscan/core/", "libscan/search/"}},
      {"libscan/align/", {"libscan/align/", "libscan/core/", "libscan/search/"}},
      {"libscan/reconstruct/", {"libscan/reconstruct/", "libscan/core/", "libscan/search/"}},
      {"libscan/verify/", {"libscan/verify/", "libscan/core/", "libscan/search/"}},
      {"libscan/io/", {"libscan/"}},
      {"synth/", {"synth/", "libscan/core/", "libscan/search/", "libscan/verify/truth.h"}},
      {"tools/", {"tools/", "libscan/", "synth/"}},
      {"tests/", {"tests/", "tools/", "libscan/", "synth/"}},
  };
  return all;
}

const Names estimators = {"libscan/acquire/", "libscan/align/", "libscan/reconstruct/"};

const Names foreign_headers = {"pcl/",    "CGAL/",       "opencv",      "ceres/",
                               "flann/",  "embree",      "assimp/",     "tbb/",
                               "oneapi/", "Eigen/Dense", "Eigen/Sparse"};
// Of Eigen's sparse part only the matrix itself: it is a type as Core's are.
const std::string sparse_matrix = "Eigen/SparseCore";

const Layer* layer_of(const std::string& file) {
  for (const Layer& layer : layers())
    if (file.starts_with(layer.folder)) return &layer;
  return nullptr;
}

bool is_public_header(const std::string& file) {
  return file.ends_with(".h") && starts_with_any(file, {"libscan/", "synth/"});
}

// Code without comments and text literals, so that a word in prose is no breach. Include lines keep
// their quoted path.
std::string code_of(const std::string& line) {
  static const std::regex literal(R"re("(\\.|[^"\\])*")re"), comment("//.*");
  if (line.find("#include") != std::string::npos) return std::regex_replace(line, comment, "");
  return std::regex_replace(std::regex_replace(line, literal, ""), comment, "");
}

std::optional<std::string> breach_of_include(const std::string& file, const std::string& line) {
  static const std::regex include(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  std::smatch match;
  if (!std::regex_search(line, match, include)) return std::nullopt;
  const std::string path = match[2];
  if (is_public_header(file) && starts_with_any(path, foreign_headers) && path != sparse_matrix)
    return "public header includes " + path;
  if (match[1] == "<") return std::nullopt;
  const Layer* layer = layer_of(file);
  if (layer == nullptr) return "belongs to no layer";
  if (!starts_with_any(path, layer->may_include))
    return layer->folder + " must not include " + path;
  return std::nullopt;
}

std::optional<std::string> breach_of_blindness(const std::string& file, const std::string& line) {
  static const std::regex truth(R"(\b(Truth|ScanTruth|RayTruth|TrueSurface)\b)");
  if (starts_with_any(file, estimators) && std::regex_search(code_of(line), truth))
    return "an estimator names the truth";
  return std::nullopt;
}

// Every breach in one file, each as "file:line: what".
Names breaches(const std::string& file, const Names& lines) {
  Names found;
  const auto add = [&](std::size_t line, const std::string& what) {
    found.push_back(file + ":" + std::to_string(line) + ": " + what);
  };
  const Names head = {"// SPDX-FileCopyrightText: 2026 The libscan authors",
                      "// SPDX-License-Identifier: Apache-2.0"};
  for (std::size_t i = 0; i < head.size(); ++i)
    if (lines.size() <= i || lines[i] != head[i]) add(i + 1, "must read '" + head[i] + "'");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (const auto what = breach_of_include(file, lines[i])) add(i + 1, *what);
    if (const auto what = breach_of_blindness(file, lines[i])) add(i + 1, *what);
  }
  return found;
}

Names lines_of(const fs::path& path) {
  Names lines;
  std::ifstream stream(path);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// All sources below the repository's own folders, as paths relative to it.
Names sources() {
  Names files;
  const fs::path root = LIBSCAN_SOURCE_DIR;
  for (const char* folder : {"libscan", "synth", "tools", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension();
      if (extension == ".h" || extension == ".cpp")
        files.push_back(fs::relative(entry.path(), root).generic_string());
    }
  std::sort(files.begin(), files.end());
  return files;
}

Names with_head(const std::string& line) {
  return {"// SPDX-FileCopyrightText: 2026 The libscan authors",
          "// SPDX-License-Identifier: Apache-2.0", line};
}

TEST(Layers, AreKeptByEverySource) {
  const Names files = sources();
  ASSERT_GT(files.size(), 50u);
  for (const std::string& file : files)
    for (const std::string& breach : breaches(file, lines_of(fs::path(LIBSCAN_SOURCE_DIR) / file)))
      ADD_FAILURE() << breach;
}

TEST(Layers, CheckerSeesEachForbiddenEdge) {
  const std::vector<std::pair<std::string, std::string>> forbidden = {
      {"libscan/core/made_up.h", R"(#include "libscan/search/kd_tree.h")"},
      {"libscan/search/made_up.cpp", R"(#include "libscan/align/icp.h")"},
      {"libscan/align/made_up.cpp", R"(#include "libscan/verify/truth.h")"},
      {"libscan/align/made_up.cpp", R"(#include "libscan/acquire/normals.h")"},
      {"libscan/reconstruct/made_up.h", R"(#include "libscan/io/ply.h")"},
      {"libscan/verify/made_up.cpp", R"(  #  include "libscan/align/rigid_fit.h")"},
      {"libscan/verify/made_up.cpp", R"(#include "synth/scene.h")"},
      {"libscan/io/made_up.cpp", R"(#include "synth/scene.h")"},
      {"synth/made_up.cpp", R"(#include "libscan/io/ply.h")"},
      {"synth/made_up.cpp", R"(#include "libscan/verify/surface_error.h")"},
      {"synth/made_up.cpp", R"(#include "libscan/acquire/stereo.h")"},
      {"tools/made_up.cpp", R"(#include "tests/verify/figure.h")"},
      {"libscan/search/made_up.h", "#include <pcl/point_types.h>"},
      {"synth/made_up.h", "#include <embree3/rtcore.h>"},
      {"libscan/io/made_up.h", "#include <opencv2/core.hpp>"},
      {"libscan/align/made_up.cpp", "void peek(const Truth& truth);"},
      {"libscan/acquire/made_up.cpp", "scan::ScanTruth rays;"},
      {"elsewhere/made_up.cpp", R"(#include "libscan/core/mesh.h")"}};
  for (const auto& [file, line] : forbidden) {
    const Names found = breaches(file, with_head(line));
    ASSERT_EQ(found.size(), 1u) << file << " " << line;
    EXPECT_TRUE(found[0].starts_with(file + ":3: ")) << found[0];
  }
}

TEST(Layers, CheckerAllowsWhatIsMeant) {
  const std::vector<std::pair<std::string, std::string>> allowed = {
      {"libscan/align/made_up.cpp", R"(#include "libscan/search/kd_tree.h")"},
      {"libscan/search/made_up.cpp", "#include <pcl/point_types.h>"},
      {"libscan/io/made_up.cpp", R"(#include "libscan/align/icp.h")"},
      {"synth/made_up.h", R"(#include "libscan/verify/truth.h")"},
      {"tools/made_up.cpp", R"(#include "synth/scene.h")"},
      {"libscan/acquire/made_up.cpp", "// Truth is not known here"},
      {"libscan/acquire/made_up.cpp", R"(throw Error("Truth");)"}};
  for (const auto& [file, line] : allowed)
    EXPECT_EQ(breaches(file, with_head(line)), Names{}) << file << " " << line;
}

TEST(Layers, CheckerSeesAMissingHead) {
  EXPECT_EQ(breaches("libscan/core/made_up.h", {"#pragma once"}).size(), 2u);
}

}  // namespace
