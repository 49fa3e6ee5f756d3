// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_refinement.h"

#include <algorithm>

#include "libscan/align/joint_solver.h"

namespace scan {

std::vector<Vector6> joint_step(std::span<const JointForm> forms, const JointFrame& frame,
                                const JointBasis& weak, const GuessPrior& prior) {
  const JointSystem system(forms, frame);
  if (system.rows() == 0) return std::vector<Vector6>(frame.centres.size(), Vector6::Zero());
  const JointMatrix data = matrix_of(system, system.sum([](const JointForm& form) -> Matrix6 {
    return form.a + rounding_of(form.a);
  }));
  const WithholdingSolver solver(data + matrix_of(system, system.information(prior)),
                                 withheld(system, weak, prior));
  return system.twists(solver.solve(system.right_side() + system.right_side(prior)));
}

std::vector<RelativeStep> relative_steps(std::span<const JointForm> forms, const JointFrame& frame,
                                         std::span<const Vector6> twists) {
  std::vector<RelativeStep> steps(twists.size());
  for (const JointForm& form : forms) {
    const Vector6 x = twist_to_form(frame, form.source, form) * twists[form.source] -
                      twist_to_form(frame, form.target, form) * twists[form.target];
    for (const std::size_t scan : {form.source, form.target}) {
      RelativeStep& step = steps[scan];
      step.square += x.dot(form.a * x);
      step.rotation_rad = std::max(step.rotation_rad, x.head<3>().norm());
      step.translation = std::max(step.translation, x.tail<3>().norm());
    }
  }
  return steps;
}

}  // namespace scan
