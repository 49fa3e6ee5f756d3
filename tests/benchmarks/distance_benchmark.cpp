// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Point-to-mesh distances, which every surface error rests on, beside CGAL's AABB tree and Open3D's
// ray-casting scene (single precision, Embree's tree): a torus of 1e4, 1e5 and 1e6 triangles, asked
// at 100,000 places near its surface (1e-3 of its size off, as a good scan lies) and in the box
// around it, in random order.
//
// One thread, one process, the rivals in turn, medians of the rounds' processor seconds; `one` asks
// by closest(), `all` by closest_of_each(). The largest difference of the distances from CGAL's
// stands beside, Open3D's last. Argument: rounds (5 if none).
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "libscan/core/cost.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "libscan/search/closest_point.h"
#include "tests/benchmarks/open3d_scene.h"
#include "tests/core/meshes.h"

namespace scan {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using CgalTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t query_count = 100'000;

template <class Work>
double seconds_of(Work&& work) {
  const double begin = processor_seconds();
  work();
  return processor_seconds() - begin;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

Points places_near(const Mesh& mesh) {
  Points points;
  for (const SurfaceSample& sample : sample_surface(mesh, query_count, 1)) {
    RandomStream random(2, 0, points.size());
    points.push_back(sample.point + 8e-3 * random.normal() * sample.normal);
  }
  return points;
}

Points places_in_box(const Mesh& mesh) {
  const Bounds box = bounds_of(mesh.vertices);
  Points points;
  for (std::size_t i = 0; i < query_count; ++i) {
    RandomStream random(3, 0, i);
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    points.push_back(box.min() + box.sizes().cwiseProduct(Eigen::Vector3d(x, y, z)));
  }
  return points;
}

Points shuffled(Points points) {
  for (std::size_t i = points.size(); i-- > 1;)
    std::swap(points[i], points[RandomStream(4, 0, i).bits32() % (i + 1)]);
  return points;
}

Triangles triangles_of(const Mesh& mesh) {
  Triangles triangles;
  const auto point = [&](std::uint32_t v) {
    const Eigen::Vector3d& x = mesh.vertices[v];
    return Kernel::Point_3(x.x(), x.y(), x.z());
  };
  for (const Triangle& t : mesh.triangles)
    triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
  return triangles;
}

struct Rivals {
  const MeshSearch& own;
  const CgalTree& cgal;
  const std::optional<Open3dScene>& open3d;
};

void compare(const char* where, std::size_t triangles, const Rivals& rivals, const Points& queries,
             int rounds) {
  std::vector<double> one_s, all_s, cgal_s, open3d_s;
  std::vector<float> open3d(queries.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<double> one(queries.size()), cgal(queries.size());
  std::vector<ClosestPoint> all;
  for (int round = 0; round < rounds; ++round) {
    one_s.push_back(seconds_of([&] {
      for (std::size_t i = 0; i < queries.size(); ++i)
        one[i] = rivals.own.closest(queries[i]).distance_m;
    }));
    all_s.push_back(seconds_of([&] { all = closest_of_each(rivals.own, queries); }));
    cgal_s.push_back(seconds_of([&] {
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const Kernel::Point_3 x(queries[i].x(), queries[i].y(), queries[i].z());
        cgal[i] = std::sqrt(rivals.cgal.squared_distance(x));
      }
    }));
    open3d_s.push_back(seconds_of([&] {
      if (rivals.open3d) open3d = rivals.open3d->distances_m(queries);
    }));
  }
  double difference = 0, of_open3d = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    difference =
        std::max({difference, std::abs(one[i] - cgal[i]), std::abs(all[i].distance_m - cgal[i])});
    of_open3d = std::max(of_open3d, std::abs(double{open3d[i]} - cgal[i]));
  }
  const double each = 1e6 / static_cast<double>(queries.size());
  std::printf("%9zu  %-8s %8.3f %8.3f %8.3f %8.3f   %6.2f %6.2f %6.2f   %.1e %.1e\n", triangles,
              where, median(one_s) * each, median(all_s) * each, median(cgal_s) * each,
              median(open3d_s) * each, median(cgal_s) / median(one_s),
              median(cgal_s) / median(all_s), median(open3d_s) / median(all_s), difference,
              of_open3d);
}

void compare_mesh(std::uint32_t around, std::uint32_t across, int rounds) {
  const Mesh mesh = torus(3, 1, around, across);
  const Triangles triangles = triangles_of(mesh);
  const MeshSearch own(mesh);
  CgalTree cgal(triangles.begin(), triangles.end());
  cgal.accelerate_distance_queries();
  const std::optional<Open3dScene> open3d = Open3dScene::of(mesh);
  const Rivals rivals{own, cgal, open3d};
  compare("near", mesh.triangles.size(), rivals, shuffled(places_near(mesh)), rounds);
  compare("in box", mesh.triangles.size(), rivals, places_in_box(mesh), rounds);
}

}  // namespace
}  // namespace scan

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  const scan::ThreadLimit one_thread(1);
  const tbb::global_control one_for_open3d(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("microseconds a query; CGAL's time over one and all, Open3D's over all\n");
  std::printf(
      "triangles  places        one      all     CGAL   Open3D      one    all Open3D   off, m\n");
  for (const auto& [around, across] :
       {std::pair(100u, 50u), std::pair(330u, 150u), std::pair(1000u, 500u)})
    scan::compare_mesh(around, across, rounds);
}
