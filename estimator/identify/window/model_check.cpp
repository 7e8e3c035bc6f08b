// SPDX-License-Identifier: MIT
#include "estimator/identify/window/model_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

constexpr int kFloorsPerInstant = 4;  // floors tuned per instant

}  // namespace

OtherCorner::OtherCorner(std::unique_ptr<RowTuning> tuning, const Structure& structure,
                         const FloorLayout& layout, const ParameterTable& table,
                         const EstimatorOptions& options, int rows)
    : tuning_(std::move(tuning)),
      rows_filter_(tuning_->make_filter(0)),
      shape_(layout),
      floors_(layout.floors()),
      rows_(rows),
      parts_per_instant_(layout.grouped() ? 1 : kFloorsPerInstant),
      solution_(structure, layout, table, options),
      sum_(shape_.size, 0.0),
      zero_(shape_.size, 0.0),
      instants_(static_cast<std::size_t>(floors_), 0) {}

void OtherCorner::restart(int settle) {
  rows_filter_->reset(settle);
  settling_ = settle + 1;
  solution_.restart();
  std::fill(sum_.begin(), sum_.end(), 0.0);
  std::fill(instants_.begin(), instants_.end(), 0);
  count_ = 0;
  resting_ = false;
}

void OtherCorner::retune(const RowTuning& active) {
  if (tuning_->axes() != active.axes()) tuning_->set_axes(active.axes(), active.ratios());
  tuning_->set_theta0(active.theta0(), active.noise_density());
  next_part_ = 0;
  resting_ = true;
}

bool OtherCorner::tune() {
  if (next_part_ >= tuning_->parts()) return false;
  for (int i = 0; i < parts_per_instant_ && next_part_ < tuning_->parts(); ++i)
    tuning_->tune(next_part_++);
  return true;
}

void OtherCorner::advance(const MotionRing& ring) {
  rows_filter_->push(ring.at(ring.end() - 1));
  if (settling_ > 0 && --settling_ > 0) return;
  if (full()) return;
  for (int f = 0; f < floors_; ++f) {
    const GramShape::Floor& shape = shape_.floor[static_cast<std::size_t>(f)];
    double* to = &sum_[shape.offset];
    kernels::in_use->add_rows(to, to, rows_filter_->rows(f), rows_filter_->count(f), shape.front,
                              shape.stride);
    if (rows_filter_->count(f) > 0) ++instants_[static_cast<std::size_t>(f)];
  }
  ++count_;
}

const WindowSolution& OtherCorner::solve(const WindowSolution::Trust& trust) {
  const WindowParts sums{&shape_, sum_.data(), zero_.data(), zero_.data(), rows_, &instants_};
  solution_.solve(sums, *rows_filter_, trust, true);
  return solution_;
}

namespace {

/// Factors of the usual corner frequencies. Those of groups are at 0.7 of the floors' frequencies
/// already.
constexpr double kLowerCorner = 0.7, kHigherCorner = 1.4;
/// Expected range of the three solutions from noise alone, in standard errors of one solution.
constexpr double kRangeOfNoise = 2;

EstimatorOptions with_corner(EstimatorOptions options, double ratio) {
  options.corner_ratio *= ratio;
  return options;
}

double square(double x) {
  return x * x;
}

}  // namespace

ModelCheck::ModelCheck(const PipelineConfig& config, const ParameterTable& table,
                       const FloorLayout& layout, int window_rows, const MakeTuning& make_tuning)
    : config_(&config),
      table_(table),
      layout_(layout),
      options_{with_corner(config.options, kLowerCorner),
               with_corner(config.options, kHigherCorner)},
      masses_(layout),
      window_rows_(window_rows),
      settle_rows_(static_cast<int>(std::lround(config.options.settle_s * config.options.rate_hz))),
      masses_per_instant_(std::max(1, layout.floors() / 8)),
      fit_(static_cast<std::size_t>(table.size())) {
  corners_.reserve(options_.size());
  for (const EstimatorOptions& options : options_)
    corners_.emplace_back(make_tuning(options), config.structure, layout, table, options,
                          window_rows);
  low_.assign(static_cast<std::size_t>(layout.unknowns()), 0.0);
  const auto parameters = static_cast<std::size_t>(table.size());
  for (std::vector<double>* v : {&mass_error_, &misfit_square_, &corner_square_})
    v->assign(parameters, 0.0);
  misfits_.assign(parameters, 0);
  spreads_.assign(parameters, 0);
}

void ModelCheck::restart() {
  masses_.cancel();
  if (phase_ == Phase::tuning) return;
  int settle = settle_rows_;
  for (const OtherCorner& corner : corners_)
    settle = std::max(settle, corner.settle_rows(settle_rows_));
  for (OtherCorner& corner : corners_) corner.restart(settle);
  phase_ = Phase::filling;
}

void ModelCheck::regression_exchanged(const RowTuning& active) {
  masses_.cancel();
  for (OtherCorner& corner : corners_) corner.retune(active);
  phase_ = Phase::tuning;
}

void ModelCheck::hold(int unknown, double ratio, double std_error) {
  for (OtherCorner& corner : corners_) corner.solution().hold(unknown, ratio, std_error);
}

void ModelCheck::pause() {
  pause_left_ = kPause * window_rows_;
  phase_ = Phase::pausing;
}

const ModelFit* ModelCheck::advance(const Context& c) {
  advance_corners(c);
  if (!c.errors_new || !c.tuned || !c.whole) return nullptr;
  if (++blocks_ < kEvery) return nullptr;
  blocks_ = 0;
  take_misfit(c);
  return &give(c);
}

void ModelCheck::advance_corners(const Context& c) {
  if (phase_ == Phase::tuning) {
    for (OtherCorner& corner : corners_)
      if (corner.tune()) return;
    phase_ = Phase::filling;
    return restart();
  }
  if (phase_ == Phase::pausing) {
    if (--pause_left_ <= 0) restart();
    return;
  }
  for (OtherCorner& corner : corners_) corner.advance(*c.ring);
  switch (phase_) {
    case Phase::tuning:
      break;
    case Phase::filling:
      if (corners_[0].full() && corners_[1].full()) phase_ = Phase::low;
      break;
    case Phase::low:
      low_ = corners_[0].solve(c.trust).solver().solution();
      phase_ = Phase::high;
      break;
    case Phase::high:
      corners_[1].solve(c.trust);
      if (c.tuned) take_spread(c);
      if (layout_.grouped()) return pause();
      masses_.begin(corners_[1].solution().solver(), corners_[1].shape(), corners_[1].sums(),
                    config_->mass_tolerance);
      phase_ = Phase::masses;
      break;
    case Phase::masses:
      if (!masses_.advance(masses_per_instant_)) break;
      for (int u = 0; u < layout_.unknowns(); ++u)
        if (c.main->shown(u))
          mass_error_[parameter(u)] = masses_.error()[static_cast<std::size_t>(u)] /
                                      c.main->solver().solution()[static_cast<std::size_t>(u)];
      pause();
      break;
    case Phase::pausing:
      break;
  }
}

void ModelCheck::take_spread(const Context& c) {
  const std::vector<double>& x = c.main->solver().solution();
  const std::vector<double>& high = corners_[1].solution().solver().solution();
  for (int own = 0; own < layout_.unknowns(); ++own) {
    const int u = c.main->stands_for(own);
    const auto i = static_cast<std::size_t>(u);
    const std::size_t p = parameter(own);
    if (std::isnan(c.main->misfit(u))) continue;
    const auto [lowest, highest] = std::minmax({low_[i], x[i], high[i]});
    const double spread = (highest - lowest) / x[i];
    const double noise = kRangeOfNoise * c.main->std_error()[i] / x[i];
    const double beyond = std::clamp(square(spread) - square(noise), 0.0, 1.0);
    spreads_[p] = std::min(spreads_[p] + 1, kSpreads);
    corner_square_[p] += (beyond - corner_square_[p]) / spreads_[p];
  }
}

void ModelCheck::take_misfit(const Context& c) {
  for (int own = 0; own < layout_.unknowns(); ++own) {
    const int u = c.main->stands_for(own);
    const std::size_t p = parameter(own);
    const double misfit = c.main->misfit(u), error = c.main->misfit_error(u);
    if (!(std::isfinite(misfit) && std::isfinite(error))) continue;
    fit_.misfit[p] = misfit;
    misfits_[p] = std::min(misfits_[p] + 1, kMisfits);
    misfit_square_[p] += (square(error) - misfit_square_[p]) / misfits_[p];
    fit_.misfit_error[p] = std::max(error, std::sqrt(misfit_square_[p]));
  }
}

const ModelFit& ModelCheck::give(const Context& c) {
  ++fit_.sequence;
  fit_.end = c.end;
  fit_.start = c.end - duration_of(window_rows_ - 1, config_->options.rate_hz);
  for (std::size_t p = 0; p < fit_.word.size(); ++p) {
    fit_.word[p] = fit_word(fit_.misfit[p]);
    if (fit_.word[p] == FitWord::unknown) continue;
    fit_.design_error[p] = mass_error_[p];
    if (p < config_->design_error.size() && std::isfinite(config_->design_error[p]))
      fit_.design_error[p] = config_->design_error[p];
    fit_.corner_error[p] = std::sqrt(corner_square_[p]);
    fit_.error[p] =
        std::hypot(fit_.design_error[p], std::max(fit_.misfit_error[p], fit_.corner_error[p]));
    if (fit_.word[p] == FitWord::does_not_fit) fit_.error[p] = std::max(fit_.error[p], 1.0);
  }
  return fit_;
}

}  // namespace framewatch::estimator
