// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/instrument/scpi_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <utility>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t max_line = 65536, max_wave_header = 1000;
constexpr double block_bytes_per_s = 100e3, wait_slice_s = 0.05;

using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

}  // namespace

/// The time that a whole answer has, however many pieces it comes in.
class ScpiSession::AnswerTime {
 public:
  explicit AnswerTime(double seconds) : seconds_(seconds) {}

  double left_s() const { return seconds_ - seconds_since(start_); }
  double seconds() const { return seconds_; }
  /// Once it is known how many bytes are to come.
  void extend_for(std::size_t bytes) { seconds_ += static_cast<double>(bytes) / block_bytes_per_s; }

 private:
  SteadyClock::time_point start_ = SteadyClock::now();
  double seconds_;
};

std::string printable(std::string_view bytes, std::size_t max_bytes) {
  std::string text;
  for (const char c : bytes.substr(0, max_bytes)) {
    if (c >= ' ' && c <= '~')
      text += c;
    else
      fmt::format_to(std::back_inserter(text), "\\x{:02x}", static_cast<unsigned char>(c));
  }
  return bytes.size() > max_bytes ? text + fmt::format(".. ({} bytes)", bytes.size()) : text;
}

ScpiSession::ScpiSession(std::unique_ptr<InstrumentConnection> connection, double answer_s,
                         StopCheck check_stop)
    : connection_(std::move(connection)), answer_s_(answer_s), check_stop_(std::move(check_stop)) {
  require(answer_s_ > 0.0 && answer_s_ <= 3600.0, "answer_s", answer_s_, "must be in (0, 3600]");
}

void ScpiSession::fail(std::string_view problem) const {
  throw IoError(connection_->name(), last_sent_.empty()
                                         ? std::string(problem)
                                         : fmt::format("sent '{}': {}", last_sent_, problem));
}

void ScpiSession::expect_silence() {
  received_ += connection_->receive(0.0);
  skip_line_ends();
  if (!received_.empty())
    fail(fmt::format("'{}' came that was not asked for; is another program using the instrument?",
                     printable(received_)));
}

void ScpiSession::send(std::string_view message) {
  expect_silence();
  send_regardless(message);
}

void ScpiSession::send_regardless(std::string_view message) {
  last_sent_ = printable(message.substr(0, message.find('\n')));
  connection_->send(message, answer_s_ + static_cast<double>(message.size()) / block_bytes_per_s);
}

bool ScpiSession::receive_more(double seconds) {
  const auto start = SteadyClock::now();
  for (double waited_s = 0.0; waited_s < seconds;) {
    const double slice_s = std::min(wait_slice_s, seconds - waited_s);
    const std::string piece = connection_->receive(slice_s);
    received_ += piece;
    if (check_stop_) check_stop_();
    if (!piece.empty()) return true;
    // A connection without a clock of its own is done with every slice at once.
    waited_s = std::max(waited_s + slice_s, seconds_since(start));
  }
  return false;
}

void ScpiSession::fill(std::size_t bytes, std::string_view what, const AnswerTime& time) {
  while (received_.size() < bytes)
    if (!receive_more(time.left_s()))
      fail(fmt::format("found '{}' and no more within {:g} s; expected {}", printable(received_),
                       time.seconds(), what));
}

void ScpiSession::skip_line_ends() {
  received_.erase(0, std::min(received_.find_first_not_of("\r\n"), received_.size()));
}

std::string ScpiSession::take(std::size_t bytes) {
  std::string taken = received_.substr(0, bytes);
  received_.erase(0, bytes);
  return taken;
}

std::string ScpiSession::read_line(double more_s) {
  const AnswerTime time(answer_s_ + more_s);
  for (;;) {
    skip_line_ends();
    const std::size_t end = received_.find('\n');
    if (end != std::string::npos) {
      std::string line = take(end);
      received_.erase(0, 1);
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
      return line;
    }
    if (received_.size() > max_line)
      fail(fmt::format("found '{}'; expected a line of text", printable(received_)));
    if (!receive_more(time.left_s()))
      fail(received_.empty()
               ? fmt::format("no answer within {:g} s; expected one: does it speak SCPI, and know "
                             "this command? (--timeout waits longer)",
                             time.seconds())
               : fmt::format("found '{}' and no end of line within {:g} s", printable(received_),
                             time.seconds()));
  }
}

std::string ScpiSession::read_block(std::size_t max_bytes, double more_s) {
  AnswerTime time(answer_s_ + more_s);
  do {
    skip_line_ends();
    if (received_.empty()) fill(1, "a block of data", time);
  } while (received_.find_first_not_of("\r\n") != 0);
  const auto no_block = [&] {
    fail(fmt::format("found '{}'; expected a block of data, '#' and its length",
                     printable(received_)));
  };
  if (received_.front() != '#') no_block();
  fill(2, "a block's length", time);
  if (received_[1] < '1' || received_[1] > '9') no_block();
  const auto digits = static_cast<std::size_t>(received_[1] - '0');
  fill(2 + digits, "a block's length", time);
  std::size_t length = 0;
  const char* const begin = received_.data() + 2;
  const auto [end, error] = std::from_chars(begin, begin + digits, length);
  if (error != std::errc() || end != begin + digits) no_block();
  if (length > max_bytes)
    fail(fmt::format("found a block of {} bytes; expected at most {}", length, max_bytes));
  time.extend_for(length);
  fill(2 + digits + length, fmt::format("a block of {} bytes", length), time);
  received_.erase(0, 2 + digits);
  return take(length);
}

std::string ScpiSession::read_wave_data(std::size_t expected_bytes, std::size_t max_bytes) {
  constexpr std::string_view mark = "WAVEDATA,", length_key = "LENGTH,";
  std::size_t at = 0;
  AnswerTime time(answer_s_);
  for (;;) {
    skip_line_ends();
    at = received_.substr(0, max_wave_header).find(mark);
    if (at != std::string::npos) break;
    if (received_.size() >= max_wave_header || received_.find('\n') != std::string::npos)
      fail(fmt::format("found '{}'; expected a header that ends with '{}'", printable(received_),
                       mark));
    fill(received_.size() + 1, "a waveform's header and data", time);
  }
  std::size_t length = expected_bytes;
  const std::string header = received_.substr(0, at);
  if (const std::size_t key = header.find(length_key); key != std::string::npos) {
    const char* const begin = header.data() + key + length_key.size();
    const auto [end, error] = std::from_chars(begin, header.data() + header.size(), length);
    const std::size_t unit = end != header.data() + header.size() && *end == 'K' ? 1024 : 1;
    if (error != std::errc() || length > max_bytes / unit)
      fail(fmt::format("found '{}'; expected a LENGTH of at most {} bytes", printable(header, 200),
                       max_bytes));
    length *= unit;
  }
  const std::size_t whole = at + mark.size() + length;
  time.extend_for(length);
  fill(whole, fmt::format("{} bytes of points", length), time);
  return take(whole);
}

}  // namespace tofsmith
