#pragma once

#include <array>
#include <cstdint>

namespace framewatch::drivers {

/// Counts what happened to one node's messages by their sequence numbers and sensor times. Of two
/// senders that number their messages each in its own way under one node it follows the first.
class SequenceCounter {
 public:
  /// other: to be left out, because two send under this node: of the second sequence, or of two
  /// that nothing tells apart. held: the first after a leap; gives_held() tells whether it counts.
  enum class Verdict { fresh, duplicate, backwards, other, held };

  struct Message {
    std::int64_t sequence = 0;
    std::int64_t time_us = 0;     ///< sensor time
    std::int64_t arrival_us = 0;  ///< by the receiver's clock
    std::uint64_t digest = 0;  ///< of what it holds, by which a repeated one is told from another's
  };

  /// rate_hz: at which the node numbers, which tells a loss from a leap. 0: not known; then nobody
  /// is suspected, and a leap is more than kMaxJump forward, or backward with a newer time.
  explicit SequenceCounter(double rate_hz = 0) : rate_hz_(rate_hz) {}

  /// A number never seen before counts as lost until it comes, at most kWindow numbers later,
  /// unless the time since the last one has no room for the loss: that is a leap, as is a smaller
  /// number with a newer time. A leap is followed when the next message goes on from it; when the
  /// numbers before it go on, two sequences interleave, and of them the first is followed until it
  /// is silent for kSilent_us. A larger number whose time is not newer, or a much smaller one whose
  /// time is older, is time running backwards: counted, still a sample.
  Verdict see(const Message& message);
  Verdict see(std::int64_t sequence, std::int64_t time_us) {
    return see({sequence, time_us, time_us, 0});
  }

  /// After see(): whether the message that was held counts after all, and before this one.
  bool gives_held() const { return gives_held_; }
  /// When the newest message that was followed came, by the receiver's clock; 0 before any.
  std::int64_t newest_arrival_us() const { return track_.arrival_us; }
  /// Whether two senders have been seen within the last kHold_us.
  bool contested(std::int64_t arrival_us) const {
    return arrival_us < apart_until_us_ || arrival_us < mixed_until_us_;
  }
  /// The numbers before and after the newest leap.
  std::int64_t leapt_from() const { return leapt_from_; }
  std::int64_t leapt_to() const { return leapt_to_; }

  static constexpr std::int64_t kSilent_us = 2'000'000;
  static constexpr std::int64_t kHold_us = 5'000'000;

  std::int64_t received = 0;  ///< fresh ones
  std::int64_t lost = 0;
  std::int64_t duplicates = 0;
  std::int64_t conflicts = 0;  ///< of the duplicates: what they hold differs
  std::int64_t reordered = 0;  ///< came after a later one
  std::int64_t leaps = 0;      ///< the node began anew, or its numbers are not its own
  std::int64_t backwards = 0;
  std::int64_t others = 0;

  template <typename Archive>
  void archive(Archive& a) {
    for (std::int64_t* count :
         {&received, &duplicates, &conflicts, &reordered, &leaps, &others, &run_})
      a.within(*count, 0, a.kMaxCount);
    for (std::int64_t* count : {&lost, &backwards}) a.within(*count, -a.kMaxCount, a.kMaxCount);
    for (std::int64_t* time :
         {&pending_.time_us, &pending_.arrival_us, &apart_until_us_, &mixed_until_us_})
      a.within(*time, -2 * a.kMaxCount, 2 * a.kMaxCount);
    a(started_, has_former_, leap_was_backwards_, track_, former_);
    a(has_pending_, pending_.sequence, pending_.digest, leapt_from_, leapt_to_);
    a.within(suspicion_, 0, 1000);
  }

 private:
  static constexpr std::int64_t kWindow = 64;
  static constexpr std::int64_t kMaxJump = 10'000'000;

  enum class Place { next, late, again, elsewhere };
  struct Track {
    std::int64_t newest = 0, time_us = 0, arrival_us = 0;
    std::uint64_t seen = 0;                       ///< bit i: newest - i has come
    std::array<std::uint64_t, kWindow> digest{};  ///< by number modulo kWindow; 0: not known

    std::uint64_t& digest_of(std::int64_t sequence);
    template <typename Archive>
    void archive(Archive& a) {
      a(newest, seen, digest);
      for (std::int64_t* time : {&time_us, &arrival_us})
        a.within(*time, -2 * a.kMaxCount, 2 * a.kMaxCount);
    }
  };

  bool suspicious() const { return rate_hz_ > 0; }
  Place place_of(const Message& message) const;
  bool is_loss(std::int64_t step, const Message& message) const;
  bool continues_former(const Message& message) const;
  Verdict next(const Message& message);
  Verdict again(const Message& message);
  Verdict leap(const Message& message);
  bool goes_on_from_pending(const Message& message) const;
  Verdict follow(const Message& message);
  void suspect(const Message& message);
  Verdict taken(const Message& message, Verdict verdict);
  void follow_clock(std::int64_t arrival_us);

  double rate_hz_;
  bool started_ = false, has_former_ = false, leap_was_backwards_ = false;
  bool has_pending_ = false, gives_held_ = false;
  Message pending_;                  ///< the first after a leap, that the next one shall confirm
  Track track_;                      ///< that is followed
  Track former_;                     ///< before the newest leap from a sequence of some length
  std::int64_t run_ = 0;             ///< messages in order since the newest leap
  std::int64_t suspicion_ = 0;       ///< rises with what one sender alone does not do
  std::int64_t apart_until_us_ = 0;  ///< of two sequences the first is followed
  std::int64_t mixed_until_us_ = 0;  ///< nothing tells two senders apart: none is followed
  std::int64_t leapt_from_ = 0, leapt_to_ = 0;
};

}  // namespace framewatch::drivers
