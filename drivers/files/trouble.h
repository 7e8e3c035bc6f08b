#pragma once

#include <algorithm>
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
  std::optional<News> look(bool bad, std::int64_t now_us) {
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

}  // namespace framewatch::drivers
