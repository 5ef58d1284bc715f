// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
constexpr EnumWords<ReturnStatus, 4> return_status_words("ReturnStatus", "returns", "none",
                                                         "single", "two", "unresolved");
}  // namespace

std::string_view name_of(ReturnStatus status) { return return_status_words.of(status); }

}  // namespace tofsmith
