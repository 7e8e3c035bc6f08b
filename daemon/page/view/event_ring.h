#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace framewatch::daemon {

/// The newest server-sent events, shared by all viewers. Bounded: a viewer that has not read an
/// event before it is overwritten loses it, and gets the number of lost events.
class EventRing {
 public:
  /// Reading position of one viewer.
  struct Cursor {
    std::uint64_t next = 0;  ///< number of the event it reads next
    std::string pending;     ///< an event of which a part is read
    std::size_t offset = 0;  ///< of pending that is read
    std::uint64_t dropped = 0;
  };

  explicit EventRing(std::size_t capacity) : events_(capacity) {}

  void push(const std::string& name, const std::string& data);
  /// Position of a viewer that joins now; it reads `first` (whole events) before new events.
  Cursor join(std::string first) const { return {count_, std::move(first), 0, 0}; }
  /// Copies as much unread text as fits; 0 when everything is read.
  std::size_t read(Cursor& cursor, char* buffer, std::size_t size) const;
  std::uint64_t count() const { return count_; }

  /// An event in the format of server-sent events. `data` is one line.
  static std::string text(const std::string& name, const std::string& data);

 private:
  std::vector<std::string> events_;
  std::uint64_t count_ = 0;
};

}  // namespace framewatch::daemon
