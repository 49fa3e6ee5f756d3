// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanner.h"

namespace scan::synth {

double wavelength_m(const Scanner& scanner) {
  return std::visit([](const auto& s) { return s.wavelength_m; }, scanner);
}

void check(const Scanner& scanner) {
  std::visit([](const auto& s) { check(s); }, scanner);
}

Rendering render(const Scanner& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  return std::visit(
      [&](const auto& s) { return render(s, caster, world_from_scanner, address, effects); },
      scanner);
}

std::vector<RayTruth> true_rays(const Scanner& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  return std::visit([&](const auto& s) { return true_rays(s, caster, world_from_scanner); },
                    scanner);
}

}  // namespace scan::synth
