// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/design.hpp"

#include "core/shared/enum_words.hpp"

namespace tofsmith {

namespace {
constexpr EnumWords<Termination, 4> termination_words("Termination", "termination", "not_run",
                                                      "converged", "stalled", "iteration_limit");
}  // namespace

std::string_view to_string(Termination termination) { return termination_words.of(termination); }

}  // namespace tofsmith
