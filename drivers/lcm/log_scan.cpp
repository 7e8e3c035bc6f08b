// SPDX-License-Identifier: MIT
#include "drivers/lcm/log_scan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "drivers/files/big_endian.h"

namespace framewatch::drivers {
namespace {

constexpr std::array<std::uint8_t, 4> kSync{0xED, 0xA1, 0xDA, 0x01};
constexpr std::int64_t kSyncBytes = 4;
constexpr std::int64_t kSearchBytes = 1 << 18;

bool printable(std::uint8_t byte) {
  return byte >= 0x20 && byte != 0x7f;
}

}  // namespace

bool begins_with_sync(const std::uint8_t* bytes) {
  return std::memcmp(bytes, kSync.data(), kSyncBytes) == 0;
}

void LogScan::clear() {
  window_.clear();
  examined_bytes_ = 0;
}

bool LogScan::sync_at(std::int64_t offset) {
  const std::int64_t bytes = std::min(kSyncBytes, file_.size() - offset);
  examined_bytes_ += bytes;
  if (bytes == kSyncBytes && window_.holds(offset, bytes))
    return begins_with_sync(at(offset, bytes));
  std::array<std::uint8_t, kSyncBytes> word{};
  return file_.read(word.data(), bytes, offset) == bytes &&
         std::memcmp(word.data(), kSync.data(), static_cast<std::size_t>(bytes)) == 0;
}

std::int64_t LogScan::find_sync(std::int64_t from, std::int64_t limit) {
  const std::int64_t end = std::min(file_.size(), limit + kSyncBytes - 1);
  while (end - from >= kSyncBytes) {
    const std::int64_t bytes = std::min(kSearchBytes, end - from);
    const std::uint8_t* begin = at(from, bytes);
    if (begin == nullptr) return limit;
    const std::uint8_t* found = std::search(begin, begin + bytes, kSync.begin(), kSync.end());
    examined_bytes_ += found - begin;
    if (found != begin + bytes) return from + (found - begin);
    from += bytes - (kSyncBytes - 1);
  }
  return limit;
}

bool LogScan::read_header(std::int64_t offset, LogEventHeader& header, const char** why) {
  const auto refuse = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (!sync_at(offset)) return refuse("no sync word where an event should start");
  if (offset + kHeaderBytes > file_.size()) return refuse("the file ends inside an event's header");
  const std::uint8_t* bytes = at(offset, kHeaderBytes);
  if (bytes == nullptr) return refuse("unreadable");
  examined_bytes_ += kHeaderBytes;
  header.number = big_endian<std::int64_t>(bytes + 4);
  header.timestamp_us = big_endian<std::int64_t>(bytes + 12);
  header.channel_length = big_endian<std::int32_t>(bytes + 20);
  header.payload_length = big_endian<std::int32_t>(bytes + 24);
  if (header.channel_length < 1 || header.channel_length > kMaxChannel)
    return refuse("channel length out of bounds (1 to 63)");
  if (header.payload_length < 0 || header.payload_length > kMaxPayload)
    return refuse("payload length out of bounds (0 to 16 MiB)");
  header.end = offset + kHeaderBytes + header.channel_length + header.payload_length;
  const std::int64_t channel_bytes =
      std::min(header.channel_length, file_.size() - offset - kHeaderBytes);
  const std::uint8_t* channel = at(offset + kHeaderBytes, channel_bytes);
  if (channel == nullptr) return refuse("unreadable");
  examined_bytes_ += channel_bytes;
  if (!std::all_of(channel, channel + channel_bytes, printable))
    return refuse("channel name with unprintable characters");
  return true;
}

bool LogScan::well_followed(const LogEventHeader& header) {
  return header.end == file_.size() || (header.end < file_.size() && sync_at(header.end));
}

void OverlapScan::clear() {
  open_.clear();
  ends_.clear();
}

void OverlapScan::add(std::int64_t start, std::int64_t end) {
  for (; !ends_.empty(); ends_.pop_back()) {
    Candidate& before = open_[static_cast<std::size_t>(ends_.back() - dropped_)];
    if (before.end >= end) break;
    before.over = start;
  }
  ends_.push_back(dropped_ + std::ssize(open_));
  open_.push_back({start, end});
}

void OverlapScan::drop_before(std::int64_t offset) {
  for (; !open_.empty() && open_.front().start < offset; ++dropped_) {
    if (!ends_.empty() && ends_.front() == dropped_) ends_.pop_front();
    open_.pop_front();
  }
}

}  // namespace framewatch::drivers
