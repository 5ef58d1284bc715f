// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "table_arguments.hpp"

#include <fmt/format.h>

#include <numeric>

#include "help_pages.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"

namespace tofsmith::apps {

namespace {

/// Returns the exposures of a table with `measurements` columns, in the order of the camera.
std::vector<int> order_of(const std::vector<int>& given, const Camera& camera, int measurements,
                          const TapArguments& taps) {
  if (!given.empty()) return given;
  if (camera.playback && !camera.playback->order.empty()) return camera.playback->order;
  const bool reads_taps = camera.sensor.readout == Readout::separate && !camera.sensor.is_signed();
  const int side = reads_taps ? taps.taps.value_or(camera.sensor.taps) : 1;
  std::vector<int> order(
      static_cast<std::size_t>(measurements % side == 0 ? measurements / side : measurements));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

}  // namespace

void TableArguments::add_to(CLI::App& command) {
  command
      .add_option("--range-m", range_m_,
                  "unambiguous range of a measured table in metres (default: the camera's)")
      ->check(positive_number(1e6))
      ->transform(number_in("m"))
      ->group(for_experts);
  command
      .add_option(
          "--ambient", ambient_,
          "ambient light in the columns of a measured table: equal in all columns (default, unless "
          "the file specifies it), proportional to the mean of each column, or none")
      ->check(one_of({"equal", "mean", "none"}))
      ->group(for_experts);
  command
      .add_option(
          "--table-axes", axes_,
          "axes of a measured table: samples x measurements (nk) or measurements x samples (kn)")
      ->check(one_of({"nk", "kn"}))
      ->group(for_experts);
  command
      .add_option("--order", order_, "order of the code's exposures in the frames, such as 0,3,2,1")
      ->delimiter(',');
  command.add_flag("--reverse", reversed_,
                   "reverse the direction of delay, for frames in which near and far are swapped");
  command
      .add_flag("--keep-end-point", keep_end_point_,
                "keep the last sample of a measured table even if it equals the first")
      ->group(for_experts);
}

DecodingSource TableArguments::load(const std::string& code, const Camera& camera,
                                    bool default_camera, const TapArguments& taps) const {
  const char* const of_tables = range_m_            ? "--range-m"
                                : !ambient_.empty() ? "--ambient"
                                : !axes_.empty()    ? "--table-axes"
                                : keep_end_point_   ? "--keep-end-point"
                                                    : nullptr;
  if (of_tables && !names_measured_table(code)) {
    load_camera_code(code, camera, taps.file_options_for({code}));  // reports an invalid code first
    throw UsageError(
        fmt::format("{} is only valid with a measured table; {} is a code, for which the camera "
                    "determines these values",
                    of_tables, code));
  }
  DecodingTableOptions options{.file = taps.file_options_for({code}),
                               .range_m = range_m_,
                               .ambient = {},
                               .axes = {},
                               .keep_end_point = keep_end_point_,
                               .order = order_,
                               .reversed = reversed_};
  if (!ambient_.empty()) options.ambient = parse_measured_ambient(ambient_);
  if (!axes_.empty()) options.axes = parse_table_axes(axes_);
  DecodingSource source{load_decoding_table(code, camera, options), {}, {}, {}};
  if (range_m_)
    source.range_source = "--range-m";
  else if (default_camera)
    source.range_source = fmt::format(
        "of the default camera {}; {}", camera.name,
        source.is_measured ? "--range-m or --camera override it" : "--camera overrides it");
  else
    source.range_source = fmt::format("of the camera {}", camera.name);
  source.tell_range = source.is_measured || default_camera;
  source.order = order_of(order_, camera, source.table.measurements(), taps);
  return source;
}

}  // namespace tofsmith::apps
