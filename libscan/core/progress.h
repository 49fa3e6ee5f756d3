// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How long work tells how far it is; the library itself prints nothing.
#pragma once

#include <functional>
#include <string_view>

namespace scan {

// Called with the name of the step and the share of it that is done, 0 to 1; may be empty. It may
// come from any thread, but never from two at once.
using Progress = std::function<void(std::string_view step, double share)>;

}  // namespace scan
