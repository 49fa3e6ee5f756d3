// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/reconstruct_bodies.h"

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "libscan/io/scan_file.h"

namespace scan {
namespace {

namespace fs = std::filesystem;

Pose shifted(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

// A box 2 x 1.4 x 0.7 with a round boss, a through hole, an open slot and a narrow groove.
Shape csg_part() {
  const PlacedShape block{Pose::Identity(), BoxShape{{2, 1.4, 0.7}}};
  const PlacedShape boss{shifted(-0.5, 0, 0.45), CylinderShape{0.35, 0.5}};
  const PlacedShape hole{shifted(0.35, 0.1, 0), CylinderShape{0.3, 2}};
  const PlacedShape slot{shifted(1, -0.45, 0), BoxShape{{0.5, 0.2, 2}}};
  const PlacedShape groove{shifted(0, 0.6, 0.35), BoxShape{{3, 0.06, 0.2}}};
  using Operation = CombinedShape::Operation;
  const PlacedShape solid{Pose::Identity(), CombinedShape{Operation::unite, 0, {block, boss}}};
  return CombinedShape{Operation::subtract, 0, {solid, hole, slot, groove}};
}

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

// The holes' rims: for each vertex on one, the next along the missing face.
std::map<std::uint32_t, std::uint32_t> rims_of(const Mesh& mesh) {
  std::map<DirectedEdge, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, count] : edges)
    if (!edges.contains({edge.second, edge.first})) next[edge.second] = edge.first;
  return next;
}

void close_holes(Mesh& mesh) {
  auto next = rims_of(mesh);
  while (!next.empty()) {
    std::vector<std::uint32_t> loop;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (auto at = next.begin(); at != next.end(); at = next.find(at->second)) {
      if (!loop.empty() && at->first == loop.front()) break;
      loop.push_back(at->first);
      sum += mesh.vertices[at->first];
    }
    const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(sum / static_cast<double>(loop.size()));
    for (std::size_t i = 0; i < loop.size(); ++i)
      mesh.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
    for (const std::uint32_t v : loop) next.erase(v);
  }
}

void smooth_once(Mesh& mesh, const std::vector<std::set<std::uint32_t>>& around) {
  std::vector<Eigen::Vector3d> moved = mesh.vertices;
  for (std::size_t v = 0; v < around.size(); ++v) {
    if (around[v].empty()) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::uint32_t w : around[v]) sum += mesh.vertices[w];
    moved[v] = (moved[v] + sum / static_cast<double>(around[v].size())) / 2;
  }
  mesh.vertices = std::move(moved);
}

// Of each vertex; none of those on a rim.
std::vector<std::set<std::uint32_t>> neighbours_of_inner(const Mesh& mesh) {
  std::vector<std::set<std::uint32_t>> around(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      around[t[k]].insert(t[(k + 1) % 3]);
      around[t[k]].insert(t[(k + 2) % 3]);
    }
  for (const auto& [from, to] : rims_of(mesh)) around[from] = around[to] = {};
  return around;
}

Mesh open_bunny(const fs::path& data) {
  return read_mesh(data / "stanford-bunny" / "reconstruction" / "bun_zipper.ply");
}

}  // namespace

Mesh closed_bunny(const fs::path& data) {
  Mesh mesh = open_bunny(data);
  close_holes(mesh);
  return mesh;
}

Mesh smooth_bunny(const fs::path& data) {
  Mesh mesh = open_bunny(data);
  const auto around = neighbours_of_inner(mesh);
  for (int pass = 0; pass < 2; ++pass) smooth_once(mesh, around);
  close_holes(mesh);
  return mesh;
}

TrueSurface reconstruct_body(const std::string& name, const fs::path& data) {
  if (name == "sphere") return {{{Pose::Identity(), SphereShape{1}}}, {}};
  if (name == "torus") return {{{Pose::Identity(), TorusShape{1, 0.35}}}, {}};
  if (name == "csg") return {{{Pose::Identity(), csg_part()}}, {}};
  if (name == "plate") return {{{Pose::Identity(), BoxShape{{2, 2, 0.02}}}}, {}};
  if (name == "bunny") return {{}, {closed_bunny(data)}};
  if (name == "smooth-bunny") return {{}, {smooth_bunny(data)}};
  return {{}, {read_mesh(data / "reconbench" / "mesh" / (name + ".off"))}};
}

}  // namespace scan
