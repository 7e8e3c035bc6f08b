// SPDX-License-Identifier: MIT
#include "tests/support/mqtt_broker.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <stdexcept>
#include <utility>

namespace framewatch::test {
namespace {

constexpr std::uint8_t kConnect = 1, kConnack = 2, kPublish = 3, kSubscribe = 8, kSuback = 9,
                       kPing = 12, kPong = 13;
constexpr int kPoll_ms = 20;

/// Returns a text with its length before it, and moves `at` behind it.
std::string take_text(const std::string& body, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(body.at(i)); };
  const std::size_t size = 256u * byte(at) + byte(at + 1);
  std::string out = body.substr(at + 2, size);
  at += 2 + size;
  return out;
}

std::string with_size(const std::string& text) {
  return std::string{static_cast<char>(text.size() / 256), static_cast<char>(text.size() % 256)} +
         text;
}

std::string packet(std::uint8_t first, const std::string& body) {
  std::string out(1, static_cast<char>(first));
  std::size_t left = body.size();
  do {
    const std::size_t more = left > 127 ? 128 : 0;
    out += static_cast<char>(left % 128 + more);
    left /= 128;
  } while (left > 0);
  return out + body;
}

/// Reads exactly so many bytes. Returns false at the end of the connection.
bool read_bytes(int descriptor, std::string& out, std::size_t size) {
  out.resize(size);
  return size == 0 ||
         ::recv(descriptor, out.data(), size, MSG_WAITALL) == static_cast<ssize_t>(size);
}

}  // namespace

MqttBroker::MqttBroker(int port) : MqttBroker(port, Faults{}) {}

MqttBroker::MqttBroker(int port, Faults faults)
    : faults_(std::move(faults)), listening_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const int on = 1;
  ::setsockopt(listening_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof(address);
  if (::bind(listening_.get(), any, size) != 0 || ::listen(listening_.get(), 4) != 0 ||
      ::getsockname(listening_.get(), any, &size) != 0)
    throw std::runtime_error("cannot listen on 127.0.0.1");
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { work(); });
}

MqttBroker::~MqttBroker() {
  stop_ = true;
  thread_.join();
}

std::vector<std::string> MqttBroker::topics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return topics_;
}

std::string MqttBroker::user() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return user_;
}

std::string MqttBroker::password() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return password_;
}

void MqttBroker::publish(const std::string& topic, const std::string& payload, bool retained) {
  const std::lock_guard<std::mutex> lock(mutex_);
  send(packet(static_cast<std::uint8_t>(kPublish << 4 | (retained ? 1 : 0)),
              with_size(topic) + payload));
}

void MqttBroker::hang_up() {
  const std::lock_guard<std::mutex> lock(mutex_);
  client_.reset(-1);
  topics_.clear();
}

void MqttBroker::work() {
  while (!stop_) {
    std::array<pollfd, 2> waiting{{{listening_.get(), POLLIN, 0}, {-1, POLLIN, 0}}};
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      waiting[1].fd = client_.get();
    }
    if (::poll(waiting.data(), waiting.size(), kPoll_ms) <= 0) continue;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting[0].revents != 0) {
      client_.reset(::accept4(listening_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      topics_.clear();
      ++connections_;
    } else if (waiting[1].revents != 0 && client_.get() == waiting[1].fd && !read_packet()) {
      client_.reset(-1);
      topics_.clear();
    }
  }
}

/// Reads one packet of the client and answers it. Returns false if the connection has ended.
bool MqttBroker::read_packet() {
  std::string byte, body;
  if (!read_bytes(client_.get(), byte, 1)) return false;
  const auto kind = static_cast<std::uint8_t>(static_cast<std::uint8_t>(byte[0]) >> 4);
  std::size_t size = 0;
  for (int shift = 0; shift < 28; shift += 7) {
    if (!read_bytes(client_.get(), byte, 1)) return false;
    size |= static_cast<std::size_t>(byte[0] & 0x7f) << shift;
    if ((byte[0] & 0x80) == 0) break;
  }
  if (!read_bytes(client_.get(), body, size)) return false;
  if (!faults_.silent) answer(kind, body);
  return true;
}

void MqttBroker::answer(std::uint8_t kind, const std::string& body) {
  if (kind == kConnect) {
    const auto flags = static_cast<std::uint8_t>(body.at(7));
    std::size_t at = 10;  // behind name, level, flags and keepalive
    (void)take_text(body, at);
    user_ = (flags & 0x80) != 0 ? take_text(body, at) : "";
    password_ = (flags & 0x40) != 0 ? take_text(body, at) : "";
    send(packet(kConnack << 4, {'\0', static_cast<char>(faults_.answer)}));
  } else if (kind == kSubscribe) {
    std::string granted = body.substr(0, 2);
    for (std::size_t at = 2; at < body.size(); ++at) {  // behind a topic is its quality of service
      const std::string topic = take_text(body, at);
      const bool refused = faults_.refused.contains(topic);
      granted += refused ? '\x80' : '\0';
      if (!refused) topics_.push_back(topic);
    }
    send(packet(kSuback << 4, granted));
  } else if (kind == kPing) {
    send(packet(kPong << 4, ""));
  }
}

void MqttBroker::send(const std::string& bytes) {
  (void)::send(client_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

}  // namespace framewatch::test
