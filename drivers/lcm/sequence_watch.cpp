#include "drivers/lcm/sequence_watch.h"

#include <cstddef>
#include <utility>

namespace framewatch::drivers {
namespace {

bool is_rate(std::int64_t count, std::int64_t of) {
  return count >= SequenceWatch::kFew &&
         static_cast<double>(count) > SequenceWatch::kMost_ratio * static_cast<double>(of);
}

}  // namespace

std::array<std::optional<SequenceWatch::News>, kSequenceTroubles> SequenceWatch::update(
    const Counts& now, std::int64_t arrival_us) {
  const Counts newest = seconds_[(at_ + kSpan_s - 1) % kSpan_s];
  const Counts before = std::exchange(seconds_[at_ % kSpan_s], now);
  ++at_;
  const std::int64_t received = now.received - before.received;
  const std::int64_t lost = now.lost - before.lost;
  const std::int64_t twice = now.duplicates - before.duplicates;
  const std::int64_t leaps = now.leaps - before.leaps, contests = now.contests - before.contests;
  struct Judged {
    std::int64_t count, of;
    bool bad;
  };
  const Judged judged[kSequenceTroubles] = {
      {contests, received + contests, now.contests > newest.contests},
      {leaps, received, now.leaps > newest.leaps},
      {twice, received + twice, is_rate(twice, received + twice)},
      {lost, received + lost, is_rate(lost, received + lost)},
  };
  std::array<std::optional<News>, kSequenceTroubles> out;
  for (std::size_t t = 0; t < kSequenceTroubles; ++t) {
    const auto news = troubles_[t].update(judged[t].bad, arrival_us);
    if (news)
      out[t] = News{static_cast<SequenceTrouble>(t), *news == Trouble::News::over, judged[t].count,
                    judged[t].of};
  }
  return out;
}

}  // namespace framewatch::drivers
