#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace framewatch::drivers {

/// Something that goes wrong again and again as one piece of news: it begins, and it is over when
/// nothing of it was seen for kCalm_us.
class Trouble {
 public:
  static constexpr std::int64_t kCalm_us = 30'000'000;
  enum class News { begins, over };

  /// bad: it was seen now. now_us: a clock that may be set back.
  std::optional<News> update(bool bad, std::int64_t now_us) {
    bad_us_ = bad ? now_us : std::min(bad_us_, now_us);
    // Clocks of foreign logs may be any number: a difference that fits no int64 is calm.
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

/// What can be wrong with the numbers of a node's messages.
enum class SequenceTrouble {
  two_senders,  ///< two send under one number
  leaps,        ///< the numbers leap farther than any loss
  duplicates,   ///< more than kMost_ratio comes twice
  losses,       ///< more than kMost_ratio is lost
};
inline constexpr std::size_t kSequenceTroubles = 4;

/// Judges the counters of one node once a second: which trouble begins, and which is over.
class SequenceWatch {
 public:
  static constexpr double kMost_ratio = 0.01;
  static constexpr std::int64_t kFew = 5;  ///< messages: so many are no rate yet
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

  /// To be called once a second; arrival_us: by the receiver's clock. News by trouble.
  std::array<std::optional<News>, kSequenceTroubles> update(const Counts& now,
                                                            std::int64_t arrival_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(seconds_, at_, troubles_);
  }

 private:
  std::array<Counts, kSpan_s> seconds_{};  ///< as it was 10 to 1 seconds ago, from at_ on
  std::uint64_t at_ = 0;
  std::array<Trouble, kSequenceTroubles> troubles_{};
};

}  // namespace framewatch::drivers
