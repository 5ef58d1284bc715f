// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/return_status.hpp"

#include <string>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::string_view name_of(ReturnStatus status) {
  switch (status) {
    case ReturnStatus::none:
      return "none";
    case ReturnStatus::single:
      return "single";
    case ReturnStatus::two:
      return "two";
    case ReturnStatus::unresolved:
      return "unresolved";
  }
  reject("ReturnStatus", std::to_string(static_cast<int>(status)), "must be in [0, 3]");
}

}  // namespace tofsmith
