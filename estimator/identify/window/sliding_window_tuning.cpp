// SPDX-License-Identifier: MIT
// The part of SlidingWindowEstimator that follows the identified parameters: it retunes filters,
// merges and splits groups of stories, and computes windows that were held back.
#include <utility>

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/identify/window/sliding_window_estimator.h"
#include "estimator/identify/window/tuned_regression.h"

namespace framewatch::estimator {
namespace {

/// A channel that is missing for less than this is waited for. After that, its floor becomes an
/// inner floor.
constexpr double kAxesSteady_s = 2;

}  // namespace

void SlidingWindowEstimator::follow_axes(const std::vector<std::uint8_t>& known) {
  if (known != seen_axes_) {
    seen_axes_ = known;
    axes_steady_rows_ = 0;
    return;
  }
  if (self_tuning_ == nullptr || !self_tuning_->idle()) return;
  for (std::size_t a = 0; a < known.size(); ++a)
    identified_from_[a] = known[a] != 0 && !config_.axes[a].check;
  if (identified_from_ == active_->tuning().axes()) return;
  if (++axes_steady_rows_ < options_.rate_hz * kAxesSteady_s ||
      !shows_groups(config_.structure, config_.axes, identified_from_))
    return;
  axes_steady_rows_ = 0;
  self_tuning_->begin_axes(*active_, identified_from_, identified());
}

/// Returns for every parameter the median of the last windows that showed it, trusted as far as
/// their errors allow (23).
RowTuning::Known SlidingWindowEstimator::identified() const {
  RowTuning::Known out{theta0(), {}};
  for (int p = 0; p < table_.size(); ++p) {
    const auto i = static_cast<std::size_t>(p);
    const double value = estimate_.boxplot[i].median;
    const bool known = value > 0;
    const double error =
        known ? estimate_.last_std_error[i] / value : design_tolerance(table_[p].kind);
    if (known) out.theta[p] *= trusted_ratio(value / out.theta[p], error);
    out.std_error.push_back(error);
  }
  return out;
}

void SlidingWindowEstimator::look_back() {
  late_until_ = ring_.end();
  self_tuning_->lend(*active_);
}

const WindowEstimate* SlidingWindowEstimator::late() {
  if (late_other_ != nullptr) return std::exchange(late_other_, nullptr);
  TunedRegression* const regression = self_tuning_ ? self_tuning_->lent() : nullptr;
  if (regression == nullptr) return nullptr;
  if (!late_->running()) {
    // Rows that leave are formed again, so their motion must still be held by then.
    const int until_then = regression->sums().lag() / self_tuning_->work_per_instant() + 2;
    late_->begin(*regression, ring_.begin_after(until_then), late_until_);
  }
  for (; late_budget_ > 0; --late_budget_) {
    if (late_->complete(*regression)) {
      late_->end();
      self_tuning_->give_back();
      return nullptr;
    }
    const auto ago = static_cast<double>(ring_.end() - 1 - regression->next());
    const Time end = last_time_ - duration_of(ago + triple_.delay, options_.rate_hz);
    const LateWindows::Given given = late_->advance(*regression, ring_, trust(), end);
    if (given.main == nullptr && given.other == nullptr) continue;
    --late_budget_;
    if (given.main == nullptr) return given.other;
    late_other_ = given.other;
    return given.main;
  }
  return nullptr;
}

void SlidingWindowEstimator::check_tuning() {
  if (!self_tuning_ || !self_tuning_->due()) return;
  for (std::size_t u = 0; u < shown_.size(); ++u)
    shown_[u] = series_.main().shown(static_cast<int>(u));
  self_tuning_->begin_check(*active_, series_.main().solver().solution(),
                            series_.main().std_error(), shown_, noise_);
}

void SlidingWindowEstimator::regression_exchanged() {
  for (int u = 0; u < layout_.unknowns(); ++u) {
    const int p = layout_.parameter_of(u);
    const double before = self_tuning_->before().tuning().theta0()[p];
    series_.main().rescale(u, before / theta0()[p]);
    retuned_by_[static_cast<std::size_t>(u)] = theta0()[p] / before;
  }
  series_.retuned();
  if (long_) long_->retuned();
  if (bending_) {
    bending_->retuned(retuned_by_);
    hold_bending();
  }
  if (check_) check_->regression_exchanged(active_->tuning());
}

}  // namespace framewatch::estimator
