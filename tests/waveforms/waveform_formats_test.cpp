// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Writers of waveform formats, compared with readers and with golden files that
// golden/make_golden.py writes from the layouts in docs/formats.md.
#include <gtest/gtest.h>

#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "waveform_readers.hpp"
#include "waveforms/generator_formats.hpp"

namespace tofsmith {
namespace {

FileBytes golden(const std::string& name) {
  return read_binary_file(TOFSMITH_SOURCE_DIR "/tests/io/golden/" + name);
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The waveform of make_golden.py.
QuantizedWaveform golden_waveform(std::int32_t levels, int periods = 1) {
  const std::int32_t top = levels - 1;
  QuantizedWaveform waveform{.name = "modulation_1", .levels = levels, .periods = periods};
  for (int p = 0; p < periods; ++p)
    for (const std::int32_t code : {0, top, top / 2, 1, top - 1, 0, top / 3, top})
      waveform.codes.push_back(code);
  waveform.sample_rate_hz = 40e6;
  waveform.low_v = -0.5;
  waveform.high_v = 1.5;
  return waveform;
}

/// Values include the ends of the range.
QuantizedWaveform random_waveform(std::uint32_t item, std::int32_t levels, int points) {
  RandomStream random(91, item);
  QuantizedWaveform waveform{.name = "demodulation_3", .levels = levels};
  for (int j = 0; j < points; ++j)
    waveform.codes.push_back(static_cast<std::int32_t>(random() % static_cast<unsigned>(levels)));
  waveform.codes.front() = 0;
  waveform.codes.back() = levels - 1;
  waveform.sample_rate_hz = 1e6 * (1.0 + 400 * random.uniform());
  waveform.low_v = -5.0 * random.uniform();
  waveform.high_v = 0.1 + 5.0 * random.uniform();
  return waveform;
}

TEST(Golden, EveryWriterMatches) {
  const QuantizedWaveform w14 = golden_waveform(1 << 14), w16 = golden_waveform(1 << 16),
                          kilobyte = golden_waveform(1 << 14, 64);
  const auto wvdt = [](const QuantizedWaveform& w, WvdtPoints points) {
    return wvdt_bytes(wvdt_command(w, points), points);
  };
  EXPECT_EQ(bytes_of(easywave_csv(w14)), golden("siglent_easywave.csv"));
  EXPECT_EQ(bytes_of(easywave_csv(w14, EasyWaveDialect::lenth)), golden("siglent_lenth.csv"));
  EXPECT_EQ(bytes_of(easywave_csv(w14, EasyWaveDialect::commas)), golden("siglent_commas.csv"));
  EXPECT_EQ(wvdt(w16, WvdtPoints::bits16_little_endian), golden("siglent_16.wvdt"));
  EXPECT_EQ(wvdt(kilobyte, WvdtPoints::bits14_little_endian), golden("siglent_14_little.wvdt"));
  EXPECT_EQ(wvdt(kilobyte, WvdtPoints::bits14_big_endian), golden("siglent_14_big.wvdt"));
  EXPECT_EQ(bytes_of(keysight_arb_text(golden_waveform(keysight_levels))), golden("keysight.arb"));
  EXPECT_EQ(tektronix_tfw(golden_waveform(tektronix_afg_levels)), golden("tektronix.tfw"));
  EXPECT_EQ(tektronix_wfm(w14), golden("tektronix.wfm"));
}

TEST(EasyWaveCsv, ReadsBackWithinHalfAStepInEveryDialect) {
  for (const auto dialect :
       {EasyWaveDialect::easywave, EasyWaveDialect::lenth, EasyWaveDialect::commas}) {
    const QuantizedWaveform w = random_waveform(1, 1 << 16, 777);
    const EasyWaveTable table = parse_easywave_csv(easywave_csv(w, dialect));
    ASSERT_EQ(table.volts.size(), w.codes.size());
    EXPECT_NEAR(table.frequency_hz, w.repetition_hz(), 1e-9);
    EXPECT_NEAR(table.amplitude_vpp, w.high_v - w.low_v, 1e-9);
    EXPECT_NEAR(table.offset_v, 0.5 * (w.high_v + w.low_v), 1e-9);
    const double half_step_v = 0.5 * w.amplitude_vpp() / (w.levels - 1);
    for (std::size_t j = 0; j < w.codes.size(); ++j)
      EXPECT_NEAR(table.volts[j], w.volts_of(w.codes[j]), half_step_v);
  }
}

TEST(Wvdt, ReadsBackExactly) {
  for (const auto points : {WvdtPoints::bits14_little_endian, WvdtPoints::bits14_big_endian,
                            WvdtPoints::bits16_little_endian}) {
    const bool is_16 = points == WvdtPoints::bits16_little_endian;
    const QuantizedWaveform w = random_waveform(2, is_16 ? 1 << 16 : 1 << 14, 1024);
    const WvdtCommand command = wvdt_command(w, points, 2);
    const FileBytes bytes = wvdt_bytes(command, points);
    const WvdtCommand back = parse_wvdt(bytes, points);
    EXPECT_EQ(back.points, command.points);
    EXPECT_EQ(back.channel, 2);
    EXPECT_EQ(back.name, w.name);
    EXPECT_EQ(back.slot, is_16 ? "" : "M50");
    EXPECT_EQ(text_of(bytes).find("LENGTH,2KB,") == std::string_view::npos, is_16);
    EXPECT_NEAR(back.frequency_hz, w.repetition_hz(), 1e-9);
    for (std::size_t j = 0; j < w.codes.size(); ++j)
      EXPECT_EQ(back.points[j] + w.levels / 2, w.codes[j]);
  }
}

TEST(KeysightArb, ReadsBackExactly) {
  for (const char* end : {"\n", "\r\n"}) {
    const QuantizedWaveform w = random_waveform(3, keysight_levels, 333);
    const KeysightArb arb = parse_keysight_arb(keysight_arb_text(w, end));
    ASSERT_EQ(arb.points.size(), w.codes.size());
    EXPECT_NEAR(arb.sample_rate_hz, w.sample_rate_hz, 1e-9);
    EXPECT_NEAR(arb.high_level_v, w.high_v, 1e-9);
    EXPECT_NEAR(arb.low_level_v, w.low_v, 1e-9);
    EXPECT_EQ(arb.marker_point, 167);
    for (std::size_t j = 0; j < w.codes.size(); ++j) EXPECT_EQ(arb.points[j] + 32767, w.codes[j]);
    EXPECT_EQ(parse_keysight_dac_bytes(keysight_dac_bytes(w)), arb.points);
  }
}

TEST(Tektronix, ReadsBackWithinHalfAStep) {
  const QuantizedWaveform w = random_waveform(4, 1 << 14, 512);
  EXPECT_EQ(parse_tektronix_tfw(tektronix_tfw(w)), w.codes);
  for (const char* end : {"\r\n", "\n", " \r\n"}) {
    const TektronixWfm wfm = parse_tektronix_wfm(tektronix_wfm(w, end));
    ASSERT_EQ(wfm.values.size(), w.codes.size());
    EXPECT_NEAR(wfm.sample_rate_hz, w.sample_rate_hz, 1e-3);
    for (std::size_t j = 0; j < w.codes.size(); ++j) {
      EXPECT_NEAR(0.5 * (wfm.values[j] + 1.0) * (w.levels - 1), w.codes[j], 0.5);
      EXPECT_EQ(wfm.markers[j], (j < 256 ? 1 : 0) + (j == 0 ? 2 : 0));
    }
  }
}

TEST(Ieee488Block, EndsWithItsData) {
  for (const std::size_t size : {0U, 1U, 9U, 10U, 12345U}) {
    const FileBytes data(size, std::byte{7}), block = ieee488_block(data);
    const std::span<const std::byte> back = parse_ieee488_block(block);
    EXPECT_EQ(FileBytes(back.begin(), back.end()), data);
    EXPECT_EQ(back.data() + back.size(), block.data() + block.size());
  }
}

TEST(WaveformWriters, RejectInvalidWaveforms) {
  QuantizedWaveform w = golden_waveform(1 << 14);
  EXPECT_THROW(keysight_arb_text(w), std::invalid_argument);
  EXPECT_THROW(wvdt_command(w, WvdtPoints::bits16_little_endian), std::invalid_argument);
  EXPECT_THROW(tektronix_tfw(golden_waveform(1 << 16)), std::invalid_argument);
  EXPECT_THROW(wvdt_bytes(wvdt_command(w, WvdtPoints::bits14_little_endian),
                          WvdtPoints::bits14_little_endian),
               std::invalid_argument);  // 8 points are less than a kilobyte
  w.codes[2] = 1 << 14;
  EXPECT_THROW(easywave_csv(w), std::invalid_argument);
  w = golden_waveform(1 << 14);
  w.name = "a,b";
  EXPECT_THROW(wvdt_command(w, WvdtPoints::bits14_little_endian), std::invalid_argument);
  w = golden_waveform(1 << 14);
  w.high_v = w.low_v;
  EXPECT_THROW(tektronix_wfm(w), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
