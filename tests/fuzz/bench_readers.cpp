// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What comes from a bench: waveform files read back, records of instruments, answers of generators.
#include <array>
#include <memory>

#include "reader.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/calibrate/instrument_table.hpp"
#include "tofsmith/io/npy.hpp"
#include "upload_setup.hpp"
#include "waveforms/pattern_memory.hpp"
#include "waveforms/shared/ieee488_block.hpp"
#include "waveforms/shared/keysight_arb.hpp"
#include "waveforms/shared/siglent_waveform.hpp"
#include "waveforms/shared/tektronix_waveform.hpp"

namespace tofsmith::fuzz {

namespace {

namespace fs = std::filesystem;

QuantizedWaveform small_waveform(std::int32_t levels, std::size_t points = 8) {
  QuantizedWaveform waveform;
  waveform.name = "modulation_1";
  waveform.levels = levels;
  waveform.codes = {0, 1, levels - 1, 2, levels / 2, 0, 3, 1};
  waveform.codes.resize(points);
  waveform.sample_rate_hz = 1e6;
  return waveform;
}

PatternMemory small_memory() {
  return {.comment = "a pattern",
          .word_bits = 6,
          .points_per_exposure = 3,
          .fields = {{"light", 0, 1}, {"tap_1", 1, 4}, {"trigger", 5, 1}},
          .words = {0, 1, 33, 7, 63, 2}};
}

void read_wvdt(Input bytes) {
  const auto points = static_cast<WvdtPoints>(take_choice(bytes, 3));
  parse_wvdt(bytes, points, "a.bin");
}

void read_pattern(Input bytes) {
  const auto syntax = static_cast<PatternSyntax>(take_choice(bytes, 6));
  parse_pattern(text_of(bytes), syntax, "a.coe");
}

std::vector<Bytes> pattern_seeds() {
  const PatternMemory memory = small_memory();
  std::vector<Bytes> all;
  for (const std::string& text :
       {xilinx_coe(memory), intel_mif(memory), verilog_mem(memory), systemverilog_package(memory),
        vhdl_package(memory), c_header(memory)})
    all.push_back(with_choice(all.size(), bytes_of(text)));
  return all;
}

std::vector<Bytes> wvdt_seeds() {
  std::vector<Bytes> all;
  for (const auto points : {WvdtPoints::bits14_little_endian, WvdtPoints::bits14_big_endian,
                            WvdtPoints::bits16_little_endian}) {
    const std::int32_t levels = points == WvdtPoints::bits16_little_endian ? 65536 : 16384;
    all.push_back(with_choice(
        all.size(), wvdt_bytes(wvdt_command(small_waveform(levels, 512), points), points)));
  }
  return all;
}

/// A block, and its data as points of a Keysight.
void read_block_of_points(Input bytes) {
  parse_keysight_dac_bytes(parse_ieee488_block(bytes, "here").data, "here");
}

void read_instrument_table_text(Input bytes) {
  const auto mark = static_cast<DecimalMark>(take_choice(bytes, 3));
  parse_instrument_table(text_of(bytes), "a.csv", mark);
}

constexpr std::array record_names = {"r.csv", "r.npy", "r.npz"};

fs::path record_file(Input bytes) {
  const fs::path path = scratch_file(record_names[take_choice(bytes, record_names.size())]);
  write_bytes(path, bytes);
  return path;
}

void read_record(Input bytes) { read_response_record(record_file(bytes), {.time_step_s = 1e-10}); }

void read_sweep_of_delays(Input bytes) {
  read_delay_sweep(record_file(bytes), {.samples = 12}).validate();
}

std::vector<Bytes> record_seeds() {
  std::string text = "time_ns,volts\n", delays = "delay_ns;a;b;c\n";
  for (int i = 0; i < 24; ++i) {
    text += std::to_string(i) + "e-1," + std::to_string(i % 7) + "\n";
    delays +=
        std::to_string(i * 3) + ";" + std::to_string(i % 7) + ",5;2;" + std::to_string(i) + "\n";
  }
  const std::vector<double> values(36, 0.5);
  return {with_choice(0, bytes_of(text)), with_choice(0, bytes_of(delays)),
          with_choice(1, serialize_npy(NpyArray::of<double>({36}, values))),
          with_choice(1, serialize_npy(NpyArray::of<double>({12, 3}, values))),
          with_choice(2, serialize_npz({{"corrfs", NpyArray::of<double>({12, 3}, values)}}))};
}

/// Gives pieces of an input, each with its length in two bytes ahead, one for each question.
class Answers : public InstrumentConnection {
 public:
  explicit Answers(Input bytes) : left_(bytes) {}
  void send(std::string_view message, double) override {
    if (message.find('?') != std::string_view::npos) ++asked_;
  }
  std::string receive(double) override {
    if (asked_ == 0) return "";
    if (left_.size() < 2) throw IoError(name(), "the connection is closed");
    --asked_;
    const auto announced = static_cast<std::size_t>(left_[0]) | static_cast<std::size_t>(left_[1])
                                                                    << 8;
    const std::size_t size = std::min(announced, left_.size() - 2);
    const std::string piece(text_of(left_.subspan(2, size)));
    left_ = left_.subspan(2 + size);
    return piece;
  }
  std::string name() const override { return "tcp://fuzzer:5025"; }

 private:
  Input left_;
  int asked_ = 0;
};

/// As Answers reads it.
Bytes piece_of(std::string_view answer) {
  Bytes piece = {static_cast<std::byte>(answer.size() & 0xff),
                 static_cast<std::byte>(answer.size() >> 8)};
  const Bytes bytes = bytes_of(answer);
  piece.insert(piece.end(), bytes.begin(), bytes.end());
  return piece;
}

/// Notes what a simulated generator answers.
class Recorder : public MemoryConnection {
 public:
  Recorder(SimulatedGenerator& generator, Bytes& into) : MemoryConnection(generator), into_(into) {}
  std::string receive(double deadline_s) override {
    const std::string piece = MemoryConnection::receive(deadline_s);
    const Bytes noted = piece.empty() ? Bytes() : piece_of(piece);
    into_.insert(into_.end(), noted.begin(), noted.end());
    return piece;
  }

 private:
  Bytes& into_;
};

UploadScript script_of(const FamilyExample& example) {
  const GeneratorModel& model = generator_model(example.model);
  return upload_script(model, example_request(model, 16));
}

/// A whole upload, of which the input is all that the generator says.
void read_answers(Input bytes) {
  static const std::array scripts = {script_of(family_examples[0]), script_of(family_examples[1]),
                                     script_of(family_examples[2])};
  const UploadScript& script = scripts[take_choice(bytes, scripts.size())];
  ScpiSession session(std::make_unique<Answers>(bytes), 1.0);
  identified_model(identify(session), session.name());
  upload(session, script);
}

std::vector<Bytes> answer_seeds() {
  std::vector<Bytes> all;
  for (const FamilyExample& example : family_examples) {
    SimulatedGenerator generator(example.family, example.answers);
    Bytes answers;
    {
      ScpiSession session(std::make_unique<Recorder>(generator, answers), 1.0);
      identify(session);
      upload(session, script_of(example));
    }
    all.push_back(with_choice(all.size(), answers));
  }
  return all;
}

/// One answer, read in each of the ways.
void read_one_answer(Input bytes) {
  const std::size_t way = take_choice(bytes, 4);
  if (way == 3) {
    const std::string answer(text_of(bytes));
    for (const char* const field : {"", "FRQ", "AMP"})
      answer_problem({.field = field, .wanted = 1000, .tolerance = 1}, answer);
    answer_problem({.texts = {"ON", "ARB"}, .within = true}, answer);
    return;
  }
  ScpiSession session(std::make_unique<Answers>(bytes), 1.0);
  session.send("ANSWER?????\n");
  if (way == 0) parse_identity(session.read_line(), "here");
  if (way == 1) session.read_block(4096);
  if (way == 2) session.read_wave_data(32, 4096);
}

}  // namespace

std::vector<Reader> waveform_readers() {
  return {
      {"arb", [](Input bytes) { parse_keysight_arb(text_of(bytes), "a.arb"); },
       [] {
         return std::vector<Bytes>{bytes_of(keysight_arb_text(small_waveform(keysight_levels)))};
       }},
      {"block", &read_block_of_points,
       [] {
         return std::vector<Bytes>{
             ieee488_block(keysight_dac_bytes(small_waveform(keysight_levels)))};
       }},
      {"easywave", [](Input bytes) { parse_easywave_csv(text_of(bytes), "a.csv"); },
       [] {
         std::vector<Bytes> all;
         for (const auto dialect :
              {EasyWaveDialect::easywave, EasyWaveDialect::lenth, EasyWaveDialect::commas})
           all.push_back(bytes_of(easywave_csv(small_waveform(16384), dialect)));
         return all;
       }},
      {"wvdt", &read_wvdt, &wvdt_seeds},
      {"tfw", [](Input bytes) { parse_tektronix_tfw(bytes, "a.tfw"); },
       [] { return std::vector<Bytes>{tektronix_tfw(small_waveform(tektronix_afg_levels))}; }},
      {"wfm", [](Input bytes) { parse_tektronix_wfm(bytes, "a.wfm"); },
       [] { return std::vector<Bytes>{tektronix_wfm(small_waveform(1024))}; }},
      {"pattern", &read_pattern, &pattern_seeds}};
}

std::vector<Reader> bench_readers() {
  return {{"instrument-table", &read_instrument_table_text,
           seeds({with_choice(0, bytes_of("Scope\nTime (us);CH1\n0,5;1,25\n1,5;-3\n")),
                  with_choice(1, bytes_of("# a\nt\tv\n1\t2e-3\n2\t3\n"))})},
          {"response", &read_record, &record_seeds},
          {"delay-sweep", &read_sweep_of_delays, &record_seeds},
          {"answer", &read_one_answer,
           seeds({with_choice(0, piece_of("Siglent Technologies,SDG2042X,S,1.0\r\n")),
                  with_choice(1, piece_of("#14abcd\n")),
                  with_choice(2, piece_of("C1:WVDT M50,LENGTH,4B,WAVEDATA,abcd\n")),
                  with_choice(3, bytes_of("C1:BSWV WVTP,ARB,FRQ,1000HZ,AMP,4V\n"))})},
          {"upload", &read_answers, &answer_seeds}};
}

}  // namespace tofsmith::fuzz
