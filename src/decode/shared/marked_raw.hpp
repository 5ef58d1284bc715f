// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Returns a view of the frame in which saturated and invalid values are replaced.
/// @param buffer  memory of the result; unused if the marking replaces nothing
RawView mark_raw(const RawView& raw, const RawMarking& marking, std::vector<std::byte>& buffer);

/// A marked frame and its buffer. The first step of every decoder and filter.
class MarkedRaw {
 public:
  MarkedRaw(const RawView& raw, const RawMarking& marking)
      : view_(mark_raw(raw, marking, buffer_)) {}
  MarkedRaw(const MarkedRaw&) = delete;
  MarkedRaw& operator=(const MarkedRaw&) = delete;

  const RawView& view() const { return view_; }

 private:
  std::vector<std::byte> buffer_;
  RawView view_;
};

}  // namespace tofsmith
