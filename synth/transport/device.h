// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A scanner's emitter and receiver without their types, so that one compiled core serves them all.
#pragma once

#include "synth/transport/emitter.h"
#include "synth/transport/equiangular.h"

namespace scan::synth {

// See Emitter. Refers to the scanner's own object, which must outlive it.
struct AnyEmitter {
  const void* emitter = nullptr;
  Eigen::Vector3d position;
  double (*irradiance_of)(const void*, const Eigen::Vector3d&, double) = nullptr;
  EmittedRay (*sample_of)(const void*, const Eigen::Vector2d&) = nullptr;
  double (*flux_of)(const void*) = nullptr;
  Brightest (*brightest_of)(const void*, const Eigen::Vector3d&, const Eigen::Vector3d&) = nullptr;
  bool (*reaches_of)(const void*, const Eigen::Vector3d&, double) = nullptr;

  double irradiance(const Eigen::Vector3d& direction, double length_m) const {
    return irradiance_of(emitter, direction, length_m);
  }
  EmittedRay sample(const Eigen::Vector2d& u) const { return sample_of(emitter, u); }
  double flux() const { return flux_of(emitter); }
  Brightest brightest(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) const {
    return brightest_of(emitter, origin, along);
  }
  bool reaches(const Eigen::Vector3d& centre, double radius_m) const {
    return reaches_of(emitter, centre, radius_m);
  }
};

template <Emitter E>
AnyEmitter any_emitter(const E& emitter) {
  return {.emitter = &emitter,
          .position = emitter.position(),
          .irradiance_of = [](const void* e, const Eigen::Vector3d& direction, double length_m)
              -> double { return static_cast<const E*>(e)->irradiance(direction, length_m); },
          .sample_of = [](const void* e, const Eigen::Vector2d& u) -> EmittedRay {
            return static_cast<const E*>(e)->sample(u);
          },
          .flux_of = [](const void* e) -> double { return static_cast<const E*>(e)->flux(); },
          .brightest_of = [](const void* e, const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction) -> Brightest {
            const E& own = *static_cast<const E*>(e);
            if constexpr (requires { own.brightest(origin, direction); })
              return own.brightest(origin, direction);
            else
              return nearest_to(own.position(), origin, direction);
          },
          .reaches_of = [](const void* e, const Eigen::Vector3d& centre, double radius_m) -> bool {
            if constexpr (requires(const E& own) { own.reaches(centre, radius_m); })
              return static_cast<const E*>(e)->reaches(centre, radius_m);
            else
              return true;
          }};
}

// See trace_path.
struct AnyReceiver {
  void* receiver = nullptr;
  void (*device_light_of)(void*, double, double, int) = nullptr;
  void (*other_light_of)(void*, double) = nullptr;
  void (*ambient_of)(void*, double) = nullptr;  // null: nobody asks

  void device_light(double electrons, double path_m, int scatterings) const {
    device_light_of(receiver, electrons, path_m, scatterings);
  }
  void other_light(double electrons) const { other_light_of(receiver, electrons); }
  void ambient(double share) const { ambient_of(receiver, share); }
};

template <class R>
AnyReceiver any_receiver(R& receiver) {
  AnyReceiver any{
      .receiver = &receiver,
      .device_light_of =
          [](void* r, double electrons, double path_m, int scatterings) {
            static_cast<R*>(r)->device_light(electrons, path_m, scatterings);
          },
      .other_light_of = [](void* r,
                           double electrons) { static_cast<R*>(r)->other_light(electrons); }};
  if constexpr (requires { receiver.ambient(0.0); })
    any.ambient_of = [](void* r, double share) { static_cast<R*>(r)->ambient(share); };
  return any;
}

}  // namespace scan::synth
