// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A tracer that knows nothing but sampling what comes next: it finds a light by meeting it.
#pragma once

#include <cmath>
#include <numbers>

#include "synth/light.h"
#include "synth/ray_caster.h"
#include "synth/sampling/warp.h"

namespace scan::synth {

class PlainTracer {
 public:
  // At most one body at a time may let light in; what is inside scatters evenly.
  PlainTracer(const RayCaster& caster, int most)
      : caster_(caster),
        lights_(caster.scene().lights.begin(), caster.scene().lights.end()),
        most_(most) {}

  // Electrons of the scene's lights by one path.
  double path(const Ray& view, SampleSequence& random) const {
    Eigen::Vector3d origin = view.origin, direction = view.direction;
    double share = std::numbers::pi, electrons = 0;
    const Medium* inside = nullptr;
    for (int k = 0; k <= most_; ++k) {
      const auto met = caster_.closest(origin, direction);
      if (inside && met) {
        const double extinction = inside->scattering_per_m + inside->absorption_per_m;
        const double flight_m = -std::log1p(-random.next()) / extinction;
        if (flight_m < met->distance_m) {
          share *= inside->scattering_per_m / extinction;
          origin += flight_m * direction;
          direction = to_sphere(random.next_2d());
          continue;
        }
      }
      electrons += share * seen(origin, direction, met ? met->distance_m : 1e300);
      if (!met || !scatter(*met, random, origin, direction, share, inside)) break;
    }
    return electrons;
  }

 private:
  double seen(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double end_m) const {
    double radiance = 0;
    for (const PreparedLight& light : lights_) {
      const LightSample sample = light_along(light, origin, direction);
      if (std::min(sample.distance_m, 1e200) < end_m) radiance += sample.radiance;
    }
    return radiance;
  }

  bool scatter(const Hit& met, SampleSequence& random, Eigen::Vector3d& origin,
               Eigen::Vector3d& direction, double& share, const Medium*& inside) const {
    const Material& material =
        caster_.scene().materials[caster_.scene().objects[met.object].material];
    const Hit hit = is_transmissive(material.bsdf) ? met : facing(met, direction);
    Eigen::Matrix3d frame;
    frame.col(0) = hit.normal.unitOrthogonal();
    frame.col(1) = hit.normal.cross(frame.col(0));
    frame.col(2) = hit.normal;
    const auto next = sample(bsdf_at(caster_.scene(), hit.object, hit.triangle, hit.point),
                             frame.transpose() * -direction, random.next_3d());
    if (!next) return false;
    share *= next->weight;
    direction = (frame * next->in).normalized();
    if (next->is_transmitted)
      inside = next->in.z() < 0 && material.interior ? &*material.interior : nullptr;
    origin = caster_.leave(hit, direction);
    return true;
  }

  const RayCaster& caster_;
  std::vector<PreparedLight> lights_;
  int most_;
};

}  // namespace scan::synth
