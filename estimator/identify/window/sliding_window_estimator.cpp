#include "estimator/identify/window/sliding_window_estimator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/groups/axis_motion.h"
#include "estimator/identify/groups/group_tuning.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/identify/regressors/regressor_tuning.h"

namespace framewatch::estimator {
namespace {

constexpr int kBlocks = BatchMeans::kBlocks;  // per window
constexpr int kFewestBlocks = 4;              // of another window
/// Of the main window: blocks without rows would make standard errors too small.
constexpr double kWarm = 0.9;
/// A channel that is away for less is waited for; for longer, its floor becomes an inner one.
constexpr double kAxesSteady_s = 2;

DerivativeTriple triple_of(const EstimatorOptions& o, bool grouped, double advance) {
  if (grouped) return held_triple(o.rate_hz, advance);
  return o.variant == Variant::paper ? trapezoid_triple(o.rate_hz)
                                     : matched_triple(o.rate_hz, advance);
}

/// Acquisition subtracts whole samples of a delay from the stamps; the triple undoes the rest.
std::vector<DerivativeTriple> triples_of(const EstimatorOptions& o, bool grouped,
                                         const std::vector<SensorAxis>& axes) {
  std::vector<DerivativeTriple> triples;
  for (const SensorAxis& axis : axes) {
    const double samples = axis.delay * o.rate_hz;
    triples.push_back(triple_of(o, grouped, samples - std::round(samples)));
  }
  return triples;
}

int rows_of(double seconds, double rate) {
  return std::max(1, static_cast<int>(std::lround(seconds * rate)));
}

std::vector<int> blocks_of(const std::vector<double>& windows_s, double rate_hz, int block_rows) {
  std::vector<int> blocks;
  for (const double s : windows_s)
    blocks.push_back(
        std::max(kFewestBlocks, static_cast<int>(std::lround(s * rate_hz / block_rows))));
  return blocks;
}

/// Instants that the slowest possible row filter needs to settle: no corner is below the high-pass.
int longest_settle(const EstimatorOptions& o, bool grouped) {
  const double slowest_s = grouped
                               ? GroupTuning::kLongestSettle_s
                               : 3 / (std::min(o.filter_damping, 0.7) * 2 * M_PI * o.high_pass_hz);
  return rows_of(std::max(o.settle_s, slowest_s), o.rate_hz) + 1;
}

int longest_window(int block_rows, const std::vector<int>& other_blocks) {
  int longest = kBlocks;
  for (const int blocks : other_blocks) longest = std::max(longest, blocks);
  return longest * block_rows;
}

std::unique_ptr<MotionSource> motion_source(const Structure& structure, const FloorLayout& layout,
                                            const std::vector<SensorAxis>& axes) {
  if (layout.grouped()) return std::make_unique<AxisMotion>(static_cast<int>(axes.size()));
  return std::make_unique<Deformations>(structure, layout, axes);
}

SensorClock::duration duration_of(double rows, double rate_hz) {
  return SensorClock::duration(std::llround(rows * 1e6 / rate_hz));
}

}  // namespace

SlidingWindowEstimator::SlidingWindowEstimator(const PipelineConfig& config,
                                               const ParameterTable& table)
    : config_(config),
      options_(config_.options),
      matched_(options_.variant == Variant::matched || table.grouped()),
      table_(table),
      layout_(config_.structure, table_, config_.axes),
      motion_source_(motion_source(config_.structure, layout_, config_.axes)),
      triple_(triple_of(options_, layout_.grouped(), 0)),
      high_pass_(options_.high_pass_hz, options_.rate_hz),
      blocks_(kBlocks),
      block_rows_(std::max(2, rows_of(options_.window_s / kBlocks, options_.rate_hz))),
      hop_rows_(rows_of(options_.hop_s, options_.rate_hz)),
      settle_rows_(rows_of(options_.settle_s, options_.rate_hz)),
      other_blocks_(blocks_of(options_.other_windows_s, options_.rate_hz, block_rows_)),
      integrator_(triples_of(options_, layout_.grouped(), config_.axes), high_pass_),
      noise_(config_.axes, options_.rate_hz),
      ring_(*motion_source_,
            SelfTuning::ring_rows(longest_settle(options_, layout_.grouped()) +
                                  longest_window(block_rows_, other_blocks_) + triple_.length())),
      drift_(config_, table_, layout_, block_rows_,
             longest_window(block_rows_, other_blocks_) / block_rows_),
      main_(config_.structure, layout_, table_, options_, kCompensatedShare, kWarm),
      others_(config_.structure, layout_, table_, options_, other_blocks_, block_rows_),
      estimate_(static_cast<std::size_t>(table_.size())) {
  steps_per_instant_ = (main_.error_steps() + block_rows_ - 2) / (block_rows_ - 1);
  boxplots_.reserve(estimate_.value.size());  // copies would not keep what they reserve
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
  const Eigen::VectorXd design = config_.design.size() > 0
                                     ? config_.design
                                     : guessed_design(structure, ParameterTable(structure));
  if (layout_.grouped())
    return std::make_unique<GroupTuning>(config_, options, table_, layout_,
                                         GroupDesign{design, config_.bending_nmprad}, triple_,
                                         high_pass_);
  return std::make_unique<RegressorTuning>(structure, layout_,
                                           static_cast<const Deformations&>(*motion_source_),
                                           options, triple_, high_pass_, design);
}

std::unique_ptr<TunedRegression> SlidingWindowEstimator::make_regression(
    std::unique_ptr<RowTuning> tuning) const {
  return std::make_unique<TunedRegression>(std::move(tuning), layout_, blocks_, block_rows_,
                                           other_blocks_, settle_rows_);
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
  integrator_.reset();
  ring_.reset();
  drift_.restart();
  active_->start(0);
  if (self_tuning_) self_tuning_->restart();
  main_.restart();
  others_.restart();
  if (check_) check_->restart();
  since_hop_ = 0;
}

void SlidingWindowEstimator::recover() {
  noise_.reset();
  if (long_) long_->retuned();
  if (bending_) bending_->restart();
  ++interruptions_;
  restart();
}

const WindowEstimate* SlidingWindowEstimator::push(const SampleSet& set) {
  other_ = nullptr;
  if (set.index != expected_index_) {
    if (expected_index_ >= 0) ++interruptions_;
    restart();
  } else if (!sane_) {
    recover();
  }
  sane_ = true;
  expected_index_ = set.index + 1;

  integrator_.push(set.accel);
  noise_.push(set.accel);
  motion_source_->compute(integrator_, ring_.push());
  drift_.push(ring_.at(ring_.end() - 1));
  if (layout_.grouped()) follow_axes(ring_.at(ring_.end() - 1).known);
  active_->advance(ring_);
  ++since_hop_;
  const bool due = since_hop_ >= hop_rows_;
  if (active_->full() && (due || active_->closes_block()))
    main_.solve(active_->sums().window(), active_->rows(), trust(), active_->closes_block());
  const Time window_end = set.time - duration_of(triple_.delay, options_.rate_hz);
  advance_errors(window_end);
  // The first sets only fill the filters: a window cannot end before the first sample.
  const bool given = due && ring_.end() > triple_.length();
  if (due) since_hop_ = 0;
  if (given) fill_estimate(window_end);
  model_fit_ = check_ && ring_.end() > triple_.length()
                   ? check_->advance({&main_, &ring_, trust(), tuned(), errors_new_, window_end})
                   : nullptr;
  if (self_tuning_ && self_tuning_->step(active_, ring_)) regression_exchanged();
  return given ? &estimate_ : nullptr;
}

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
  self_tuning_->begin_axes(*active_, identified_from_);
}

void SlidingWindowEstimator::advance_errors(Time window_end) {
  errors_new_ = false;
  const bool closed = active_->finish(ring_);
  if (closed) sane_ = active_->sums().sane();
  if (closed && active_->full()) {
    main_.begin_errors(active_->sums(), main_);
    others_.block_closed(active_->sums(), window_end);
    const std::vector<std::uint8_t>& known = ring_.at(ring_.end() - 1).known;
    if (long_) long_->block_closed(active_->sums(), known, window_end);
    if (bending_) bending_->block_closed(active_->sums(), known, window_end);
    return;
  }
  errors_new_ = main_.advance_errors(steps_per_instant_);
  if (errors_new_) check_tuning();
  other_ = others_.advance(
      {active_.get(), &main_, &ring_.at(ring_.end() - 1).known, trust(), tuned(), &drift_});
  if (long_ && other_ == nullptr) advance_long();
  if (bending_ &&
      bending_->advance({active_.get(), &ring_.at(ring_.end() - 1).known, trust(), tuned()}))
    hold_bending();
}

void SlidingWindowEstimator::advance_long() {
  other_ = long_->advance(
      {active_.get(), &ring_.at(ring_.end() - 1).known, {matched_, noise_.configured()}, tuned()});
  if (other_ == nullptr || !self_tuning_ || self_tuning_->tuned() || !self_tuning_->due()) return;
  // While no ordinary window shows a parameter, the filters are tuned to the long ones.
  const WindowSolution& solution = long_->solution();
  for (std::size_t u = 0; u < shown_.size(); ++u) shown_[u] = solution.shown(static_cast<int>(u));
  self_tuning_->begin_check(*active_, solution.solver().solution(), solution.std_error(), shown_,
                            noise_);
}

void SlidingWindowEstimator::hold_bending() {
  for (const HeldBending::Held& held : bending_->held()) {
    const double ratio = held.value / theta0()[held.parameter];
    main_.hold(held.unknown, ratio, held.std_error);
    others_.hold(held.unknown, ratio, held.std_error);
    if (check_) check_->hold(held.unknown, ratio, held.std_error);
  }
}

void SlidingWindowEstimator::check_tuning() {
  if (!self_tuning_ || !self_tuning_->due()) return;
  for (std::size_t u = 0; u < shown_.size(); ++u) shown_[u] = main_.shown(static_cast<int>(u));
  self_tuning_->begin_check(*active_, main_.solver().solution(), main_.std_error(), shown_, noise_);
}

void SlidingWindowEstimator::regression_exchanged() {
  for (int u = 0; u < layout_.unknowns(); ++u) {
    const int p = layout_.parameter(u / layout_.own(), u % layout_.own());
    const double before = self_tuning_->before().tuning().theta0()[p];
    main_.rescale(u, before / theta0()[p]);
    retuned_by_[static_cast<std::size_t>(u)] = theta0()[p] / before;
  }
  main_.retuned();
  others_.retuned();
  if (long_) long_->retuned();
  if (bending_) {
    bending_->retuned(retuned_by_);
    hold_bending();
  }
  if (check_) check_->regression_exchanged(active_->tuning());
}

void SlidingWindowEstimator::fill_estimate(Time end) {
  estimate_.end = end;
  estimate_.rows = active_->full() ? window_rows() : 0;
  estimate_.start = end - duration_of(std::max(estimate_.rows - 1, 0), options_.rate_hz);
  ++estimate_.sequence;
  main_.fill({&theta0(), &ring_.at(ring_.end() - 1).known, tuned()}, estimate_);
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
