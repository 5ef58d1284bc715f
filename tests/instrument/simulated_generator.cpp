// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulated_generator.hpp"

#include <fmt/format.h>

#include <charconv>

#include "simulated_words.hpp"

namespace tofsmith {

SimulatedGenerator::SimulatedGenerator(Family family, const std::string& model)
    : family_(family), model_(model) {
  channels_[0].on = channels_[1].on = true;  // as the user before has left it
}

void SimulatedGenerator::set_fault(Fault fault, int message, std::uint32_t detail) {
  fault_ = fault;
  fault_message_ = message;
  detail_ = detail;
}

void SimulatedGenerator::reconnect() {
  received_.clear();
  closed_ = false;
}

void SimulatedGenerator::reset() {
  channels_ = {};
  for (Channel& channel : channels_) channel.load_ohm = 50.0;
  if (family_ == Family::keysight) memory_.clear();
  phases_locked_ = false;
}

bool SimulatedGenerator::strikes(Fault fault) {
  if (fault_ != fault || messages_ < fault_message_) return false;
  fault_ = Fault::none;
  return true;
}

std::string SimulatedGenerator::take(std::string_view bytes) {
  if (hangs_ || closed_) return "";
  std::string taken(bytes);
  if (taken.size() > 4) {
    if (strikes(Fault::closes_midway)) {
      closed_ = true;
      taken.resize(detail_ % taken.size());
    } else if (strikes(Fault::flips_bit_sent)) {
      char& c = taken[detail_ % taken.size()];
      c = static_cast<char>(c ^ static_cast<char>(1U << (detail_ >> 16) % 7));
    } else if (strikes(Fault::loses_byte_sent)) {
      taken.erase(detail_ % taken.size(), 1);
    }
  }
  received_ += taken;
  std::string answers, message;
  while (!hangs_ && next_message(message)) {
    answers += answer(message);
    ++messages_;
    if (closed_) break;
  }
  return answers;
}

bool SimulatedGenerator::next_message(std::string& message) {
  std::size_t end = received_.find('\n');
  if (family_ == Family::siglent && received_.starts_with("C") && received_.find(":WVDT ") < 4) {
    const std::size_t mark = received_.find("WAVEDATA,");
    if (mark == std::string::npos) return false;
    const std::size_t length = received_.find("LENGTH,");
    end = received_.size();  // without LENGTH: what has come at once
    if (length < mark) end = mark + 9 + std::strtoul(received_.c_str() + length + 7, nullptr, 10);
    if (received_.size() < end) return false;
    message = received_.substr(0, end);
    received_.erase(0, end);
    return true;
  }
  if (end == std::string::npos) return false;
  const std::size_t hash = received_.find('#');
  if (hash < end && hash + 1 < received_.size()) {
    const std::size_t digits = static_cast<std::size_t>(received_[hash + 1] - '0') % 10;
    if (received_.size() < hash + 2 + digits) return false;
    const std::size_t data = std::strtoul(received_.substr(hash + 2, digits).c_str(), nullptr, 10);
    end = received_.find('\n', std::min(hash + 2 + digits + data, received_.size()));
    if (end == std::string::npos) return false;
  }
  message = received_.substr(0, end);
  received_.erase(0, end + 1);
  return true;
}

std::string SimulatedGenerator::answer(const std::string& message) {
  if (strikes(Fault::closes)) {
    closed_ = true;
    return "";
  }
  if (strikes(Fault::hangs)) {
    hangs_ = true;
    return "";
  }
  const bool asks = message.find('?') != std::string::npos;
  if (!asks && strikes(Fault::ignores)) return "";
  if (!asks && strikes(Fault::reports_error)) {
    errors_.emplace_back("-222,\"Data out of range\"");
    return "";
  }
  const std::string reply = obey(message);
  return reply.empty() ? reply : spoiled(reply);
}

std::string SimulatedGenerator::spoiled(std::string answer) {
  if (strikes(Fault::swallows_answer)) return "";
  if (strikes(Fault::answers_garbage)) {
    for (char& c : answer)
      c = static_cast<char>((detail_ = detail_ * 1664525U + 1013904223U) >> 24);
    return answer + "\n";
  }
  if (strikes(Fault::flips_answer_bit)) {
    char& c = answer[detail_ % answer.size()];
    c = static_cast<char>(c ^ static_cast<char>(1U << (detail_ >> 16) % 8));
    return answer;
  }
  if (answer.front() == '#' && strikes(Fault::wrong_length)) {
    const auto last = static_cast<std::size_t>(answer[1] - '0') + 1;
    answer[last] = static_cast<char>('0' + (answer[last] - '0' + 1 + detail_ % 9) % 10);
    return answer;
  }
  if (strikes(Fault::closes_answering)) {
    closed_ = true;
    return answer.substr(0, detail_ % answer.size());
  }
  if (strikes(Fault::extra_line)) return answer + "0,\"No error\"\n";
  if (strikes(Fault::repeats_answer)) return answer + answer;
  return answer;
}

std::string SimulatedGenerator::obey(const std::string& message) {
  if (message == "*IDN?")
    return fmt::format("{},{},SN0001,1.0.3\n",
                       family_ == Family::siglent    ? "Siglent Technologies"
                       : family_ == Family::keysight ? "Keysight Technologies"
                                                     : "TEKTRONIX",
                       model_);
  if (message == "*RST") {
    reset();
    return "";
  }
  if (message == "*OPC?") return "1\n";
  if (message == "*CLS") {
    errors_.clear();
    return "";
  }
  if (family_ == Family::siglent) return obey_siglent(message);
  if (message == "SYST:ERR?") {
    if (errors_.empty()) return "0,\"No error\"\n";
    const std::string error = errors_.front();
    errors_.erase(errors_.begin());
    return error + "\n";
  }
  return family_ == Family::keysight ? obey_keysight(message) : obey_tektronix(message);
}

double SimulatedGenerator::setting(std::string_view text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  if (!strikes(Fault::other_value)) return value;
  constexpr double factors[] = {0.9, 1.02, 0.0, -1.0, 1000.0};
  return value * factors[detail_ % 5] + (value == 0.0 ? 0.25 : 0.0);
}

void SimulatedGenerator::store(std::string name, std::string points) {
  if (strikes(Fault::other_memory)) name += "X";
  if (!points.empty() && strikes(Fault::corrupts_point)) {
    char& c = points[detail_ % points.size()];
    c = static_cast<char>(c ^ static_cast<char>(1U << (detail_ >> 16) % 8));
  }
  if (strikes(Fault::truncates_points)) points.resize(detail_ % (points.size() + 1) / 2 * 2);
  memory_[name] = std::move(points);
}

std::string SimulatedGenerator::wave_data(const std::string& name) const {
  const auto found = memory_.find(name);
  if (found == memory_.end()) return "";  // as the real one: silence
  return fmt::format(
             "WVDT POS, WVNM, {}, LENGTH,{}B, TYPE,5, FREQ,1000, AMPL,4, OFST,0, PHASE,0, "
             "WAVEDATA,",
             name, found->second.size()) +
         found->second + "\n";
}

std::vector<std::int32_t> SimulatedGenerator::played_codes(int number) const {
  const Channel& channel = channels_.at(number - 1);
  const bool arbitrary = channel.function == (family_ == Family::tektronix ? "USER" : "ARB");
  const auto found = memory_.find(channel.waveform);
  if (!arbitrary || found == memory_.end()) return {};
  std::vector<std::int32_t> codes;
  for (std::size_t i = 0; 2 * i + 1 < found->second.size(); ++i) {
    const int word = word_at(found->second, i, family_ != Family::siglent);
    codes.push_back(family_ == Family::tektronix ? word
                    : family_ == Family::siglent ? as_signed(word) + 32768
                                                 : as_signed(word) + 32767);
  }
  return codes;
}

std::string SimulatedGenerator::obey_siglent(const std::string& message) {
  int n = 1;
  std::string rest;
  if (matches(message, "C@:WVDT WVNM,", n, rest)) {
    const std::size_t mark = rest.find("WAVEDATA,");
    store(rest.substr(0, rest.find(',')), rest.substr(mark + 9));
  } else if (matches(message, "WVDT? USER,", n, rest)) {
    return wave_data(rest);
  } else if (matches(message, "C@:OUTP?", n, rest)) {
    const Channel& c = channels_[n - 1];
    return fmt::format("C{}:OUTP {},LOAD,{},PLRT,NOR\n", n, c.on ? "ON" : "OFF",
                       c.load_ohm > 1e8 ? "HZ" : fmt::format("{:g}", c.load_ohm));
  } else if (matches(message, "C@:OUTP LOAD,", n, rest)) {
    channels_[n - 1].load_ohm = rest.starts_with("HZ") ? 1e9 : setting(rest);
  } else if (matches(message, "C@:OUTP O", n, rest)) {
    channels_[n - 1].on = rest == "N";
  } else if (matches(message, "C@:ARWV NAME,", n, rest)) {
    channels_[n - 1].waveform = rest;
  } else if (matches(message, "C@:ARWV?", n, rest)) {
    return fmt::format("C{}:ARWV INDEX,50,NAME,{}\n", n, channels_[n - 1].waveform);
  } else if (matches(message, "C@:SRATE MODE,", n, rest)) {
    channels_[n - 1].clock = rest.substr(0, rest.find(','));
    if (const std::size_t value = rest.find("VALUE,"); value != std::string::npos)
      channels_[n - 1].sample_rate_hz = setting(rest.substr(value + 6));
  } else if (matches(message, "C@:SRATE?", n, rest)) {
    const Channel& c = channels_[n - 1];
    return fmt::format("C{}:SRATE MODE,{}{}\n", n, c.clock,
                       c.clock == "TARB" ? fmt::format(",VALUE,{:.6g}Sa/s", c.sample_rate_hz) : "");
  } else if (matches(message, "C@:BSWV?", n, rest)) {
    const Channel& c = channels_[n - 1];
    return fmt::format(
        "C{}:BSWV WVTP,{},FRQ,{:.6g}HZ,PERI,{:.6g}S,AMP,{:.6g}V,OFST,{:.6g}V,HLEV,{:.6g}V,PHSE,{:g}"
        "\n",
        n, c.function, c.frequency_hz, 1 / c.frequency_hz, c.amplitude_vpp, c.offset_v,
        c.offset_v + c.amplitude_vpp / 2, c.phase);
  } else if (matches(message, "C@:BSWV WVTP,", n, rest)) {
    channels_[n - 1].function = rest;
  } else if (matches(message, "C@:BSWV FRQ,", n, rest)) {
    channels_[n - 1].frequency_hz = setting(rest);
  } else if (matches(message, "C@:BSWV AMP,", n, rest)) {
    channels_[n - 1].amplitude_vpp = setting(rest);
  } else if (matches(message, "C@:BSWV OFST,", n, rest)) {
    channels_[n - 1].offset_v = setting(rest);
  } else if (matches(message, "C@:BSWV PHSE,", n, rest)) {
    channels_[n - 1].phase = setting(rest);
  } else if (message == "MODE PHASELOCKED") {  // the other spelling is not understood
    phases_locked_ = true;
  } else if (message == "MODE?") {
    return phases_locked_ ? "MODE PHASE-LOCKED\n" : "MODE INDEPENDENT\n";
  }
  return "";
}

}  // namespace tofsmith
