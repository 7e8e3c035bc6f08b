#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// The last server-sent events, the same for every viewer. Bounded: a viewer that has not read an
/// event before it is overwritten has lost it, and is told how many.
class EventRing {
 public:
  /// Where one viewer is.
  struct Cursor {
    std::uint64_t next = 0;  ///< number of the event it reads next
    std::string pending;     ///< what it has begun and not finished
    std::size_t offset = 0;  ///< of pending that it has
    std::uint64_t dropped = 0;
  };

  explicit EventRing(std::size_t capacity) : events_(capacity) {}

  void push(const std::string& name, const std::string& data);
  /// A viewer that joins now: `first` (whole events) comes before everything that follows.
  Cursor join(std::string first) const { return {count_, std::move(first), 0, 0}; }
  /// Copies what fits of what the viewer has not read; 0 when it has everything.
  std::size_t read(Cursor& cursor, char* buffer, std::size_t size) const;
  std::uint64_t count() const { return count_; }

  /// One event as it goes over the wire. `data` is one line.
  static std::string text(const std::string& name, const std::string& data);

 private:
  std::vector<std::string> events_;
  std::uint64_t count_ = 0;
};

}  // namespace framewatch::daemon
