// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/instrument/scpi_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using Protocol = InstrumentAddress::Protocol;

[[noreturn]] void reject_address(std::string_view text, std::string_view problem) {
  reject("instrument", fmt::format("'{}'", text),
         fmt::format("{}; must be host, host:port, tcp://host:port, vxi11://host or "
                     "TCPIP::host::port::SOCKET",
                     problem));
}

int port_in(std::string_view digits, std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc() || end != digits.data() + digits.size() || port < 1 || port > 65535)
    reject_address(text, fmt::format("the port '{}' is not in 1 .. 65535", digits));
  return port;
}

std::string host_in(std::string_view host, std::string_view text) {
  if (host.empty()) reject_address(text, "there is no host");
  const bool plain = std::ranges::all_of(host, [](char c) {
    return is_letter_or_digit(c) || c == '.' || c == '-' || c == '_' || c == ':' || c == '%';
  });
  if (!plain || host.front() == '-')
    reject_address(text, fmt::format("'{}' is no name or number of a host", host));
  return std::string(host);
}

/// "host", "host:port", "[IPv6]:port", "IPv6"
InstrumentAddress host_and_port(std::string_view rest, std::string_view text) {
  InstrumentAddress address;
  if (rest.starts_with('[')) {
    const std::size_t end = rest.find(']');
    if (end == std::string_view::npos) reject_address(text, "there is no ']'");
    address.host = host_in(rest.substr(1, end - 1), text);
    rest.remove_prefix(end + 1);
    if (!rest.empty() && rest.front() != ':')
      reject_address(text, fmt::format("found '{}' behind the host", rest));
    if (!rest.empty()) address.port = port_in(rest.substr(1), text);
    return address;
  }
  const std::size_t colon = rest.find(':');
  const bool one_colon = colon != std::string_view::npos && colon == rest.rfind(':');
  address.host = host_in(one_colon ? rest.substr(0, colon) : rest, text);
  if (one_colon) address.port = port_in(rest.substr(colon + 1), text);
  return address;
}

std::string all_upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = upper_case(c);
  return upper;
}

/// "TCPIP0::host::5025::SOCKET", "TCPIP::host::INSTR", "TCPIP::host::inst0::INSTR"
InstrumentAddress visa_address(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find("::", begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 2;
  }
  const std::string bus = all_upper_case(parts.front()), kind = all_upper_case(parts.back());
  const bool network = bus.starts_with("TCPIP") && std::ranges::all_of(bus.substr(5), is_digit);
  if (!network) reject_address(text, fmt::format("'{}' is no network", parts.front()));
  InstrumentAddress address;
  address.host = host_in(parts.size() > 1 ? parts[1] : "", text);
  if (kind == "SOCKET" && parts.size() == 4) {
    address.port = port_in(parts[2], text);
    return address;
  }
  if (kind != "INSTR" || parts.size() < 3 || parts.size() > 4)
    reject_address(text, fmt::format("it ends with '{}'", parts.back()));
  address.protocol = Protocol::vxi11;
  return address;
}

}  // namespace

std::string InstrumentAddress::text() const {
  if (protocol == Protocol::vxi11) return "vxi11://" + host;
  const bool numeric_v6 = host.find(':') != std::string::npos;
  return fmt::format("tcp://{}{}{}:{}", numeric_v6 ? "[" : "", host, numeric_v6 ? "]" : "", port);
}

InstrumentAddress parse_instrument_address(std::string_view text) {
  const std::size_t scheme_end = text.find("://");
  if (scheme_end == std::string_view::npos) {
    const std::string upper = all_upper_case(text);
    for (const char* bus : {"TCPIP", "USB", "GPIB", "ASRL"})
      if (upper.starts_with(bus) && upper.find("::") != std::string::npos)
        return visa_address(text);
    return host_and_port(text, text);
  }
  const std::string_view scheme = text.substr(0, scheme_end), rest = text.substr(scheme_end + 3);
  if (scheme == "tcp") return host_and_port(rest, text);
  if (scheme != "vxi11") reject_address(text, fmt::format("'{}://' is not known", scheme));
  InstrumentAddress address;
  address.protocol = Protocol::vxi11;
  address.host = host_in(rest, text);
  return address;
}

}  // namespace tofsmith
