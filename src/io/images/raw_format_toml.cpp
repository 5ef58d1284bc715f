// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "io/shared/read_file.hpp"
#include "io/text/shared/table_reader.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

namespace {

constexpr std::array number_words = {ChoiceWord<RawNumbers>{"integer", RawNumbers::integers},
                                     ChoiceWord<RawNumbers>{"float", RawNumbers::floats}};
constexpr std::array packings = {ChoiceWord<RawPacking>{"plain", RawPacking::plain},
                                 ChoiceWord<RawPacking>{"mipi", RawPacking::mipi},
                                 ChoiceWord<RawPacking>{"lsb_first", RawPacking::lsb_first},
                                 ChoiceWord<RawPacking>{"msb_first", RawPacking::msb_first}};
constexpr std::array layouts = {ChoiceWord<RawOrder>{"planar", RawOrder::planar},
                                ChoiceWord<RawOrder>{"interleaved", RawOrder::interleaved},
                                ChoiceWord<RawOrder>{"by_rows", RawOrder::by_rows}};
constexpr std::array alignments = {ChoiceWord<RawAlignment>{"low", RawAlignment::low},
                                   ChoiceWord<RawAlignment>{"high", RawAlignment::high}};
constexpr std::array byte_orders = {ChoiceWord<bool>{"little", false},
                                    ChoiceWord<bool>{"big", true}};
constexpr std::array tap_words = {ChoiceWord<bool>{"keep", false},
                                  ChoiceWord<bool>{"subtract", true}};

void read_order(TableReader& table, std::vector<int>& order) {
  std::vector<double> numbers;
  table.value("order", numbers);
  for (const double number : numbers) {
    if (number != static_cast<double>(static_cast<int>(std::min(1e9, std::max(-1e9, number)))))
      table.fail("order", "must be a list of whole numbers from 0 on");
    order.push_back(static_cast<int>(number));
  }
}

void read_fields(TableReader& table, RawFormat& format) {
  table.required("width", "320").value("width", format.width);
  table.required("height", "240").value("height", format.height);
  table.required("measurements", "4").value("measurements", format.measurements);
  table.value("frames", format.frames);
  table.value("header_bytes", format.header_bytes);
  table.value("frame_header_bytes", format.frame_header_bytes);
  table.value("image_header_bytes", format.image_header_bytes);
  table.value("row_bytes", format.row_bytes);
  table.choice("numbers", format.numbers, Choices<RawNumbers>(number_words));
  table.required("bits", "12").value("bits", format.bits);
  table.value("container_bits", format.container_bits);
  table.choice("packing", format.packing, Choices<RawPacking>(packings));
  table.choice("align", format.align, Choices<RawAlignment>(alignments));
  table.choice("byte_order", format.big_endian, Choices<bool>(byte_orders));
  table.value("signed", format.is_signed);
  table.value("rows_start_bytes", format.rows_start_bytes);
  table.choice("layout", format.layout, Choices<RawOrder>(layouts));
  read_order(table, format.order);
  table.value("flip_rows", format.flip_rows);
  table.value("flip_columns", format.flip_columns);
  table.value("black_level", format.black_level);
  table.choice("taps", format.subtract_taps, Choices<bool>(tap_words));
}

}  // namespace

RawFormat parse_raw_format(std::string_view text, std::string_view source_name) {
  const TomlDocument document(text, source_name);
  TableReader::Places places;
  TableReader table(document, places);
  RawFormat format;
  read_fields(table, format);
  table.finish();
  try {
    format.validate();
  } catch (const InvalidArgument& error) {
    const auto place = places.find(error.field());
    throw IoError(place == places.end() ? document.source_name() : place->second, error.what());
  }
  return format;
}

RawFormat read_raw_format(const std::filesystem::path& path) {
  return parse_raw_format(read_text_file(path), path.string());
}

}  // namespace tofsmith
