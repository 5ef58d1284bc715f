// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulated_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace tofsmith {

namespace {

constexpr int poll_ms = 20;

[[noreturn]] void fail_with_errno(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

bool is_ready(int descriptor) {
  pollfd entry{descriptor, POLLIN, 0};
  return poll(&entry, 1, poll_ms) > 0;
}

bool send_all(int connection, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto sent = send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace

SimulatedServer::SimulatedServer(SimulatedGenerator generator, std::function<void()> on_end)
    : generator_(std::move(generator)), on_end_(std::move(on_end)) {
  listener_ = socket(AF_INET, SOCK_STREAM, 0);
  if (listener_ < 0) fail_with_errno("socket");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const place = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_, place, size) != 0 || listen(listener_, 4) != 0 ||
      getsockname(listener_, place, &size) != 0)
    fail_with_errno("listen on the loopback");
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

SimulatedServer::~SimulatedServer() {
  stops_ = true;
  thread_.join();
  close(listener_);
}

void SimulatedServer::serve() {
  while (!stops_) {
    if (!is_ready(listener_)) continue;
    const int connection = accept(listener_, nullptr, nullptr);
    if (connection < 0) continue;
    const int on = 1;
    setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    with_generator([](SimulatedGenerator& g) { g.reconnect(); });
    talk(connection);
    close(connection);
    if (on_end_) on_end_();
  }
}

void SimulatedServer::talk(int connection) {
  std::string buffer(65536, 'x');
  while (!stops_) {
    if (!is_ready(connection)) continue;
    const auto count = recv(connection, buffer.data(), buffer.size(), 0);
    if (count <= 0) return;
    bool closed = false;
    const std::string answers = with_generator([&](SimulatedGenerator& g) {
      std::string all = g.take({buffer.data(), static_cast<std::size_t>(count)});
      closed = g.closed();
      return all;
    });
    if (splits_ && answers.size() < 200) {
      for (const char c : answers)
        if (!send_all(connection, {&c, 1})) return;
    } else if (!send_all(connection, answers)) {
      return;
    }
    if (closed) return;
  }
}

}  // namespace tofsmith
