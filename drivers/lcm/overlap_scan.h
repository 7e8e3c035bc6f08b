#pragma once

#include <cstdint>
#include <deque>

namespace framewatch::drivers {

/// Stretches [start, end) of a file, by ascending start. Says of the first one whether another
/// begins inside it and reaches past its end, in constant time per stretch all in all (next greater
/// elements by a monotonic stack).
class OverlapScan {
 public:
  static constexpr std::int64_t kNone = INT64_MAX;

  void clear();
  void add(std::int64_t start, std::int64_t end);
  /// Forgets those that begin before `offset`.
  void drop_before(std::int64_t offset);
  /// Start of the first one after the front that ends after it; kNone: none was added yet.
  std::int64_t reached_over_at() const { return open_.empty() ? kNone : open_.front().over; }

 private:
  struct Candidate {
    std::int64_t start, end;
    std::int64_t over = kNone;  ///< start of the first later one that ends after `end`
  };
  std::deque<Candidate> open_;
  std::int64_t dropped_ = 0;       ///< ever, from open_'s front: numbers stay what they are
  std::deque<std::int64_t> ends_;  ///< numbers of those without `over`; their ends do not ascend
};

}  // namespace framewatch::drivers
