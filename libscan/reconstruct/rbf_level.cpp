// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/rbf_level.h"

#include <algorithm>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::int64_t shift = 1024;  // of cells, so that places beside the cube have one too
constexpr std::size_t chunk = 256;

// x runs fastest, so that the cells of a row follow one another.
std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<std::uint64_t>(x + shift) | static_cast<std::uint64_t>(y + shift) << 21 |
         static_cast<std::uint64_t>(z + shift) << 42;
}

std::array<std::int64_t, 3> cell_at(const Eigen::Vector3d& x, double width) {
  return {static_cast<std::int64_t>(std::floor(x[0] / width)),
          static_cast<std::int64_t>(std::floor(x[1] / width)),
          static_cast<std::int64_t>(std::floor(x[2] / width))};
}

std::uint64_t key_at(const Eigen::Vector3d& x, double width) {
  const auto cell = cell_at(x, width);
  return key_of(cell[0], cell[1], cell[2]);
}

double dot(const std::vector<Jet>& a, const std::vector<Jet>& b) {
  return ordered_sum(a.size(), chunk, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
    return sum;
  });
}

// a += factor * b
void add(std::vector<Jet>& a, double factor, const std::vector<Jet>& b) {
  parallel_for(
      a.size(), [&](std::size_t i) { a[i] += factor * b[i]; }, chunk);
}

}  // namespace

RbfLevel::RbfLevel(double radius, std::vector<RbfNode> nodes)
    : radius_(radius), nodes_(std::move(nodes)), shares_(nodes_.size()) {
  std::stable_sort(nodes_.begin(), nodes_.end(), [&](const RbfNode& a, const RbfNode& b) {
    return key_at(a.place, radius_) < key_at(b.place, radius_);
  });
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const std::uint64_t key = key_at(nodes_[i].place, radius_);
    if (cells_.empty() || cells_.back() != key) {
      cells_.push_back(key);
      first_.push_back(i);
    }
  }
  first_.push_back(static_cast<std::uint32_t>(nodes_.size()));
}

// visit(node, offset over the radius, its square) for all nodes nearer than the radius.
template <class Visit>
void RbfLevel::for_nodes_about(const Eigen::Vector3d& x, Visit&& visit) const {
  const auto cell = cell_at(x, radius_);
  const double scale = 1 / radius_;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy) {
      const std::uint64_t low = key_of(cell[0] - 1, cell[1] + dy, cell[2] + dz);
      auto at = std::lower_bound(cells_.begin(), cells_.end(), low) - cells_.begin();
      for (; at < std::ssize(cells_) && cells_[at] <= low + 2; ++at)
        for (std::uint32_t i = first_[at]; i < first_[at + 1]; ++i) {
          const Eigen::Vector3d d = scale * (x - nodes_[i].place);
          const double d2 = d.squaredNorm();
          if (d2 < 1) visit(i, d, d2);
        }
    }
}

Jet RbfLevel::at(const Eigen::Vector3d& x) const {
  Jet sum;
  for_nodes_about(x, [&](std::uint32_t i, const Eigen::Vector3d& d, double d2) {
    sum += influence(shares_[i], d, d2);
  });
  sum.gradient /= radius_;
  return sum;
}

double RbfLevel::value(const Eigen::Vector3d& x) const {
  double sum = 0;
  for_nodes_about(x, [&](std::uint32_t i, const Eigen::Vector3d& d, double d2) {
    const Wendland w = wendland(d2);
    sum += shares_[i].value * w.value - w.slope * shares_[i].gradient.dot(d);
  });
  return sum;
}

void RbfLevel::find_neighbours() {
  std::vector<std::vector<std::uint32_t>> parts((nodes_.size() + chunk - 1) / chunk);
  first_neighbour_.assign(nodes_.size() + 1, 0);
  parallel_chunks(nodes_.size(), chunk, [&](std::size_t begin, std::size_t end) {
    auto& part = parts[begin / chunk];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t before = part.size();
      for_nodes_about(nodes_[i].place,
                      [&](std::uint32_t j, const Eigen::Vector3d&, double) { part.push_back(j); });
      first_neighbour_[i + 1] = part.size() - before;
    }
  });
  for (std::size_t i = 0; i < nodes_.size(); ++i) first_neighbour_[i + 1] += first_neighbour_[i];
  for (const auto& part : parts) neighbours_.insert(neighbours_.end(), part.begin(), part.end());
}

std::vector<double> RbfLevel::mean_about(const std::vector<double>& values, bool trimmed) const {
  std::vector<double> means(values.size());
  parallel_for(
      values.size(),
      [&](std::size_t i) {
        const std::size_t count = first_neighbour_[i + 1] - first_neighbour_[i];
        double sum = 0, largest = values[i];
        for (std::size_t n = first_neighbour_[i]; n < first_neighbour_[i + 1]; ++n) {
          sum += values[neighbours_[n]];
          largest = std::max(largest, values[neighbours_[n]]);
        }
        means[i] = trimmed && count > 1 ? (sum - largest) / static_cast<double>(count - 1)
                                        : sum / static_cast<double>(count);
      },
      chunk);
  return means;
}

void RbfLevel::find_ridges() {
  std::vector<double> excess;
  for (const RbfNode& node : nodes_)
    excess.push_back(node.wanted.value * node.wanted.value - node.variance);
  // A lone value in the tail of the noise, the largest, does not speak for its neighbours. Means of
  // means reach about twice as far: over discs, 28 nodes weigh like some 70.
  excess = mean_about(mean_about(excess, true), false);
  ridge_.resize(nodes_.size());
  silent_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const auto count = static_cast<double>(first_neighbour_[i + 1] - first_neighbour_[i]);
    // Two standard errors of a variance: what chance alone asks for is not given.
    const double chance = 2 * std::sqrt(2 / (2.5 * count)) * nodes_[i].variance;
    const double signal = excess[i] - chance;
    const double unknown = nodes_[i].variance + nodes_[i].slack;
    silent_[i] = !(signal > nodes_[i].variance / most_ridge);
    ridge_[i] = silent_[i] ? most_ridge : std::min(most_ridge, unknown / signal);
  }
}

std::vector<Jet> RbfLevel::multiply(const std::vector<Jet>& c) const {
  std::vector<Jet> product(c.size());
  const double scale = 1 / radius_;
  parallel_for(
      c.size(),
      [&](std::size_t i) {
        for (std::size_t n = first_neighbour_[i]; n < first_neighbour_[i + 1]; ++n) {
          const std::uint32_t j = neighbours_[n];
          const Eigen::Vector3d d = scale * (nodes_[i].place - nodes_[j].place);
          product[i] += influence(c[j], d, d.squaredNorm());
        }
      },
      chunk);
  return product;
}

RbfSolve RbfLevel::solve(double node_spacing, double relative_residual, int max_iterations) {
  find_neighbours();
  find_ridges();
  const double per_spacing = radius_ * radius_ / (node_spacing * node_spacing);
  const auto with_ridge = [&](const std::vector<Jet>& c) {
    std::vector<Jet> product = multiply(c);
    parallel_for(
        c.size(),
        [&](std::size_t i) {
          product[i].value += ridge_[i] * c[i].value;
          product[i].gradient += per_spacing * ridge_[i] * c[i].gradient;
        },
        chunk);
    return product;
  };
  const auto preconditioned = [&](const std::vector<Jet>& r) {
    std::vector<Jet> z(r.size());
    parallel_for(
        r.size(),
        [&](std::size_t i) {
          z[i] = {r[i].value / (1 + ridge_[i]),
                  r[i].gradient / (wendland_curvature + per_spacing * ridge_[i])};
        },
        chunk);
    return z;
  };
  std::vector<Jet> residual;
  for (const RbfNode& node : nodes_) residual.push_back(node.wanted);
  std::vector<Jet> z = preconditioned(residual), direction = z;
  const double start = dot(residual, z);
  double now = start;
  RbfSolve report;
  const double enough = relative_residual * relative_residual * start;
  for (; now > enough && report.iterations < max_iterations; ++report.iterations) {
    const std::vector<Jet> product = with_ridge(direction);
    const double step = now / dot(direction, product);
    add(shares_, step, direction);
    add(residual, -step, product);
    z = preconditioned(residual);
    const double next = dot(residual, z);
    parallel_for(
        direction.size(),
        [&](std::size_t i) {
          const Jet last = direction[i];
          direction[i] = z[i];
          direction[i] += next / now * last;
        },
        chunk);
    now = next;
  }
  report.relative_residual = start > 0 ? std::sqrt(now / start) : 0;
  neighbours_ = {};
  first_neighbour_ = {};
  return report;
}

}  // namespace scan
