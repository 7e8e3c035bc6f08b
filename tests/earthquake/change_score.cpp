// SPDX-License-Identifier: MIT
#include "tests/earthquake/change_score.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace framewatch::earthquake {
namespace {

constexpr double kUnchanged = 1e-9;
constexpr double kWithin = 2;          // allowed distance between sizes, in earlier errors
constexpr double kGrows = 1.05;        // allowed growth of an error by rounding
constexpr double kStandsStill_s = 15;  // after a second change of one group

bool names(const Announcement& a, int parameter) {
  return a.parameter == parameter && a.state != AnnouncementState::cleared;
}

/// Scores one element of a case.
class Judge {
 public:
  Judge(const ChangeCase& of, const ChangeRun& run, int parameter)
      : case_(of), run_(run), p_(static_cast<std::size_t>(parameter)) {
    double before = 0;
    for (const Loss& loss : case_.losses) {
      const double now = truth(loss.at_s);
      if (std::abs(now - before) > kUnchanged) moves_.push_back(loss.at_s);
      before = now;
    }
    // Losses at the same time count as one change.
    moves_.erase(std::unique(moves_.begin(), moves_.end()), moves_.end());
  }

  ElementScore score() const {
    ElementScore out;
    out.parameter = static_cast<int>(p_);
    out.truth = truth(ChangeCase::kEnd_s);
    double first_s = ElementScore::kNever;
    for (const Announcement& a : run_.said) {
      if (a.parameter != out.parameter || a.at_s < moves_.front()) continue;
      if (a.state == AnnouncementState::cleared) {
        ++out.cleared;
        continue;
      }
      ++out.said;
      first_s = std::min(first_s, a.at_s);
      if (a.sized && stands_still(a.at_s)) out.sizes.push_back(size_of(a, a.at_s));
    }
    if (out.said == 0) return out;
    out.delay_s = std::max(0.0, first_s - case_.visible_s(moves_.front()));
    for (std::size_t i = 0; i < kAfter_s.size(); ++i)
      out.shown[i] = shown(std::isinf(kAfter_s[i]) ? ChangeCase::kEnd_s : first_s + kAfter_s[i]);
    compare(out);
    return out;
  }

 private:
  double truth(double time_s) const { return case_.truth(time_s)[p_]; }
  /// Returns true if no further loss has changed the truth of a group shortly before.
  bool stands_still(double time_s) const {
    return std::none_of(moves_.begin() + 1, moves_.end(), [&](double moved_s) {
      return time_s >= moved_s && time_s < case_.visible_s(moved_s) + kStandsStill_s;
    });
  }
  Shown size_of(const Announcement& a, double time_s) const {
    const double now = truth(time_s);
    return {true, false, a.sized, a.ratio - now, a.std_error, now};
  }
  Shown shown(double time_s) const {
    if (time_s > ChangeCase::kEnd_s || !stands_still(time_s)) return {};
    const Announcement* newest = nullptr;
    for (const Announcement& a : run_.said)
      if (a.parameter == static_cast<int>(p_) && a.at_s <= time_s + 1e-6 &&
          a.at_s >= moves_.front())
        newest = &a;
    if (newest == nullptr) return {};
    if (newest->state == AnnouncementState::cleared) return {true, true};
    return size_of(*newest, time_s);
  }
  /// Compares later sizes with earlier ones while the truth is the same.
  static void compare(ElementScore& out) {
    for (std::size_t later = 1; later < out.sizes.size(); ++later)
      for (std::size_t earlier = 0; earlier < later; ++earlier) {
        const Shown &a = out.sizes[earlier], &b = out.sizes[later];
        if (std::abs(a.truth - b.truth) > kUnchanged) continue;
        const double moved = std::abs((b.error + b.truth) - (a.error + a.truth));
        ++out.pairs;
        out.pairs_within += moved <= kWithin * a.std_error ? 1 : 0;
        if (b.std_error > kGrows * a.std_error) out.error_grew = true;
      }
  }

  const ChangeCase& case_;
  const ChangeRun& run_;
  std::size_t p_;
  std::vector<double> moves_;  ///< times at which the true stiffness of the element changes, s
};

}  // namespace

CaseScore score_change(const ChangeCase& of, const ChangeRun& run) {
  CaseScore out;
  out.unlearned = static_cast<int>(run.without_baseline.size());
  const double from_s = of.losses.empty() ? ElementScore::kNever : of.losses.front().at_s;
  const std::vector<double> truth = of.truth(ChangeCase::kEnd_s);
  std::set<int> early, gains;
  for (const Announcement& a : run.said) {
    if (a.state == AnnouncementState::cleared) continue;
    ++out.said;
    if (a.parameter < 0) ++out.whole;
    if (a.at_s < from_s) early.insert(a.parameter);
    if (a.sized && a.ratio > 0) gains.insert(a.parameter);
  }
  out.early = static_cast<int>(early.size());
  out.gains = static_cast<int>(gains.size());
  for (int p = 0; p < static_cast<int>(run.watched.size()); ++p) {
    if (!run.watched[static_cast<std::size_t>(p)]) continue;
    if (std::abs(truth[static_cast<std::size_t>(p)]) > kUnchanged) {
      out.changed.push_back(Judge(of, run, p).score());
      continue;
    }
    ++out.unchanged;
    const Announcement* newest = nullptr;
    bool named = false;
    for (const Announcement& a : run.said) {
      if (a.parameter != p || a.at_s < from_s) continue;
      named = named || names(a, p);
      newest = &a;
    }
    out.neighbours += named ? 1 : 0;
    out.standing += newest != nullptr && newest->state != AnnouncementState::cleared ? 1 : 0;
  }
  return out;
}

}  // namespace framewatch::earthquake
