// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <deque>
#include <system_error>
#include <thread>

#include "simulated_server.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/instrument/scpi_session.hpp"
#include "tofsmith/instrument/upload.hpp"
#include "upload_setup.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using Protocol = InstrumentAddress::Protocol;

TEST(InstrumentAddress, IsReadInAllItsForms) {
  const auto expect = [](const char* text, Protocol protocol, const char* host, int port) {
    EXPECT_EQ(parse_instrument_address(text), (InstrumentAddress{protocol, host, port})) << text;
  };
  expect("sdg", Protocol::raw_socket, "sdg", 5025);
  expect("10.0.0.7:4000", Protocol::raw_socket, "10.0.0.7", 4000);
  expect("tcp://bench-1.local", Protocol::raw_socket, "bench-1.local", 5025);
  expect("tcp://bench:5026", Protocol::raw_socket, "bench", 5026);
  expect("[fe80::1]:4000", Protocol::raw_socket, "fe80::1", 4000);
  expect("::1", Protocol::raw_socket, "::1", 5025);
  expect("vxi11://10.0.0.7", Protocol::vxi11, "10.0.0.7", 5025);
  expect("TCPIP::10.0.0.7::4000::SOCKET", Protocol::raw_socket, "10.0.0.7", 4000);
  expect("tcpip0::10.0.0.7::5025::socket", Protocol::raw_socket, "10.0.0.7", 5025);
  expect("TCPIP0::10.0.0.7::inst0::INSTR", Protocol::vxi11, "10.0.0.7", 5025);
  EXPECT_EQ(parse_instrument_address("::1").text(), "tcp://[::1]:5025");
  EXPECT_EQ(parse_instrument_address("vxi11://sdg").text(), "vxi11://sdg");
  for (const char* bad :
       {"", ":5025", "host:", "host:0", "host:65536", "host:5025x", "http://host", "tcp://", "a b",
        "-host", "host/5025", "[::1", "[::1]5025", "vxi11://", "TCPIP::host::SOCKET",
        "TCPIP::host::5025", "USB0::0xF4EC::0x1103::INSTR", "GPIB::10::INSTR"})
    EXPECT_THAT(problem_of([&] { parse_instrument_address(bad); }),
                HasSubstr("; must be host, host:port"))
        << bad;
}

TEST(GeneratorModel, IsKnownByWhatTheInstrumentSays) {
  const auto model_of = [](const char* answer) {
    return identified_model(parse_identity(answer, "here"), "here").name;
  };
  EXPECT_EQ(model_of("Siglent Technologies,SDG2042X,SDG2XCAX1R0001,2.01.01.35R3B2"), "SDG2042X");
  EXPECT_EQ(model_of("*IDN Siglent Technologies,SDG1032X,S1,1.01"), "SDG1032X");
  EXPECT_EQ(model_of("Agilent Technologies,33521A,MY50000001,1.08-1.19"), "33521");
  EXPECT_EQ(model_of("Keysight Technologies,33622A,MY1,A.02.03"), "33622");
  EXPECT_EQ(model_of("TEKTRONIX,AFG3252C,C012345,SCPI:99.0 FV:3.0.2"), "AFG3252");
  for (const char* other :
       {"RIGOL TECHNOLOGIES,DG4062,DG4,00.01", "Siglent Technologies,SDS1104X,S,1",
        "TEKTRONIX,AFG31022,C1,SCPI:99.0", "TEKTRONIX,SDG2042X,C1,1"})
    EXPECT_THAT(problem_of([&] { model_of(other); }),
                HasSubstr("expected one of Siglent SDG1000X"));
  for (const char* no_answer : {"", "hello", "a,b,c", "HTTP/1.1 400 Bad Request"})
    EXPECT_THAT(problem_of([&] { model_of(no_answer); }), HasSubstr("is this an instrument?"));
  EXPECT_THAT(problem_of([] { generator_model("SDG2024X"); }), HasSubstr("did you mean SDG2042X?"));
}

/// Gives pieces in turn, then nothing.
class ScriptedConnection : public InstrumentConnection {
 public:
  explicit ScriptedConnection(std::deque<std::string> pieces) : pieces_(std::move(pieces)) {}
  void send(std::string_view, double) override { sent_ = true; }
  std::string receive(double) override {
    if (!sent_ || pieces_.empty()) return "";
    std::string piece = pieces_.front();
    pieces_.pop_front();
    return piece;
  }
  std::string name() const override { return "here"; }

 private:
  std::deque<std::string> pieces_;
  bool sent_ = false;
};

ScpiSession session_of(std::deque<std::string> pieces) {
  ScpiSession session(std::make_unique<ScriptedConnection>(std::move(pieces)), 0.5);
  session.send("ASK?\n");
  return session;
}

TEST(ScpiSession, PutsPiecesTogether) {
  EXPECT_EQ(session_of({"\n", "4.", "0V\r", "\n"}).read_line(), "4.0V");
  EXPECT_EQ(session_of({"#", "1", "4a\nb", "c\n"}).read_block(10), "a\nbc");
  EXPECT_EQ(session_of({"#10\n"}).read_block(10), "");
  EXPECT_EQ(
      session_of({"C1:WVDT WVNM,a,LENGTH,4B,WAVE", "DATA,\n\n", "\n\n", "\n"}).read_wave_data(8, 8),
      "C1:WVDT WVNM,a,LENGTH,4B,WAVEDATA,\n\n\n\n");
  EXPECT_EQ(session_of({"WVDT WVNM,a,WAVEDATA,1234\n"}).read_wave_data(4, 8),
            "WVDT WVNM,a,WAVEDATA,1234");
}

TEST(ScpiSession, SaysWhatIsWrongWithAnAnswer) {
  const auto line = [](const char* piece) {
    return problem_of([&] { session_of({piece}).read_line(); });
  };
  EXPECT_EQ(line(""),
            "here: sent 'ASK?': no answer within 0.5 s; expected one: does it speak SCPI, "
            "and know this command? (--timeout waits longer)");
  EXPECT_EQ(line("4.0\x01"), "here: sent 'ASK?': found '4.0\\x01' and no end of line within 0.5 s");
  const auto block = [](const char* piece) {
    return problem_of([&] { session_of({piece}).read_block(10); });
  };
  for (const char* bad : {"abc\n", "#0\n", "#x1\n", "#2a1bc\n", "#2-1bc\n"})
    EXPECT_THAT(block(bad), HasSubstr("expected a block of data, '#' and its length")) << bad;
  EXPECT_THAT(block("#9999999999"),
              HasSubstr("found a block of 999999999 bytes; expected at most"));
  EXPECT_THAT(block("#15abc\n"), HasSubstr("expected a block of 5 bytes"));
  const auto wave = [](const char* piece) {
    return problem_of([&] { session_of({piece}).read_wave_data(4, 8); });
  };
  EXPECT_THAT(wave("hello\n"), HasSubstr("expected a header that ends with 'WAVEDATA,'"));
  EXPECT_THAT(wave("LENGTH,9B,WAVEDATA,"), HasSubstr("expected a LENGTH of at most 8 bytes"));
  EXPECT_THAT(wave("LENGTH,8B,WAVEDATA,123"), HasSubstr("expected 8 bytes of points"));
  ScpiSession session = session_of({"1\n", "2\n"});
  session.read_line();
  EXPECT_THAT(problem_of([&] { session.send("MORE\n"); }), HasSubstr("'2\\x0a' came that was not"));
}

SimulatedGenerator example_generator() { return {SimulatedGenerator::Family::keysight, "33522B"}; }

std::unique_ptr<InstrumentConnection> connected(int port, double deadline_s = 5.0) {
  return connect_instrument({Protocol::raw_socket, "127.0.0.1", port}, deadline_s);
}

/// Never stops giving the same piece, with a breath between.
class DrippingConnection : public InstrumentConnection {
 public:
  explicit DrippingConnection(std::string piece) : piece_(std::move(piece)) {}
  void send(std::string_view, double) override { sent_ = true; }
  std::string receive(double) override {
    if (!sent_) return "";
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return piece_;
  }
  std::string name() const override { return "here"; }

 private:
  std::string piece_;
  bool sent_ = false;
};

TEST(ScpiSession, AnswersThatNeverEndAreGivenUp) {
  for (const char* piece : {"\n", "x", "#"})
    for (const int kind : {0, 1, 2}) {
      ScpiSession session(std::make_unique<DrippingConnection>(piece), 0.1);
      session.send("*IDN?\n");
      EXPECT_THROW(kind == 0   ? session.read_line()
                   : kind == 1 ? session.read_block(1 << 20)
                               : session.read_wave_data(1 << 20, 1 << 20),
                   IoError)
          << piece << kind;
    }
}

TEST(ScpiSession, AnswersThatNeverEndCanBeStopped) {
  for (const int kind : {0, 1, 2}) {
    int calls = 0;
    ScpiSession session(std::make_unique<DrippingConnection>("\n"), 60.0, [&] {
      if (++calls > 3) throw Interrupted();
    });
    session.send("*IDN?\n");
    EXPECT_THROW(kind == 0   ? session.read_line()
                 : kind == 1 ? session.read_block(1 << 20)
                             : session.read_wave_data(1 << 20, 1 << 20),
                 Interrupted);
  }
}

TEST(ScpiSession, ALengthIsCheckedInItsUnit) {
  ScpiSession session(std::make_unique<ScriptedConnection>(
                          std::deque<std::string>{"C1:WVDT WVNM,x,LENGTH,2000000KB,WAVEDATA,"}),
                      0.1);
  session.send("C1:WVDT?\n");
  EXPECT_THAT(problem_of([&] { session.read_wave_data(100, 1 << 24); }),
              HasSubstr("expected a LENGTH of at most 16777216 bytes"));
}

TEST(TcpConnection, UploadsOverTheLoopback) {
  for (const FamilyExample& example : family_examples) {
    const GeneratorModel& model = generator_model(example.model);
    const UploadRequest request = example_request(model, 20000);
    UploadRequest small = request;
    for (UploadChannel& channel : small.channels)
      for (QuantizedWaveform& waveform : channel.stored) waveform.sample_rate_hz = 50e6;
    SimulatedServer server({example.family, example.answers});
    server.split_answers();
    ScpiSession session(connected(server.port()), 20.0);
    identified_model(identify(session), session.name());
    EXPECT_TRUE(upload(session, upload_script(model, small)).verified);
    EXPECT_TRUE(
        server.with_generator([&](SimulatedGenerator& g) { return plays(g, small, model); }));
  }
}

TEST(TcpConnection, FaultsOnTheLoopbackAreErrorsOrHarmless) {
  int failed = 0;
  for (int run = 0; run < 45; ++run) {
    const FamilyExample& example = family_examples[run % 3];
    const GeneratorModel& model = generator_model(example.model);
    const UploadRequest request = example_request(model, 24);
    SimulatedGenerator generator(example.family, example.answers);
    RandomStream random(5, static_cast<std::uint64_t>(run));
    generator.set_fault(static_cast<Fault>(1 + random() % (fault_kinds - 1)),
                        static_cast<int>(random() % 60), random());
    SimulatedServer server(std::move(generator));
    try {
      ScpiSession session(connected(server.port()), 0.1);
      identified_model(identify(session), session.name());
      ASSERT_TRUE(upload(session, upload_script(model, request)).verified);
      EXPECT_TRUE(
          server.with_generator([&](SimulatedGenerator& g) { return plays(g, request, model); }));
    } catch (const IoError& error) {
      ++failed;
      EXPECT_THAT(error.what(), HasSubstr("tcp://127.0.0.1:"));
    }
  }
  EXPECT_GT(failed, 15);
}

TEST(TcpConnection, SaysThatNothingIsThere) {
  int port = 0;
  { port = SimulatedServer(example_generator()).port(); }
  EXPECT_THAT(problem_of([&] { connected(port); }),
              HasSubstr("cannot connect (" + std::generic_category().message(ECONNREFUSED) +
                        "); check the address"));
  // A label of 64 letters is no name: nobody is asked for it.
  const std::string no_name(64, 'a');
  EXPECT_THAT(problem_of([&] {
                connect_instrument({Protocol::raw_socket, no_name, 5025}, 1.0);
              }),
              HasSubstr("there is no host 'aaaa"));
}

TEST(TcpConnection, SaysThatAnInstrumentHangsOrIsTheWrongOne) {
  SimulatedGenerator hangs = example_generator();
  hangs.set_fault(Fault::hangs, 0, 0);
  SimulatedServer busy(std::move(hangs));
  EXPECT_THAT(problem_of([&] {
                ScpiSession session(connected(busy.port()), 0.1);
                identify(session);
              }),
              HasSubstr("sent '*IDN?': no answer within 0.1 s"));
  // A second program finds the instrument taken: its connection is not served.
  SimulatedServer taken(example_generator());
  const auto first = connected(taken.port());
  EXPECT_THAT(problem_of([&] {
                ScpiSession session(connected(taken.port()), 0.1);
                identify(session);
              }),
              HasSubstr("no answer within 0.1 s"));
  SimulatedServer other({SimulatedGenerator::Family::keysight, "34465A"});
  EXPECT_THAT(problem_of([&] {
                ScpiSession session(connected(other.port()), 5.0);
                identified_model(identify(session), session.name());
              }),
              HasSubstr("found the instrument 34465A of Keysight Technologies; expected one of"));
}

TEST(TcpConnection, WaitingCanBeStopped) {
  SimulatedGenerator hangs = example_generator();
  hangs.set_fault(Fault::hangs, 0, 0);
  SimulatedServer server(std::move(hangs));
  ScpiSession session(connected(server.port()), 3600.0, [] { throw Interrupted(); });
  EXPECT_THROW(identify(session), Interrupted);
}

TEST(Vxi11, SaysWhenNobodyAnswersOrItIsNotThere) {
  const std::string problem = problem_of([] {
    ScpiSession session(connect_instrument({Protocol::vxi11, "127.0.0.1", 5025}, 0.5), 0.5);
    identify(session);
  });
  EXPECT_THAT(problem, HasSubstr("vxi11://127.0.0.1: "));
}

}  // namespace
}  // namespace tofsmith
