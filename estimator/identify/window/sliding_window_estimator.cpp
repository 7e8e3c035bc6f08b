// SPDX-License-Identifier: MIT
#include "estimator/identify/window/sliding_window_estimator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/identify/elements/story_design.h"
#include "estimator/identify/groups/group_tuning.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/identify/regressors/regressor_tuning.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr int kBlocks = BatchMeans::kBlocks;  // blocks per window
/// Share of the main window with rows that is enough for standard errors, except for the first rows
/// of a start.
constexpr double kWarm = 0.75 * BatchMeans::kFewest / BatchMeans::kBlocks;

}  // namespace

SlidingWindowEstimator::SlidingWindowEstimator(const PipelineConfig& config,
                                               const ParameterTable& table)
    : config_(config),
      options_(config_.options),
      matched_(options_.variant == Variant::matched || table.grouped()),
      table_(table),
      layout_(config_.structure, table_, config_.axes),
      deformations_(layout_.grouped()
                        ? nullptr
                        : std::make_unique<Deformations>(config_.structure, layout_, config_.axes)),
      axis_motion_(layout_.grouped()
                       ? std::make_unique<AxisMotion>(static_cast<int>(config_.axes.size()))
                       : nullptr),
      triple_(triple_of(options_, layout_.grouped(), 0)),
      high_pass_(options_.high_pass_hz, options_.rate_hz),
      blocks_(kBlocks),
      block_rows_(std::max(2, rows_of(options_.window_s / kBlocks, options_.rate_hz))),
      hop_rows_(rows_of(options_.hop_s, options_.rate_hz)),
      other_blocks_(blocks_of(options_.other_windows_s, options_.rate_hz, block_rows_)),
      integrator_(triples_of(options_, layout_.grouped(), config_.axes), high_pass_),
      noise_(config_.axes, options_.rate_hz),
      ring_(motion_source(),
            SelfTuning::ring_rows(kept_beside(options_, layout_.grouped()) +
                                  longest_window(block_rows_, other_blocks_) + triple_.length())),
      drift_(config_, table_, layout_, block_rows_,
             longest_window(block_rows_, other_blocks_) / block_rows_),
      series_(config_.structure, layout_, table_, options_, kWarm, other_blocks_, block_rows_),
      estimate_(static_cast<std::size_t>(table_.size())),
      nothing_(config_.axes.size(), kNaN) {
  boxplots_.reserve(estimate_.value.size());  // a copy would not keep reserved memory
  for (std::size_t p = 0; p < estimate_.value.size(); ++p)
    boxplots_.emplace_back(options_.boxplot_windows);
  seen_axes_.assign(layout_.grouped() ? config_.axes.size() : 0, 1);
  identified_from_ = seen_axes_;
  shown_.assign(static_cast<std::size_t>(layout_.unknowns()), 0);
  retuned_by_.assign(shown_.size(), 1.0);
  std::unique_ptr<RowTuning> tuning = make_tuning(options_);
  for (int part = 0; part < tuning->parts(); ++part) tuning->tune(part);
  active_ = make_regression(std::move(tuning));
  if (options_.self_tune && matched_)
    self_tuning_ =
        std::make_unique<SelfTuning>(layout_, table_, make_regression(active_->tuning().copy()),
                                     kBlocks, triple_.length(), noise_.configured());
  if (self_tuning_)
    late_ = std::make_unique<LateWindows>(
        config_, table_, layout_, kWarm, other_blocks_, block_rows_,
        longest_window(block_rows_, other_blocks_) / block_rows_, hop_rows_);
  if (options_.long_window_s > 0)
    long_ = std::make_unique<LongWindow>(config_.structure, layout_, table_, options_, block_rows_,
                                         static_cast<int>(other_blocks_.size()) + 1,
                                         noise_.configured());
  if (layout_.grouped() && table_[table_.size() - 1].kind == ParameterKind::bending_stiffness)
    bending_ = std::make_unique<HeldBending>(config_.structure, layout_, table_, options_,
                                             block_rows_, noise_.configured(), theta0());
  if (matched_)
    check_ = std::make_unique<ModelCheck>(
        config_, table_, layout_, window_rows(),
        [this](const EstimatorOptions& options) { return make_tuning(options); });
  if (bending_) hold_bending();
}

std::unique_ptr<RowTuning> SlidingWindowEstimator::make_tuning(
    const EstimatorOptions& options) const {
  const Structure& structure = config_.structure;
  const GroupDesign design = story_design(config_);
  if (layout_.grouped())
    return std::make_unique<GroupTuning>(config_, options, table_, layout_, design, triple_,
                                         high_pass_);
  return std::make_unique<RegressorTuning>(structure, layout_, *deformations_, options, triple_,
                                           high_pass_, design.theta);
}

std::unique_ptr<TunedRegression> SlidingWindowEstimator::make_regression(
    std::unique_ptr<RowTuning> tuning) const {
  return std::make_unique<TunedRegression>(std::move(tuning), layout_, blocks_, block_rows_,
                                           other_blocks_);
}

void SlidingWindowEstimator::start_tuned(const Tuning& tuning) {
  if (!self_tuning_) return;
  self_tuning_->start_tuned(active_, tuning);
  regression_exchanged();
}

std::optional<Tuning> SlidingWindowEstimator::tuning() const {
  if (!self_tuning_ || !noise_known()) return std::nullopt;
  return Tuning{theta0(), noise_density(), tuned()};
}

std::vector<int> SlidingWindowEstimator::other_window_rows() const {
  std::vector<int> rows;
  for (const int blocks : other_blocks_) rows.push_back(blocks * block_rows_);
  if (long_) rows.push_back(long_->rows());
  return rows;
}

void SlidingWindowEstimator::restart() {
  sane_ = true;
  integrator_.reset();
  ring_.reset();
  drift_.restart();
  active_->start(0);
  if (self_tuning_) self_tuning_->restart();
  series_.restart();
  if (late_) late_->end();
  if (check_) check_->restart();
  since_hop_ = 0;
}

void SlidingWindowEstimator::forget_motion() {
  if (long_) long_->retuned();
  if (bending_) bending_->restart();
  ++interruptions_;
  restart();
}

void SlidingWindowEstimator::recover() {
  noise_.reset();
  forget_motion();
}

const WindowEstimate* SlidingWindowEstimator::push(const SampleSet& set) {
  other_ = nullptr;
  if (set.index != expected_index_) {
    if (expected_index_ >= 0) ++interruptions_;
    if (expected_index_ < 0 || steps_to(set.time) != 1) restart();
  }
  expected_index_ = set.index + 1;
  advance(set.accel, set.time);
  // The first sets only fill the filters: a window cannot end before the first sample.
  const bool given = due_ && ring_.end() > triple_.length();
  if (given) fill_estimate(set.time - duration_of(triple_.delay, options_.rate_hz));
  return given ? &estimate_ : nullptr;
}

int SlidingWindowEstimator::missing_before(const SampleSet& set) const {
  if (expected_index_ < 0 || set.index == expected_index_) return 0;
  const double missing = steps_to(set.time) - 1;
  const int longest = active_->sums().longest_rows();
  return missing >= 0 && missing <= longest ? static_cast<int>(missing) : 0;
}

double SlidingWindowEstimator::steps_to(Time time) const {
  const auto us = static_cast<double>((time - last_time_).count());
  return std::round(us * 1e-6 * options_.rate_hz);
}

void SlidingWindowEstimator::push_missing() {
  advance(nothing_, last_time_ + duration_of(1, options_.rate_hz));
}

void SlidingWindowEstimator::advance(const std::vector<double>& accel, Time time) {
  other_ = nullptr;
  if (!sane_) recover();
  last_time_ = time;
  integrator_.push(accel);
  noise_.push(accel);
  motion_source().compute(integrator_, ring_.push());
  drift_.push(ring_.at(ring_.end() - 1));
  if (layout_.grouped()) follow_axes(ring_.at(ring_.end() - 1).known);
  due_ = ++since_hop_ >= hop_rows_;
  if (due_) since_hop_ = 0;
  const Time window_end = time - duration_of(triple_.delay, options_.rate_hz);
  const WindowSeries::Done done =
      series_.advance(*active_, {&ring_, trust(), tuned(), due_, &drift_, window_end});
  other_ = done.other;
  errors_new_ = done.errors_new;
  if (done.block) sane_ = active_->sums().sane();
  if (done.closed)
    block_closed(window_end);
  else
    go_on();
  model_fit_ =
      check_ && ring_.end() > triple_.length()
          ? check_->advance({&series_.main(), &ring_, trust(), tuned(),
                             active_->sums().rows() >= window_rows(), errors_new_, window_end})
          : nullptr;
  if (!self_tuning_) return;
  const bool was_tuned = tuned();
  if (self_tuning_->step(active_, ring_)) regression_exchanged();
  if (!was_tuned && tuned()) look_back();
  late_budget_ = self_tuning_->work_per_instant();
}

void SlidingWindowEstimator::block_closed(Time window_end) {
  const std::vector<std::uint8_t>& known = ring_.at(ring_.end() - 1).known;
  if (long_) long_->block_closed(active_->sums(), known, window_end);
  if (bending_) bending_->block_closed(active_->sums(), known, window_end);
}

/// Does the work that is spread over the instants between two block ends.
void SlidingWindowEstimator::go_on() {
  if (errors_new_) check_tuning();
  if (long_ && other_ == nullptr) advance_long();
  if (bending_ &&
      bending_->advance({active_.get(), &ring_.at(ring_.end() - 1).known, trust(), tuned()}))
    hold_bending();
}

void SlidingWindowEstimator::advance_long() {
  other_ = long_->advance(
      {active_.get(), &ring_.at(ring_.end() - 1).known, {matched_, noise_.configured()}, tuned()});
  if (other_ == nullptr || !self_tuning_ || self_tuning_->tuned() || !self_tuning_->due()) return;
  // While no ordinary window shows a parameter, the filters are tuned to the long windows.
  const WindowSolution& solution = long_->solution();
  for (std::size_t u = 0; u < shown_.size(); ++u) shown_[u] = solution.shown(static_cast<int>(u));
  self_tuning_->begin_check(*active_, solution.solver().solution(), solution.std_error(), shown_,
                            noise_);
}

void SlidingWindowEstimator::hold_bending() {
  for (const HeldBending::Held& held : bending_->held()) {
    const double ratio = held.value / theta0()[held.parameter];
    series_.hold(held.unknown, ratio, held.std_error);
    if (late_) late_->hold(held.unknown, ratio, held.std_error);
    if (check_) check_->hold(held.unknown, ratio, held.std_error);
  }
}

void SlidingWindowEstimator::fill_estimate(Time end) {
  estimate_.end = end;
  estimate_.rows = active_->suffices() ? active_->sums().rows() : 0;
  estimate_.start = end - duration_of(std::max(estimate_.rows - 1, 0), options_.rate_hz);
  ++estimate_.sequence;
  series_.main().fill({&theta0(), &ring_.at(ring_.end() - 1).known, tuned()}, estimate_);
  for (int p = 0; p < table_.elements(); ++p)
    estimate_.amplitude[static_cast<std::size_t>(p)] = drift_.rms(p, blocks_);
  for (std::size_t p = 0; p < boxplots_.size(); ++p) {
    boxplots_[p].push(estimate_.value[p]);
    estimate_.boxplot[p] = boxplots_[p].statistics();
    if (estimate_.reason[p] != Observability::observable) continue;
    estimate_.last_value[p] = estimate_.value[p];
    estimate_.last_std_error[p] = estimate_.std_error[p];
    estimate_.last_end[p] = end;
  }
}

}  // namespace framewatch::estimator
