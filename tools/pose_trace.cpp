// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_trace.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace scan {
namespace {

// How a scan hangs on the one before it in the tree.
struct Link {
  std::size_t parent = 0, child = 0;
  const ScanEdge* edge = nullptr;
};

// Parents come before their children.
std::vector<Link> tree_of(std::span<const ScanEdge> edges, std::size_t scans, std::size_t anchor) {
  std::vector<Link> links;
  std::vector<bool> reached(scans, false);
  std::vector<std::size_t> queue = {anchor};
  reached[anchor] = true;
  for (std::size_t next = 0; next < queue.size(); ++next)
    for (const ScanEdge& edge : edges) {
      const std::size_t from = queue[next];
      if (!edge.accepted || edge.path.empty() || (edge.source != from && edge.target != from))
        continue;
      const std::size_t to = edge.source == from ? edge.target : edge.source;
      if (reached[to]) continue;
      reached[to] = true;
      queue.push_back(to);
      links.push_back({from, to, &edge});
    }
  return links;
}

std::vector<Pose> chained(std::vector<Pose> poses, std::span<const Link> links,
                          std::size_t iteration) {
  for (const Link& link : links) {
    const std::vector<Pose>& path = link.edge->path;
    const Pose& target_from_source = path[std::min(iteration, path.size() - 1)];
    poses[link.child] = link.edge->source == link.child
                            ? poses[link.parent] * target_from_source
                            : poses[link.parent] * target_from_source.inverse();
  }
  return poses;
}

// `count` of the numbers 0 to `size` - 1, evenly, the first and the last among them.
std::vector<std::size_t> evenly(std::size_t size, std::size_t count) {
  std::vector<std::size_t> chosen;
  if (size <= std::max<std::size_t>(2, count)) count = size;
  for (std::size_t k = 0; k < count; ++k)
    chosen.push_back(count == 1 ? size - 1 : k * (size - 1) / (count - 1));
  return chosen;
}

}  // namespace

std::vector<PoseStep> pose_steps(std::span<const Pose> guesses, std::span<const ScanEdge> edges,
                                 const std::vector<std::vector<Pose>>& joint, std::size_t anchor,
                                 std::size_t most_steps) {
  const std::vector<Pose> start(guesses.begin(), guesses.end());
  const std::vector<Link> links = tree_of(edges, start.size(), anchor);
  std::size_t iterations = 0;
  for (const Link& link : links) iterations = std::max(iterations, link.edge->path.size() - 1);
  const std::size_t of_pairs = std::min(iterations, std::max<std::size_t>(2, most_steps / 2));
  std::vector<PoseStep> steps = {{"guess", start}};
  for (const std::size_t k : evenly(iterations, of_pairs))
    steps.push_back({"pairs " + std::to_string(k + 1), chained(start, links, k + 1)});
  const std::size_t left = most_steps > steps.size() ? most_steps - steps.size() : 0;
  for (const std::size_t k : evenly(joint.size(), std::max<std::size_t>(2, left)))
    steps.push_back({"joint " + std::to_string(k), joint[k]});
  return steps;
}

nlohmann::ordered_json trace_json(std::span<const PoseStep> steps) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PoseStep& step : steps) {
    nlohmann::ordered_json poses = nlohmann::ordered_json::array();
    for (const Pose& pose : step.world_from_scan) {
      const Eigen::Vector3d at = pose.translation();
      const Eigen::Quaterniond turn(pose.linear());
      poses.push_back({at.x(), at.y(), at.z(), turn.x(), turn.y(), turn.z(), turn.w()});
    }
    list.push_back({{"step", step.step}, {"world_from_scan", poses}});
  }
  return {{"steps", list}};
}

std::vector<PoseStep> steps_from(const nlohmann::ordered_json& trace) {
  std::vector<PoseStep> steps;
  for (const auto& entry : trace.at("steps")) {
    PoseStep& step = steps.emplace_back();
    step.step = entry.at("step").get<std::string>();
    for (const auto& numbers : entry.at("world_from_scan")) {
      const auto v = numbers.get<std::array<double, 7>>();
      const Eigen::Quaterniond turn(v[6], v[3], v[4], v[5]);
      step.world_from_scan.push_back(
          make_pose(turn.normalized().toRotationMatrix(), {v[0], v[1], v[2]}));
    }
  }
  return steps;
}

}  // namespace scan
