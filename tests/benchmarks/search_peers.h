// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// nanoflann and FLANN over floats, leaves of ten, as their manuals show them: with results in
// arrays that are made once.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <flann/flann.hpp>
#include <memory>
#include <nanoflann.hpp>
#include <span>
#include <vector>

namespace scan {

class Nanoflann {
 public:
  explicit Nanoflann(std::span<const Eigen::Vector3d> points) {
    for (const auto& point : points) cloud_.points.push_back(point.cast<float>());
    tree_ = std::make_unique<Tree>(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    tree_->buildIndex();
  }
  // Sums of distances: the checksums of the benchmark.
  double nearest(const Eigen::Vector3d& query, std::size_t k) const {
    const Eigen::Vector3f at = query.cast<float>();
    std::array<std::uint32_t, 10> index;
    std::array<float, 10> distance2;
    const std::size_t found = tree_->knnSearch(at.data(), k, index.data(), distance2.data());
    double sum = 0;
    for (std::size_t i = 0; i < found; ++i) sum += std::sqrt(distance2[i]);
    return sum;
  }
  double within(const Eigen::Vector3d& query, double radius_m) {
    const Eigen::Vector3f at = query.cast<float>();
    tree_->radiusSearch(at.data(), static_cast<float>(radius_m * radius_m), found_, {});
    double sum = 0;
    for (const auto& [index, distance2] : found_) sum += std::sqrt(distance2);
    return sum;
  }

 private:
  struct Cloud {
    std::vector<Eigen::Vector3f> points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return points[i][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Metric = nanoflann::L2_Simple_Adaptor<float, Cloud>;
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, 3, std::uint32_t>;
  Cloud cloud_;
  std::unique_ptr<Tree> tree_;
  std::vector<std::pair<std::uint32_t, float>> found_;
};

class Flann {
 public:
  explicit Flann(std::span<const Eigen::Vector3d> points) {
    for (const auto& point : points) points_.push_back(point.cast<float>());
    const flann::Matrix<float> rows(points_.front().data(), points_.size(), 3);
    tree_ = std::make_unique<Tree>(rows, flann::KDTreeSingleIndexParams(10));
    tree_->buildIndex();
  }
  double nearest(const Eigen::Vector3d& query, std::size_t k) {
    Eigen::Vector3f at = query.cast<float>();
    std::array<std::size_t, 10> index;
    std::array<float, 10> distance2;
    flann::Matrix<std::size_t> indices(index.data(), 1, k);
    flann::Matrix<float> distances2(distance2.data(), 1, k);
    tree_->knnSearch(flann::Matrix<float>(at.data(), 1, 3), indices, distances2, k,
                     flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    double sum = 0;
    for (std::size_t i = 0; i < k; ++i) sum += std::sqrt(distance2[i]);
    return sum;
  }
  double within(const Eigen::Vector3d& query, double radius_m) {
    Eigen::Vector3f at = query.cast<float>();
    tree_->radiusSearch(flann::Matrix<float>(at.data(), 1, 3), indices_, distances2_,
                        static_cast<float>(radius_m * radius_m),
                        flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    double sum = 0;
    for (const float distance2 : distances2_[0]) sum += std::sqrt(distance2);
    return sum;
  }

 private:
  using Tree = flann::KDTreeSingleIndex<flann::L2_Simple<float>>;
  std::vector<Eigen::Vector3f> points_;
  std::unique_ptr<Tree> tree_;
  std::vector<std::vector<std::size_t>> indices_;
  std::vector<std::vector<float>> distances2_;
};

}  // namespace scan
