// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Two matt walls that light each other, and their two-bounce phasor by quadrature.
#pragma once

#include <cmath>
#include <complex>

#include "libscan/core/units.h"
#include "synth/scanners/phase_paths.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

inline double per_m(double frequency_hz) {
  return 4 * std::numbers::pi * frequency_hz / speed_of_light_m_s;
}

// Nodes and weights of Gauss and Legendre on [0, 1], by Newton's method on P_n.
struct Quadrature {
  std::vector<double> node, weight;
};
inline Quadrature gauss_legendre(int n) {
  Quadrature q;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step) {
      double before = 1, here = x;
      for (int k = 2; k <= n; ++k)
        before = std::exchange(here, ((2 * k - 1) * x * here - (k - 1) * before) / k);
      slope = n * (x * here - before) / (x * x - 1);
      x -= here / slope;
    }
    q.node.push_back((x + 1) / 2);
    q.weight.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return q;
}

// Two walls, 0.8 x 1 m each, meet at a right angle in the vertical line through (0, 0, 2) and open
// towards the camera: points edge + u along + v up.
struct Wall {
  Eigen::Vector3d along;
  Eigen::Vector3d normal;
};
inline const Eigen::Vector3d edge(0, 0, 2);
inline const Wall left{{-std::sqrt(0.5), 0, -std::sqrt(0.5)}, {std::sqrt(0.5), 0, -std::sqrt(0.5)}};
inline const Wall right{{std::sqrt(0.5), 0, -std::sqrt(0.5)},
                        {-std::sqrt(0.5), 0, -std::sqrt(0.5)}};

inline Eigen::Vector3d on(const Wall& wall, double u_m, double v_m) {
  return edge + u_m * wall.along + v_m * Eigen::Vector3d::UnitY();
}

inline Scene corner(double albedo) {
  Scene scene{.objects = {}, .materials = {plain(albedo)}};
  for (const Wall& wall : {left, right}) {
    Mesh mesh;
    mesh.vertices = {on(wall, 0, -0.5), on(wall, 0.8, -0.5), on(wall, 0.8, 0.5), on(wall, 0, 0.5)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.objects.push_back(
        {.name = "wall", .world_from_object = Pose::Identity(), .geometry = mesh, .material = 0});
  }
  return scene;
}

// Direct and two-bounce phasor at x of the left wall, from the light at the camera: irradiance
// E cos / y^2 at y of the right wall, of which albedo / pi leaves towards x; times the geometry of
// both; the path is |y| + |x - y| + |x|. A quadrature of 64 x 64 nodes: the kernel is smooth on the
// scale of 0.3 m, the distance of x from the edge.
inline std::complex<double> corner_phasor(const PhaseCamera& s, double frequency_hz, double albedo,
                                          double u_m, double v_m) {
  const Quadrature q = gauss_legendre(64);
  const Eigen::Vector3d x = on(left, u_m, v_m);
  const double k = per_m(frequency_hz) / 2;
  const auto lit = [&](const Eigen::Vector3d& point, const Wall& wall) {
    return s.electrons_at_1m * -wall.normal.dot(point) / std::pow(point.norm(), 3);
  };
  std::complex<double> sum = albedo * s.contrast * lit(x, left) * std::polar(1.0, 2 * k * x.norm());
  for (std::size_t i = 0; i < 64; ++i)
    for (std::size_t j = 0; j < 64; ++j) {
      const Eigen::Vector3d y = on(right, 0.8 * q.node[i], q.node[j] - 0.5);
      const Eigen::Vector3d to_y = y - x;
      const double r2 = to_y.squaredNorm();
      const double form =
          left.normal.dot(to_y) * -right.normal.dot(to_y) / (std::numbers::pi * r2 * r2);
      sum += 0.8 * q.weight[i] * q.weight[j] * albedo * albedo * s.contrast * lit(y, right) * form *
             std::polar(1.0, k * (y.norm() + std::sqrt(r2) + x.norm()));
    }
  return sum;
}

}  // namespace scan::synth
