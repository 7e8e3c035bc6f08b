// SPDX-License-Identifier: MIT
#include "drivers/lcm/sequence_counter.h"

#include <utility>

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kEstablished = 8;  // messages in order that establish a sequence
constexpr std::int64_t kSuspect = 20;     // a message in order subtracts 1
constexpr std::int64_t kConvicted = 60, kMaxSuspicion = 100;
constexpr std::int64_t kMaxTime_us = 4'000'000'000'000'000'000;  // sums do not overflow
constexpr double kBuffered_s = 10;  // for which a network may hold messages back

double seconds(std::int64_t from_us, std::int64_t to_us) {
  return std::max(0.0, 1e-6 * (static_cast<double>(to_us) - static_cast<double>(from_us)));
}

bool is_rate(std::int64_t count, std::int64_t of) {
  return count >= SequenceWatch::kFew &&
         static_cast<double>(count) > SequenceWatch::kMost_ratio * static_cast<double>(of);
}

}  // namespace

std::uint64_t& SequenceCounter::Track::digest_of(std::int64_t sequence) {
  return digest[static_cast<std::size_t>(static_cast<std::uint64_t>(sequence) % digest.size())];
}

SequenceCounter::Verdict SequenceCounter::see(const Message& message) {
  Message m = message;
  m.arrival_us = std::clamp(m.arrival_us, -kMaxTime_us, kMaxTime_us);
  gives_held_ = false;
  if (!started_) return follow(m);
  follow_clock(m.arrival_us);
  Place place = place_of(m);
  const bool in_order = place == Place::next && m.sequence == track_.newest + 1;
  if (has_former_ && !in_order && place != Place::again && continues_former(m)) {
    track_ = former_;
    has_former_ = false;
    run_ = kEstablished;
    backwards -= leap_was_backwards_ ? 1 : 0;
    apart_until_us_ = m.arrival_us + kHold_us;
    place = Place::next;
  }
  if (has_pending_ && place != Place::elsewhere) {
    has_pending_ = false;
    ++others;
    apart_until_us_ = m.arrival_us + kHold_us;
  } else if (has_pending_ && goes_on_from_pending(m)) {
    has_pending_ = false;
    suspect(m);
    const Verdict verdict = follow(pending_);
    gives_held_ = verdict != Verdict::other;
    place = Place::next;
  }
  if (place == Place::elsewhere) return leap(m);
  track_.arrival_us = m.arrival_us;
  if (place == Place::again) return again(m);
  if (place == Place::next) return next(m);
  track_.seen |= std::uint64_t{1} << (track_.newest - m.sequence);
  track_.digest_of(m.sequence) = m.digest;
  --lost;
  ++reordered;
  return taken(m, Verdict::fresh);
}

SequenceCounter::Place SequenceCounter::place_of(const Message& m) const {
  std::int64_t step = 0;
  if (__builtin_sub_overflow(m.sequence, track_.newest, &step) || step > kMaxJump)
    return Place::elsewhere;
  if (step > 0) return step == 1 || is_loss(step, m) ? Place::next : Place::elsewhere;
  if (m.time_us > track_.time_us) {
    const bool repeated = step == 0 && suspicious() && run_ >= kEstablished;
    return repeated ? Place::again : Place::elsewhere;
  }
  if (step <= -kWindow) return Place::elsewhere;
  return (track_.seen & std::uint64_t{1} << -step) != 0 ? Place::again : Place::late;
}

/// Returns true if the time since the newest message allows that many samples.
bool SequenceCounter::is_loss(std::int64_t step, const Message& m) const {
  if (!suspicious()) return true;
  const double span_s = std::min(seconds(track_.time_us, m.time_us),
                                 seconds(track_.arrival_us, m.arrival_us) + kBuffered_s);
  return static_cast<double>(step) <= 1 + 1.5 * rate_hz_ * span_s;
}

bool SequenceCounter::continues_former(const Message& m) const {
  std::int64_t step = 0;
  if (__builtin_sub_overflow(m.sequence, former_.newest, &step)) return false;
  return step > 0 && step <= kEstablished && m.time_us > former_.time_us &&
         m.arrival_us - former_.arrival_us <= kSilent_us;
}

SequenceCounter::Verdict SequenceCounter::next(const Message& m) {
  const std::int64_t step = m.sequence - track_.newest;
  const bool is_backwards = m.time_us <= track_.time_us;
  lost += step - 1;
  track_.seen = (step < kWindow ? track_.seen << step : 0) | 1;
  track_.newest = m.sequence;
  track_.time_us = m.time_us;
  track_.digest_of(m.sequence) = m.digest;
  backwards += is_backwards ? 1 : 0;
  ++run_;
  suspicion_ = std::max<std::int64_t>(0, suspicion_ - 1);
  return taken(m, is_backwards ? Verdict::backwards : Verdict::fresh);
}

SequenceCounter::Verdict SequenceCounter::again(const Message& m) {
  const std::uint64_t known = track_.digest_of(m.sequence);
  ++duplicates;
  if (suspicious() && known != 0 && known != m.digest) {
    ++conflicts;
    suspect(m);
  }
  return Verdict::duplicate;
}

bool SequenceCounter::goes_on_from_pending(const Message& m) const {
  std::int64_t step = 0;
  return !__builtin_sub_overflow(m.sequence, pending_.sequence, &step) && step > 0 &&
         step <= kEstablished && m.time_us > pending_.time_us;
}

SequenceCounter::Verdict SequenceCounter::leap(const Message& m) {
  const bool silent = m.arrival_us - track_.arrival_us > kSilent_us;
  if (m.arrival_us < apart_until_us_ && !silent) {
    apart_until_us_ = m.arrival_us + kHold_us;
    ++others;
    return Verdict::other;
  }
  if (has_pending_ && m.sequence == pending_.sequence && m.digest == pending_.digest) {
    ++duplicates;
    return Verdict::duplicate;
  }
  ++leaps;
  leapt_from_ = track_.newest;
  leapt_to_ = m.sequence;
  others += has_pending_ ? 1 : 0;
  has_pending_ = suspicious() && !silent && m.sequence != track_.newest;
  if (!has_pending_) return follow(m);
  pending_ = m;
  return Verdict::held;
}

/// Continues the sequence from this message; earlier numbers do not count as lost.
SequenceCounter::Verdict SequenceCounter::follow(const Message& m) {
  const bool first = !std::exchange(started_, true);
  leap_was_backwards_ = !first && m.sequence < track_.newest && m.time_us <= track_.time_us;
  const bool former_is_old = m.arrival_us - former_.arrival_us > kSilent_us;
  const bool counts = !first && m.sequence != track_.newest;
  if (suspicious() && counts && (run_ >= kEstablished || !has_former_ || former_is_old)) {
    former_ = track_;
    has_former_ = true;
  }
  backwards += leap_was_backwards_ ? 1 : 0;
  track_ = {m.sequence, m.time_us, m.arrival_us, ~std::uint64_t{0}, {}};
  track_.digest_of(m.sequence) = m.digest;
  run_ = 0;
  return taken(m, leap_was_backwards_ ? Verdict::backwards : Verdict::fresh);
}

void SequenceCounter::suspect(const Message& m) {
  suspicion_ = std::min(suspicion_ + kSuspect, kMaxSuspicion);
  if (suspicion_ >= kConvicted) mixed_until_us_ = m.arrival_us + kHold_us;
}

SequenceCounter::Verdict SequenceCounter::taken(const Message& m, Verdict verdict) {
  if (m.arrival_us < mixed_until_us_) {
    ++others;
    return Verdict::other;
  }
  ++received;
  return verdict;
}

/// The receiver's clock may be set back.
void SequenceCounter::follow_clock(std::int64_t arrival_us) {
  for (std::int64_t* until_us : {&apart_until_us_, &mixed_until_us_})
    if (*until_us > arrival_us + kHold_us) *until_us = arrival_us + kHold_us;
  for (Track* track : {&track_, &former_})
    track->arrival_us = std::min(track->arrival_us, arrival_us);
}

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
