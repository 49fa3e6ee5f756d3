// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light from the device through the scene to the device: one core for all scanners.
//
// Paths start at the lens and are traced backwards. At each surface or scattering point the
// device's light is added by next-event estimation (Connector: straight, through glass, over
// mirrors), the scene's lights by next-event estimation and BSDF sampling under multiple importance
// sampling (Veach and Guibas 1995), and, for narrow emitters, points that the emitter lights are
// sampled as well (emission sampling), again with the balance heuristic, so that a laser's stripe
// is found from the wall that it brightens. In fog the place where the emitter is brightest is
// sampled besides the free flight. As long as a view meets nothing but mirrors, smooth glass and
// smooth coats, all that they show is followed, each part by a branch with its share of the light;
// chance begins behind the first other surface, and below a hundredth of the light. Each arrival
// carries its optical length: an image adds electrons, a pulse puts them at length / c, a phase
// camera turns them into phasors; nothing is binned.
//
// A scanner's part, per scan: simplified() scene, RayCaster, LightTransport with
// transport_options(). Per reading: an Emitter in the world frame, and estimate() with a `draw`
// that starts a SampleSequence (seed, scan, ray, stream) at the sample's index, spends its first
// numbers on the place in pixel or beam, on aperture and time, and calls trace_path with a receiver
// that adds to the signals. Direct light is known in closed form: arrivals of one scattering that
// are no longer than the straight way, to 1e-9, may be left out of the sum.
//
// Not found: light over smooth surfaces in ways that Connector does not know, unless it is the
// emitter's on its way to the last scattering but one and emission is sampled.
#pragma once

#include <vector>

#include "synth/effects/effect.h"
#include "synth/light.h"
#include "synth/ray_caster.h"
#include "synth/sampling/sequence.h"
#include "synth/shape_rays.h"
#include "synth/transport/connection.h"
#include "synth/transport/device.h"
#include "synth/transport/surroundings.h"

namespace scan::synth {

struct TransportOptions {
  // On one path: surfaces that are not smooth, and scattering in the medium around them. A stay in
  // a translucent body counts as one.
  int most_scatterings = 8;
  int most_in_bodies = 4096;     // of one path, within translucent bodies
  int most_smooth = 8;           // smooth surfaces in a row
  bool mirrors = true;           // off: light ends where a smooth surface would reflect it
  bool sample_emission = false;  // for emitters that light a small part of the scene
};

// The options that carry out an effect set. Without interreflection one scattering: by a surface,
// by fog, or a stay in a translucent body. Without mirror reflection ways that a smooth surface
// reflects are left out; without it, refraction and subsurface scattering no smooth surface is
// passed. `narrow_emitter`: it lights a small part of the scene. What else is off, simplified()
// takes out of the scene.
TransportOptions transport_options(const EffectSet& effects, bool narrow_emitter);

// Set up once per scan, used from many threads; the caster must outlive it.
class LightTransport {
 public:
  LightTransport(const RayCaster& caster, const TransportOptions& options);

  const RayCaster& caster() const { return caster_; }
  const Connector& connector() const { return connector_; }
  const TransportOptions& options() const { return options_; }
  const std::vector<PreparedLight>& lights() const { return lights_; }
  const ObjectOptics& optics(int object) const { return optics_[object]; }

  // See trace_path.
  void trace(const Ray& view, const AnyEmitter& emitter, SampleSequence& random,
             const AnyReceiver& receiver) const {
    trace_(*this, view, emitter, random, receiver);
  }

 private:
  const RayCaster& caster_;
  Connector connector_;
  TransportOptions options_;
  std::vector<PreparedLight> lights_;
  std::vector<ObjectOptics> optics_;
  // Compiled for what scene and options call for, and nothing else.
  void (*trace_)(const LightTransport&, const Ray&, const AnyEmitter&, SampleSequence&,
                 const AnyReceiver&);
};

// What one path with its branches brings to the lens, to be added up by the receiver's functions
//   device_light(electrons, path_m, scatterings): light of the emitter; path_m is the optical
//     length from emitter to lens, scatterings counts as TransportOptions::most_scatterings does;
//   other_light(electrons): of the scene's lights, of 1 W/m^2 of irradiance per electron.
//   ambient(share), if there is such a function: what the first place that is not smooth passes on
//     of uniform light from all sides without shadow, of 1 electron from a white surface; once for
//     each branch.
// One sample of `view` (unit direction, world); their mean over samples is the pixel's signal.
template <Emitter E, class Receiver>
void trace_path(const LightTransport& transport, const Ray& view, const E& emitter,
                SampleSequence& random, Receiver& receiver) {
  transport.trace(view, any_emitter(emitter), random, any_receiver(receiver));
}

}  // namespace scan::synth
