// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace framewatch::drivers {

/// Counts lost, repeated and reordered messages of one node by their sequence numbers and sensor
/// times. When two senders send under one node with different numbers, it follows the first.
class SequenceCounter {
 public:
  /// `other`: ignore the message. Two senders use this node, and it belongs to the second sequence
  /// or nothing distinguishes the two. `held`: the first message after a leap; gives_held() later
  /// says whether it counts.
  enum class Verdict { fresh, duplicate, backwards, other, held };

  struct Message {
    std::int64_t sequence = 0;
    std::int64_t time_us = 0;     ///< sensor time
    std::int64_t arrival_us = 0;  ///< by the receiver's clock
    std::uint64_t digest =
        0;  ///< of the contents, to tell a repetition from a message of another sender
  };

  /// `rate_hz` is the rate of the node, which tells a loss from a leap. With 0 (unknown) no second
  /// sender is suspected, and a leap is more than kMaxJump forward, or backward with a newer time.
  explicit SequenceCounter(double rate_hz = 0) : rate_hz_(rate_hz) {}

  /// Takes a message and returns what to do with it.
  /// A number not seen before counts as lost until it comes, at most kWindow numbers later. If the
  /// time since the last message has no room for the loss, it is a leap; so is a smaller number
  /// with a newer time. A leap is followed when the next message continues it. When the numbers
  /// before the leap continue, two sequences interleave, and the first is followed until it is
  /// silent for kSilent_us. A larger number whose time is not newer, or a much smaller one whose
  /// time is older, means that time runs backwards: it is counted and still is a sample.
  Verdict see(const Message& message);
  Verdict see(std::int64_t sequence, std::int64_t time_us) {
    return see({sequence, time_us, time_us, 0});
  }

  /// Returns true if, after see(), the held message counts after all, before the current one.
  bool gives_held() const { return gives_held_; }
  /// Returns the arrival of the newest message followed, by the receiver's clock; 0 before the
  /// first one.
  std::int64_t newest_arrival_us() const { return track_.arrival_us; }
  /// Returns true if two senders were seen within the last kHold_us.
  bool contested(std::int64_t arrival_us) const {
    return arrival_us < apart_until_us_ || arrival_us < mixed_until_us_;
  }
  /// Returns the number before the newest leap; leapt_to() returns the one after it.
  std::int64_t leapt_from() const { return leapt_from_; }
  std::int64_t leapt_to() const { return leapt_to_; }

  static constexpr std::int64_t kSilent_us = 2'000'000;
  static constexpr std::int64_t kHold_us = 5'000'000;

  std::int64_t received = 0;  ///< fresh messages
  std::int64_t lost = 0;
  std::int64_t duplicates = 0;
  std::int64_t conflicts = 0;  ///< duplicates with other contents
  std::int64_t reordered = 0;  ///< came after a later one
  std::int64_t leaps = 0;      ///< the node restarted, or another sends under its number
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
    std::array<std::uint64_t, kWindow> digest{};  ///< by number modulo kWindow; 0: unknown

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
  Message pending_;             ///< the first message after a leap, until the next one confirms it
  Track track_;                 ///< the sequence followed
  Track former_;                ///< the sequence before the newest leap, if it had some length
  std::int64_t run_ = 0;        ///< messages in order since the newest leap
  std::int64_t suspicion_ = 0;  ///< rises with messages that one sender alone does not send
  std::int64_t apart_until_us_ = 0;  ///< until then the first of two sequences is followed
  std::int64_t mixed_until_us_ = 0;  ///< until then no sequence is followed: senders look alike
  std::int64_t leapt_from_ = 0, leapt_to_ = 0;
};

/// Turns something that goes wrong repeatedly into two pieces of news: it begins, and it is over
/// when it was not seen for kCalm_us.
class Trouble {
 public:
  static constexpr std::int64_t kCalm_us = 30'000'000;
  enum class News { begins, over };

  /// Updates the state. `bad`: it was seen now. `now_us` is a clock that may be set back. Returns
  /// news, if any.
  std::optional<News> update(bool bad, std::int64_t now_us) {
    bad_us_ = bad ? now_us : std::min(bad_us_, now_us);
    // Clocks in foreign logs may have any value: a difference beyond int64 counts as calm.
    const std::uint64_t calm_us =
        static_cast<std::uint64_t>(now_us) - static_cast<std::uint64_t>(bad_us_);
    if (bad == raised_ || (!bad && calm_us < std::uint64_t{kCalm_us})) return std::nullopt;
    raised_ = bad;
    return bad ? News::begins : News::over;
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(raised_);
    a.within(bad_us_, -2 * a.kMaxCount, 2 * a.kMaxCount);
  }

 private:
  bool raised_ = false;
  std::int64_t bad_us_ = 0;
};

/// Kinds of trouble with the numbers of a node's messages.
enum class SequenceTrouble {
  two_senders,  ///< two send under one node number
  leaps,        ///< numbers leap farther than any loss explains
  duplicates,   ///< more than kMost_ratio come twice
  losses,       ///< more than kMost_ratio are lost
};
inline constexpr std::size_t kSequenceTroubles = 4;

/// Watches the counters of one node and reports which trouble begins and which is over.
class SequenceWatch {
 public:
  static constexpr double kMost_ratio = 0.01;
  static constexpr std::int64_t kFew = 5;  ///< fewer messages are not a rate
  static constexpr std::size_t kSpan_s = 10;

  /// Running totals.
  struct Counts {
    std::int64_t received = 0, lost = 0, duplicates = 0, leaps = 0, contests = 0;

    template <typename Archive>
    void archive(Archive& a) {
      for (std::int64_t* count : {&received, &lost, &duplicates, &leaps, &contests})
        a.within(*count, -a.kMaxCount, a.kMaxCount);
    }
  };
  struct News {
    SequenceTrouble trouble;
    bool over = false;
    std::int64_t count = 0, of = 0;  ///< messages of the last kSpan_s seconds
  };

  /// Takes the counters; call it once a second. `arrival_us` is the receiver's clock. Returns the
  /// news of each trouble.
  std::array<std::optional<News>, kSequenceTroubles> update(const Counts& now,
                                                            std::int64_t arrival_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(seconds_, at_, troubles_);
  }

 private:
  std::array<Counts, kSpan_s> seconds_{};  ///< counts of 10 to 1 seconds ago, from at_ on
  std::uint64_t at_ = 0;
  std::array<Trouble, kSequenceTroubles> troubles_{};
};

}  // namespace framewatch::drivers
