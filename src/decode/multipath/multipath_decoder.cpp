// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/multipath_decoder.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "decode/multipath/multipath_engine.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

void MultipathOptions::validate(double range_m) const {
  const std::string of_range = " the range, " + fmt::format("{:f}", range_m) + " m";
  check_fields(*this, "MultipathOptions::");
  require(shortest_delay_m < range_m, "MultipathOptions::shortest_delay_m", shortest_delay_m,
          "must be > 0 and below" + of_range);
  const double longest_m = longest_delay_m.value_or(range_m / 3);
  require(longest_m > shortest_delay_m && longest_m < range_m, "MultipathOptions::longest_delay_m",
          longest_m, "must be above shortest_delay_m and below" + of_range);
  require(tail_m <= range_m, "MultipathOptions::tail_m", tail_m,
          "must be > 0 and at most" + of_range);
  status_thresholds.validate();
  if (prior) check_fields(*prior, "ReturnPrior::");
}

MultipathDecoder::MultipathDecoder(DecodingTable table, const MultipathOptions& options,
                                   MultipathKind later)
    : engine_(make_hidden<const MultipathEngine>(std::move(table), options, later)) {}

TwoReturnDecoder::TwoReturnDecoder(DecodingTable table, const MultipathOptions& options)
    : MultipathDecoder(std::move(table), options, MultipathKind::second_return) {}

TailDecoder::TailDecoder(DecodingTable table, const MultipathOptions& options)
    : MultipathDecoder(std::move(table), options, MultipathKind::tail) {}

namespace {

std::optional<std::string> why_not(const DecodingTable& table, MultipathKind later) {
  if (auto no_depth = why_not_decodable(table)) return no_depth;
  if (table.has_rows()) return "multipath decoding requires independent measurements, not rows";
  return text_of(missing_support(AmbientProjection(table), later));
}

}  // namespace

std::optional<std::string> TwoReturnDecoder::why_not_decodable(const DecodingTable& table) {
  return why_not(table, MultipathKind::second_return);
}

std::optional<std::string> TailDecoder::why_not_decodable(const DecodingTable& table) {
  return why_not(table, MultipathKind::tail);
}

DecodeMethod MultipathDecoder::method() const {
  return engine_->kind() == MultipathKind::tail ? DecodeMethod::tail : DecodeMethod::two_return;
}

const DecodingTable& MultipathDecoder::table() const { return engine_->table(); }

void MultipathDecoder::decode_pixels(const RawView& raw, const RangePart* parts,
                                     const DecodedView& decoded, const Progress& progress) const {
  engine_->decode(raw, parts, decoded, progress);
}

void MultipathDecoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                         double* depth_bin) const {
  engine_->decode_depth_bins(measurements, pixels, depth_bin);
}

}  // namespace tofsmith
