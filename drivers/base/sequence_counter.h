#pragma once

#include <cstdint>

namespace framewatch::drivers {

/// Counts what happened to one node's messages by their sequence numbers and sensor times.
class SequenceCounter {
 public:
  enum class Verdict { fresh, duplicate, backwards };

  /// A number never seen before counts as lost until it comes, at most kWindow numbers later. A
  /// smaller number with a newer time is a node that restarted; a jump by more than kMaxJump too.
  /// A larger number whose time is not newer, or a much smaller one whose time is older, is time
  /// running backwards: counted, still a sample.
  Verdict see(std::int64_t sequence, std::int64_t time_us);

  std::int64_t received = 0;  ///< fresh ones
  std::int64_t lost = 0;
  std::int64_t duplicates = 0;
  std::int64_t reordered = 0;  ///< came after a later one
  std::int64_t restarts = 0;
  std::int64_t backwards = 0;

  template <typename Archive>
  void archive(Archive& a) {
    a(received, lost, duplicates, reordered, restarts, backwards, started_, newest_);
    a(newest_time_us_, seen_);
  }

 private:
  static constexpr std::int64_t kWindow = 64;
  static constexpr std::int64_t kMaxJump = 10'000'000;

  Verdict restart(std::int64_t sequence, std::int64_t time_us);

  bool started_ = false;
  std::int64_t newest_ = 0;
  std::int64_t newest_time_us_ = 0;
  std::uint64_t seen_ = 0;  ///< bit i: newest_ - i has come
};

}  // namespace framewatch::drivers
