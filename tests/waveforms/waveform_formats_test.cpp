// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Writers of waveform formats, compared with their readers and with golden files that
// golden/make_golden.py writes from the layouts in docs/formats.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "waveform_readers.hpp"
#include "waveforms/generator_scripts.hpp"
#include "waveforms/keysight.hpp"
#include "waveforms/siglent.hpp"
#include "waveforms/tektronix.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

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
    const EasyWaveTable table = parse_easywave_csv(easywave_csv(w, dialect), "a.csv");
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
    const WvdtCommand back = parse_wvdt(wvdt_bytes(command, points), points, "WVDT");
    EXPECT_EQ(back.points, command.points);
    EXPECT_EQ(back.channel, 2);
    EXPECT_EQ(back.name, w.name);
    EXPECT_EQ(back.slot, is_16 ? "" : "M50");
    EXPECT_NEAR(back.frequency_hz, w.repetition_hz(), 1e-9);
    for (std::size_t j = 0; j < w.codes.size(); ++j)
      EXPECT_EQ(back.points[j] + w.levels / 2, w.codes[j]);
  }
}

TEST(Wvdt, ReadsAnswersOfGenerators) {
  const std::string answer = "WVDT POS, user/a.bin, WVNM, a_1, LENGTH, 6B, TYPE, 5, WAVEDATA,";
  EXPECT_THAT(io_error_of([&] {
                parse_wvdt(bytes_of(answer + "abcdef"), WvdtPoints::bits16_little_endian, "USER");
              }),
              HasSubstr("USER: byte 0: found no FREQ"));
  const WvdtCommand back =
      parse_wvdt(bytes_of("C2:WVDT WVNM,a_1,FREQ,2000.0HZ,AMPL,4.0V,OFST,-0.5V,PHASE,0.0,WAVEDATA,"
                          "\x01\x02\xff\xff\n"),
                 WvdtPoints::bits16_little_endian, "USER");
  EXPECT_EQ(back.points, (std::vector<std::int16_t>{0x0201, -1}));
  EXPECT_EQ(back.frequency_hz, 2000.0);
  EXPECT_EQ(back.offset_v, -0.5);
}

TEST(KeysightArb, ReadsBackExactly) {
  for (const char* end : {"\n", "\r\n"}) {
    const QuantizedWaveform w = random_waveform(3, keysight_levels, 333);
    const KeysightArb arb = parse_keysight_arb(keysight_arb_text(w, end), "a.arb");
    ASSERT_EQ(arb.points.size(), w.codes.size());
    EXPECT_NEAR(arb.sample_rate_hz, w.sample_rate_hz, 1e-9);
    EXPECT_NEAR(arb.high_level_v, w.high_v, 1e-9);
    EXPECT_NEAR(arb.low_level_v, w.low_v, 1e-9);
    EXPECT_EQ(arb.marker_point, 167);
    for (std::size_t j = 0; j < w.codes.size(); ++j) EXPECT_EQ(arb.points[j] + 32767, w.codes[j]);
    EXPECT_EQ(parse_keysight_dac_bytes(keysight_dac_bytes(w), "DAC"), arb.points);
  }
}

TEST(Tektronix, ReadsBackWithinHalfAStep) {
  const QuantizedWaveform w = random_waveform(4, 1 << 14, 512);
  EXPECT_EQ(parse_tektronix_tfw(tektronix_tfw(w), "a.tfw"), w.codes);
  for (const char* end : {"\r\n", "\n", " \r\n"}) {
    const TektronixWfm wfm = parse_tektronix_wfm(tektronix_wfm(w, end), "a.wfm");
    ASSERT_EQ(wfm.values.size(), w.codes.size());
    EXPECT_NEAR(wfm.sample_rate_hz, w.sample_rate_hz, 1e-3);
    for (std::size_t j = 0; j < w.codes.size(); ++j) {
      EXPECT_NEAR(0.5 * (wfm.values[j] + 1.0) * (w.levels - 1), w.codes[j], 0.5);
      EXPECT_EQ(wfm.markers[j], (j < 256 ? 1 : 0) + (j == 0 ? 2 : 0));
    }
  }
}

TEST(Ieee488Block, ReadsBackAndRejectsInvalidBlocks) {
  for (const std::size_t size : {0U, 1U, 9U, 10U, 12345U}) {
    FileBytes data(size, std::byte{7});
    FileBytes block = ieee488_block(data);
    block.push_back(std::byte{'\n'});
    const Ieee488Block back = parse_ieee488_block(block, "answer");
    EXPECT_EQ(FileBytes(back.data.begin(), back.data.end()), data);
    EXPECT_EQ(back.size + 1, block.size());
  }
  EXPECT_THAT(io_error_of([] { parse_ieee488_block(bytes_of("*14abcd"), "answer"); }),
              HasSubstr("answer: byte 0: found no '#'"));
  EXPECT_THAT(io_error_of([] { parse_ieee488_block(bytes_of("#0abcd"), "answer"); }),
              HasSubstr("byte 1: found '0'"));
  EXPECT_THAT(io_error_of([] { parse_ieee488_block(bytes_of("#2x4abcd"), "answer"); }),
              HasSubstr("found 'x' in the length"));
  EXPECT_THAT(io_error_of([] { parse_ieee488_block(bytes_of("#15abcd"), "answer"); }),
              HasSubstr("expected 1 more bytes of the block's data"));
}

TEST(WaveformReaders, RejectTruncatedAndDamagedFiles) {
  const std::pair<std::string, FileParser> readers[] = {
      {"siglent_easywave.csv", [](auto b) { parse_easywave_csv(text_of(b), "f"); }},
      {"siglent_16.wvdt", [](auto b) { parse_wvdt(b, WvdtPoints::bits16_little_endian, "f"); }},
      {"siglent_14_big.wvdt", [](auto b) { parse_wvdt(b, WvdtPoints::bits14_big_endian, "f"); }},
      {"keysight.arb", [](auto b) { parse_keysight_arb(text_of(b), "f"); }},
      {"tektronix.tfw", [](auto b) { parse_tektronix_tfw(b, "f"); }},
      {"tektronix.wfm", [](auto b) { parse_tektronix_wfm(b, "f"); }}};
  for (const auto& [name, parse] : readers) {
    SCOPED_TRACE(name);
    EXPECT_GT(expect_damage_read_or_refused(golden(name), 200, 5, parse), 20);
  }
  for (const std::size_t i : {3U, 4U}) {
    FileBytes whole = golden(readers[i].first);
    if (i == 3) whole.resize(whole.size() - 7);  // the last point and the end of the one before
    expect_truncations_refused(whole, readers[i].second);
  }
}

TEST(WaveformReaders, ReportThePlaceAndTheProblem) {
  const std::string csv = easywave_csv(golden_waveform(1 << 14));
  const auto csv_error = [&](const std::string& from, const std::string& to) {
    std::string changed = csv;
    changed.replace(changed.find(from), from.size(), to);
    return io_error_of([&] { parse_easywave_csv(changed, "a.csv"); });
  };
  EXPECT_THAT(csv_error("amp,2", "amp;2"), HasSubstr("a.csv:3: found 'amp;2"));
  EXPECT_THAT(csv_error("\r\n\r\n", "\r\nx\r\n"),
              HasSubstr("a.csv:6: found 'x'; expected 7 blank"));
  EXPECT_THAT(csv_error("length,8", "length,9"), HasSubstr("the text ends here"));
  EXPECT_THAT(csv_error("length,8", "length,7"), HasSubstr("expected the end of the file"));
  EXPECT_THAT(csv_error("\r\n8,", "\r\n8,x"), HasSubstr("a.csv:21: value: found 'x1.5'"));
  EXPECT_THAT(io_error_of([] {
                parse_keysight_arb("File Format:1.10\nSample Rate:1\nData Points:1\nData:\n40000\n",
                                   "a.arb");
              }),
              HasSubstr("a.arb:5: found '40000'; expected a whole number in [-32767, 32767]"));
  // Little-endian points with set high bits are invalid as big-endian ones.
  EXPECT_THAT(io_error_of([] {
                parse_wvdt(golden("siglent_14_little.wvdt"), WvdtPoints::bits14_big_endian, "w");
              }),
              HasSubstr("expected 14 bits (is the byte order right?)"));
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
