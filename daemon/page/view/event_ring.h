// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace framewatch::daemon {

/// Holds the newest server-sent events for all viewers. A viewer that does not read an event before
/// it is overwritten loses it and receives the number of lost events.
class EventRing {
 public:
  /// Reading position of one viewer.
  struct Cursor {
    std::uint64_t next = 0;  ///< number of the event to read next
    std::string pending;     ///< event that is partly read
    std::size_t offset = 0;  ///< bytes of `pending` that are read
    std::uint64_t dropped = 0;
  };

  explicit EventRing(std::size_t capacity) : events_(capacity) {}

  void push(const std::string& name, const std::string& data);
  /// Returns the position of a viewer that joins now. It reads `first` (whole events) before new
  /// events.
  Cursor join(std::string first) const { return {count_, std::move(first), 0, 0}; }
  /// Copies as much unread text as fits into `buffer`. Returns the number of bytes; 0 when
  /// everything is read.
  std::size_t read(Cursor& cursor, char* buffer, std::size_t size) const;
  std::uint64_t count() const { return count_; }

  /// Formats a server-sent event. data: one line.
  static std::string text(const std::string& name, const std::string& data);

 private:
  std::vector<std::string> events_;
  std::uint64_t count_ = 0;
};

}  // namespace framewatch::daemon
