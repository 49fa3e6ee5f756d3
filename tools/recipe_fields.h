// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The keys of a recipe's scanner, viewpoints and stages.
#pragma once

#include "tools/fields.h"
#include "tools/recipe.h"

namespace scan {

void fields(Fields& f, synth::Scanner& scanner);
void fields(Fields& f, synth::Viewpoints& viewpoints);
void fields(Fields& f, AcquireOptions& options);
void fields(Fields& f, MultiviewOptions& options);
void fields(Fields& f, ReconstructSettings& settings);
void fields(Fields& f, VerifySettings& settings);
void fields(Fields& f, synth::Artefacts& artefacts);

}  // namespace scan
