#include "estimator/identify/window_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/identify/design.h"

namespace framewatch {
namespace {

constexpr int kBlocks = 20;       // per window
constexpr double kInflation = 4;  // information is overstated by correlated residuals
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

DerivativeTriple triple_of(const EstimatorOptions& o, double advance) {
  return o.variant == Variant::paper ? trapezoid_triple(o.rate_hz)
                                     : matched_triple(o.rate_hz, advance);
}

/// Whole samples of a delay are taken off the stamps (Pipeline), the rest is filtered away here.
std::vector<DerivativeTriple> triples_of(const EstimatorOptions& o,
                                         const std::vector<SensorAxis>& axes) {
  std::vector<DerivativeTriple> triples;
  for (const SensorAxis& axis : axes) {
    const double samples = axis.delay * o.rate_hz;
    triples.push_back(triple_of(o, samples - std::round(samples)));
  }
  return triples;
}

std::vector<double> tolerances(const FloorLayout& layout, const ParameterTable& table) {
  std::vector<double> out;
  for (int u = 0; u < layout.unknowns(); ++u)
    out.push_back(
        design_tolerance(table[layout.parameter(u / layout.own(), u % layout.own())].kind));
  return out;
}

int rows_of(double seconds, double rate) {
  return std::max(1, static_cast<int>(std::lround(seconds * rate)));
}

/// Instants the slowest filter a design can ask for needs to settle: no corner is below the
/// high-pass.
int longest_settle(const EstimatorOptions& o) {
  const double slowest_s = 3 / (std::min(o.filter_damping, 0.7) * 2 * M_PI * o.high_pass_hz);
  return rows_of(std::max(o.settle_s, slowest_s), o.rate_hz) + 1;
}

}  // namespace

WindowEstimator::WindowEstimator(const PipelineConfig& config, const ParameterTable& table)
    : structure_(config.structure),
      axes_(config.axes),
      options_(config.options),
      table_(table),
      layout_(structure_, table_),
      deformations_(structure_, layout_, axes_),
      triple_(triple_of(options_, 0)),
      high_pass_(options_.high_pass_hz, options_.rate_hz),
      blocks_(kBlocks),
      block_rows_(std::max(2, rows_of(options_.window_s / kBlocks, options_.rate_hz))),
      hop_rows_(rows_of(options_.hop_s, options_.rate_hz)),
      settle_rows_(rows_of(options_.settle_s, options_.rate_hz)),
      filter_(triples_of(options_, axes_), high_pass_),
      ring_(deformations_, SelfTuning::ring_rows(longest_settle(options_) + kBlocks * block_rows_ +
                                                 triple_.length())),
      noise_(layout_),
      solver_(layout_),
      tolerance_(tolerances(layout_, table_)),
      batch_means_(layout_, kBlocks, tolerance_) {
  const auto unknowns = static_cast<std::size_t>(layout_.unknowns());
  prior_.assign(unknowns, 0.0);
  steps_per_instant_ = (batch_means_.steps() + block_rows_ - 2) / (block_rows_ - 1);
  for (int u = 0; u < layout_.unknowns(); ++u) {
    const int parameter = layout_.parameter(u / layout_.own(), u % layout_.own());
    const ParameterKind kind = table_[parameter].kind;
    const bool frame_stiffness = kind == ParameterKind::frame_stiffness;
    unknowns_.push_back({parameter, frame_stiffness,
                         frame_stiffness                          ? options_.max_error_k
                         : kind == ParameterKind::panel_stiffness ? options_.max_error_g
                                                                  : options_.max_error_c});
  }
  noise_configured_ = std::all_of(axes_.begin(), axes_.end(),
                                  [](const SensorAxis& a) { return a.noise_density > 0; });
  const auto parameters = static_cast<std::size_t>(table_.size());
  boxplots_.reserve(parameters);  // copies would not keep what they reserve
  for (std::size_t p = 0; p < parameters; ++p) boxplots_.emplace_back(options_.boxplot_windows);
  for (std::vector<double>* v :
       {&estimate_.value, &estimate_.std_error, &estimate_.snr, &estimate_.prior_share})
    v->assign(parameters, kNaN);
  estimate_.reason.assign(parameters, Observability::warming_up);
  estimate_.boxplot.assign(parameters, BoxplotStatistics{kNaN, kNaN, kNaN, kNaN, kNaN, 0, 0});
  estimate_.solution.assign(parameters, kNaN);
  active_ =
      make_machine(config.design.size() > 0 ? config.design : guessed_design(structure_, table_));
  shown_.assign(unknowns, 0);
  if (options_.self_tune && options_.variant == Variant::matched)
    self_tuning_ = std::make_unique<SelfTuning>(
        layout_, table_, make_machine(active_->tuning().design()), kBlocks, triple_.length());
}

std::unique_ptr<Machine> WindowEstimator::make_machine(const Eigen::VectorXd& design) const {
  const RowTuning tuning(structure_, layout_, deformations_, options_, triple_, high_pass_, design);
  return std::make_unique<Machine>(tuning, layout_, blocks_, block_rows_, settle_rows_);
}

void WindowEstimator::restart() {
  filter_.reset();
  ring_.reset();
  active_->start(0);
  if (self_tuning_) self_tuning_->restart();
  batch_means_.cancel();
  errors_known_ = false;
  noise_scale_ = residual_energy_ = 0;
  since_hop_ = 0;
}

const WindowEstimate* WindowEstimator::push(const SampleSet& set) {
  if (set.index != expected_index_) {
    if (expected_index_ >= 0) ++gaps_;
    restart();
  }
  expected_index_ = set.index + 1;

  filter_.push(set.accel);
  deformations_.compute(filter_, ring_.push());
  active_->advance(ring_);
  ++since_hop_;
  const bool due = since_hop_ >= hop_rows_;
  if (active_->full() && (due || active_->closes_block())) solve();
  if (active_->finish(ring_) && active_->full()) {
    batch_means_.begin(active_->sums(), solver_, kBlocks, prior_, noise_, noise_scale_);
  } else if (batch_means_.advance(steps_per_instant_)) {
    errors_known_ = true;
    look_at_tuning();
  }
  // The first sets only fill the filters: a window cannot end before the first sample.
  const bool given = due && ring_.end() > triple_.length();
  if (due) since_hop_ = 0;
  if (given) fill_estimate(set.time);
  if (self_tuning_ && self_tuning_->step(active_, ring_)) {
    batch_means_.cancel();
    for (int u = 0; u < layout_.unknowns(); ++u) {
      const int parameter = unknowns_[static_cast<std::size_t>(u)].parameter;
      batch_means_.rescale(u, self_tuning_->before().tuning().design()[parameter] /
                                  active_->tuning().design()[parameter]);
    }
  }
  return given ? &estimate_ : nullptr;
}

void WindowEstimator::solve() {
  const bool regularise = options_.variant == Variant::matched && tuned();
  const double taken_off = regularise && noise_configured_ ? std::min(noise_scale_, 1.0) : 0.0;
  noise_.update(active_->rows(), active_->sums(), taken_off);
  for (std::size_t u = 0; u < prior_.size(); ++u)
    prior_[u] = regularise && options_.prior
                    ? kInflation / (tolerance_[u] * tolerance_[u]) * noise_scale_
                    : 0.0;
  solver_.factor(active_->sums(), prior_, noise_);
  residual_energy_ = std::max(solver_.residual_energy() + taken_off * noise_.residual(), 0.0);
  noise_scale_ = noise_.residual() > 0 ? residual_energy_ / noise_.residual() : 0.0;
}

void WindowEstimator::look_at_tuning() {
  if (!self_tuning_ || !self_tuning_->due()) return;
  for (std::size_t u = 0; u < prior_.size(); ++u)
    shown_[u] = solver_.usable(static_cast<int>(u)) &&
                solver_.information()[u] > options_.min_snr * noise_.energy()[u] * noise_scale_ &&
                solver_.solution()[u] > 0;
  self_tuning_->look(*active_, solver_.solution(), batch_means_.std_error(), shown_);
}

bool WindowEstimator::element_known(int unknown, const std::vector<std::uint8_t>& known) const {
  const int frames = layout_.frames();
  const int floor = unknown / layout_.own();
  const int position = unknown % layout_.own();
  const auto is_known = [&](int level, int f) {
    return known[static_cast<std::size_t>(level * frames + f)] != 0;
  };
  if (position < 2 * frames)
    return is_known(floor, position % frames) && is_known(floor + 1, position % frames);
  for (int f = 0; f < frames; ++f)
    if (layout_.coefficient(position, f) != 0 && !is_known(floor + 1, f)) return false;
  return true;
}

Observability WindowEstimator::judge(int unknown, bool known, bool warm) const {
  const auto u = static_cast<std::size_t>(unknown);
  if (!known) return Observability::channel_lost;
  if (!warm) return Observability::warming_up;
  const double x = solver_.solution()[u];
  const bool excited =
      solver_.information()[u] > options_.min_snr * noise_.energy()[u] * noise_scale_;
  if (solver_.usable(unknown) && excited && x > 0 &&
      batch_means_.std_error()[u] < unknowns_[u].error_limit * x)
    return Observability::observable;
  return Observability::ill_determined;
}

void WindowEstimator::fill_estimate(Time time) {
  const double rate = options_.rate_hz;
  const auto since = [&](double rows) {
    return SensorClock::duration(std::llround(rows * 1e6 / rate));
  };
  estimate_.end = time - since(triple_.delay);
  estimate_.rows = active_->full() ? window_rows() : 0;
  estimate_.start = estimate_.end - since(std::max(estimate_.rows - 1, 0));
  ++estimate_.sequence;
  estimate_.residual_ratio = estimate_.rows > 0 && solver_.response_energy() > 0
                                 ? std::sqrt(residual_energy_ / solver_.response_energy())
                                 : 0;
  const std::vector<std::uint8_t>& known = ring_.at(ring_.end() - 1).known;
  const bool all_known = std::all_of(known.begin(), known.end(), [](auto k) { return k != 0; });
  const bool filling = ring_.end() < triple_.length();  // no axis can be valid yet
  const bool solved = active_->full();
  bool any = false, any_frame = false, floor_warm = false;
  for (int u = 0; u < layout_.unknowns(); ++u) {
    const auto i = static_cast<std::size_t>(u);
    const Unknown& unknown = unknowns_[i];
    const auto p = static_cast<std::size_t>(unknown.parameter);
    const double design = active_->tuning().design()[unknown.parameter];
    if (u % layout_.own() == 0)
      floor_warm = solved && errors_known_ && tuned() &&
                   2 * active_->sums().floor_instants(u / layout_.own()) >= window_rows();
    estimate_.reason[p] = judge(u, filling || all_known || element_known(u, known), floor_warm);
    const bool observable = estimate_.reason[p] == Observability::observable;
    any = any || observable;
    any_frame = any_frame || (observable && unknown.frame_stiffness);
    estimate_.solution[p] = solved ? design * solver_.solution()[i] : kNaN;
    estimate_.value[p] = observable ? estimate_.solution[p] : kNaN;
    estimate_.std_error[p] = observable ? design * batch_means_.std_error()[i] : kNaN;
    const double noise = noise_.energy()[i] * noise_scale_;
    estimate_.snr[p] = solved && noise > 0 ? solver_.information()[i] / noise : 0;
    estimate_.prior_share[p] =
        solved && errors_known_ ? std::min(batch_means_.prior_share()[i], 1.0) : 0;
  }
  for (std::size_t p = 0; p < estimate_.reason.size(); ++p) {
    if (estimate_.reason[p] == Observability::ill_determined && !any_frame)
      estimate_.reason[p] = Observability::quiet;
    boxplots_[p].push(estimate_.value[p]);
    estimate_.boxplot[p] = boxplots_[p].statistics();
  }
  const bool warming =
      std::all_of(estimate_.reason.begin(), estimate_.reason.end(), [](Observability o) {
        return o == Observability::warming_up || o == Observability::channel_lost;
      });
  estimate_.status = any       ? WindowStatus::valid
                     : warming ? WindowStatus::warming_up
                               : WindowStatus::nothing_identifiable;
}

}  // namespace framewatch
