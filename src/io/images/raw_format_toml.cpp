// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/shared/read_file.hpp"
#include "io/text/shared/table_reader.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

namespace {

constexpr EnumWords<RawNumbers, 2> numbers("RawNumbers", "numbers", "integer", "float");
constexpr EnumWords<RawPacking, 4> packings("RawPacking", "packing", "plain", "mipi", "lsb_first",
                                            "msb_first");
constexpr EnumWords<RawOrder, 3> layouts("RawOrder", "layout", "planar", "interleaved", "by_rows");
constexpr EnumWords<RawAlignment, 2> alignments("RawAlignment", "align", "low", "high");
constexpr EnumWords<bool, 2> byte_orders("big_endian", "byte_order", "little", "big");
constexpr EnumWords<bool, 2> taps("subtract_taps", "taps", "keep", "subtract");

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
  table.choice("numbers", format.numbers, numbers);
  table.required("bits", "12").value("bits", format.bits);
  table.value("container_bits", format.container_bits);
  table.choice("packing", format.packing, packings);
  table.choice("align", format.align, alignments);
  table.choice("byte_order", format.big_endian, byte_orders);
  table.value("signed", format.is_signed);
  table.value("rows_start_bytes", format.rows_start_bytes);
  table.choice("layout", format.layout, layouts);
  read_order(table, format.order);
  table.value("flip_rows", format.flip_rows);
  table.value("flip_columns", format.flip_columns);
  table.value("black_level", format.black_level);
  table.choice("taps", format.subtract_taps, taps);
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
  return parse_raw_format(read_text_file(path, max_settings_file_bytes), path.string());
}

}  // namespace tofsmith
