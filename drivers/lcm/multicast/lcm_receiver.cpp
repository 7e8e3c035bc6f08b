// SPDX-License-Identifier: MIT
#include "drivers/lcm/multicast/lcm_receiver.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <utility>

namespace framewatch::drivers {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kPoll_ms = 1000, kAfterFailure_ms = 100;
constexpr std::chrono::seconds kJoinAgain{5};
constexpr std::size_t kMaxSpare = 64, kMaxSpareBytes = 65536;

void signal(int event) {
  const std::uint64_t one = 1;
  (void)!::write(event, &one, sizeof one);
}

void clear(int event) {
  std::uint64_t count = 0;
  (void)!::read(event, &count, sizeof count);
}

}  // namespace

LcmReceiver::LcmReceiver(std::vector<std::string> channels, std::size_t queue_capacity)
    : capacity_(queue_capacity),
      assembly_([this](std::string_view channel) {
        return queued_.find(channel) != queued_.end();  // the channels never change
      }),
      waiting_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  for (std::string& channel : channels) queued_.emplace(std::move(channel), 0);
}

LcmReceiver::~LcmReceiver() {
  if (!thread_.joinable()) return;
  signal(stop_.get());
  thread_.join();
}

bool LcmReceiver::open(const MulticastGroup& group, std::string& error) {
  if (waiting_.get() < 0 || stop_.get() < 0) {
    error = std::strerror(errno);
    return false;
  }
  if (!socket_.open(group, error)) return false;
  thread_ = std::thread([this] { work(); });
  return true;
}

void LcmReceiver::work() {
  std::array<pollfd, 2> wait{{{socket_.descriptor(), POLLIN, 0}, {stop_.get(), POLLIN, 0}}};
  for (Clock::time_point next_join = Clock::now() + kJoinAgain;;) {
    ::poll(wait.data(), wait.size(), kPoll_ms);
    if (wait[1].revents != 0) return;
    if (Clock::now() >= next_join) {
      socket_.join_again();
      next_join = Clock::now() + kJoinAgain;
    }
    bool good = false;
    try {
      good = socket_.read([this](const Datagram& d) { datagram(d); });
    } catch (const std::exception&) {  // out of memory: the message being received is lost
    }
    failed_ = !good;
    if (!good) ::poll(&wait[1], 1, kAfterFailure_ms);
    const std::lock_guard<std::mutex> lock(mutex_);
    counters_.from_elsewhere = socket_.from_elsewhere();
    counters_.overflowed = socket_.overflowed();
    counters_.unfinished = assembly_.unfinished();
  }
}

void LcmReceiver::datagram(const Datagram& datagram) {
  const std::optional<LcmPacket> packet = parse_lcm_packet(datagram.bytes);
  auto outcome = FragmentAssembly::Outcome::refused;
  if (packet && packet->parts == 1 && packet->part == 0) {
    if (packet->payload.size() == packet->message_bytes)
      return queue(packet->channel, packet->payload, datagram);
  } else if (packet) {
    outcome = assembly_.add(datagram.sender, *packet, joined_channel_, joined_payload_);
  }
  if (outcome == FragmentAssembly::Outcome::whole)
    return queue(joined_channel_, joined_payload_, datagram);
  if (outcome != FragmentAssembly::Outcome::refused) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counters_.malformed;
}

void LcmReceiver::queue(std::string_view channel, std::span<const std::uint8_t> payload,
                        const Datagram& datagram) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto queued = queued_.find(channel);
  if (queued == queued_.end()) return;
  if (queued->second == capacity_ || queued_bytes_ + payload.size() > kMaxQueuedBytes) {
    ++counters_.queue_full;
    return;
  }
  ReceivedMessage message;
  if (!spare_.empty()) {
    message = std::move(spare_.back());
    spare_.pop_back();
  }
  message.channel.assign(channel);
  message.payload.assign(payload.begin(), payload.end());
  message.received_us = datagram.received_us;
  message.sender = datagram.sender;
  queued_bytes_ += payload.size();
  ++queued->second;
  queue_.push_back(std::move(message));
  if (queue_.size() == 1) signal(waiting_.get());
}

bool LcmReceiver::take(ReceivedMessage& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (queue_.empty()) return false;
  if (spare_.size() < kMaxSpare && message.payload.capacity() <= kMaxSpareBytes)
    spare_.push_back(std::move(message));
  message = std::move(queue_.front());
  queue_.pop_front();
  --queued_.find(message.channel)->second;
  queued_bytes_ -= message.payload.size();
  if (queue_.empty()) clear(waiting_.get());
  return true;
}

std::size_t LcmReceiver::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return queue_.size();
}

ReceiverCounters LcmReceiver::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

}  // namespace framewatch::drivers
