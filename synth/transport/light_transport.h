// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light from the device through the scene to the device: one core for all scanners.
//
// Paths start at the lens and are traced backwards. At each surface or scattering point the
// device's light is added by next-event estimation (Connector: straight, through glass, over
// mirrors), the scene's lights by next-event estimation and BSDF sampling under multiple importance
// sampling (Veach and Guibas 1995), and, for narrow emitters, points that the emitter lights are
// sampled as well (emission sampling), again with the balance heuristic, so that a laser's stripe
// is found from the wall that it brightens. Each arrival carries its optical length: an image adds
// electrons, a pulse puts them at length / c, a phase camera turns them into phasors; nothing is
// binned.
#pragma once

#include <optional>

#include "synth/ray_caster.h"
#include "synth/sampling/sequence.h"
#include "synth/shape_rays.h"
#include "synth/transport/connection.h"
#include "synth/transport/emitter.h"

namespace scan::synth {

struct TransportOptions {
  int most_scatterings = 8;  // on one path: surfaces that are not smooth, and scattering in media
  int most_smooth = 8;       // smooth surfaces in a row
  bool sample_emission = false;  // for emitters that light a small part of the scene
};

// The options that carry out an effect set: without interreflection one scattering, without mirror
// reflection and refraction no smooth surface, subsurface scattering as many as bodies need.
TransportOptions transport_options(const EffectSet& effects, bool narrow_emitter);

// Set up once per scan.
class LightTransport {
 public:
  LightTransport(const RayCaster& caster, const TransportOptions& options);

  const RayCaster& caster() const { return caster_; }
  const Connector& connector() const { return connector_; }
  const TransportOptions& options() const { return options_; }

 private:
  const RayCaster& caster_;
  Connector connector_;
  TransportOptions options_;
};

// What one path brings to the lens, to be added up by the receiver's functions
//   device_light(electrons, path_m, scatterings): light of the emitter; path_m is the optical
//   length
//     from emitter to lens;
//   other_light(electrons): of the scene's lights, of 1 W/m^2 of irradiance per electron.
// One sample of `view` (unit direction, world); their mean over samples is the pixel's signal.
template <Emitter E, class Receiver>
void trace_path(const LightTransport& transport, const Ray& view, const E& emitter,
                SampleSequence& random, Receiver& receiver);

}  // namespace scan::synth
