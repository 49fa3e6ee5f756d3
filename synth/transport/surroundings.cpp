// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/surroundings.h"

#include <algorithm>

namespace scan::synth {
std::vector<ObjectOptics> optics_of(const Scene& scene) {
  std::vector<ObjectOptics> all;
  for (const Object& object : scene.objects) {
    const Material& material = scene.materials[object.material];
    const auto* glass = std::get_if<Dielectric>(&material.bsdf);
    ObjectOptics optics{.bsdf = material.bsdf,
                        .is_textured = !std::holds_alternative<PlainTexture>(material.texture),
                        .has_delta = has_delta(material.bsdf),
                        .is_transmissive = is_transmissive(material.bsdf)};
    optics.is_smooth =
        optics.has_delta && (glass || std::holds_alternative<Conductor>(material.bsdf));
    if (glass) optics.index = glass->index;
    if (optics.is_transmissive && material.interior) optics.interior = &*material.interior;
    all.push_back(optics);
  }
  return all;
}

void Surroundings::enter(const ObjectOptics& body) {
  depth_ = std::min<int>(depth_ + 1, static_cast<int>(bodies_.size()));
  bodies_[depth_ - 1] = &body;
}

void Surroundings::exit(const ObjectOptics& body) {
  const auto end = bodies_.begin() + depth_;
  const auto found = std::find(std::make_reverse_iterator(end), bodies_.rend(), &body);
  if (found == bodies_.rend()) return;
  std::copy(found.base(), end, found.base() - 1);
  --depth_;
}

}  // namespace scan::synth
