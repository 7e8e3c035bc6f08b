// SPDX-License-Identifier: MIT
#include "estimator/identify/window/window_solution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kInflation = 4;  // correlated residuals overstate the information by this factor
/// Relative difference below which the frequencies of a direction's frames are equal within a plan
/// that does not shear its floors.
constexpr double kSymmetric = 0.02;
constexpr double kHeld = 0.01;  // relative width of the prior of a held unknown
constexpr double kRounding = 1e-12;
constexpr int kFirstPasses = 5;  // until the noise level no longer changes
/// Largest level of known noise in groups, whose residual usually comes from the model.
constexpr double kMaxOfKnownNoise = 2;

/// Returns the number of blocks in the longest window.
int most_blocks(const EstimatorOptions& options) {
  double longest_s = options.window_s;
  for (const double length_s : options.other_windows_s) longest_s = std::max(longest_s, length_s);
  return static_cast<int>(std::ceil(BatchMeans::kBlocks * longest_s / options.window_s)) + 1;
}

}  // namespace

WindowSolution::WindowSolution(const Structure& structure, const FloorLayout& layout,
                               const ParameterTable& table, const EstimatorOptions& options,
                               double compensation, double warm)
    : structure_(structure),
      layout_(layout),
      table_(table),
      options_(options),
      noise_(layout, compensation),
      warm_share_(warm),
      solver_(layout),
      errors_(layout, most_blocks(options), compensation),
      influential_(layout, most_blocks(options), compensation),
      std_error_(static_cast<std::size_t>(layout.unknowns()), 0),
      checked_(std_error_.size(), 0),
      misfit_(layout),
      misfit_error_(static_cast<std::size_t>(layout.unknowns()), 0),
      prior_(static_cast<std::size_t>(layout.unknowns()), 0.0),
      centre_(prior_.size(), 1.0),
      doubt_(prior_.size(), 1.0),
      same_as_(layout.grouped() ? static_cast<std::size_t>(layout.unknowns()) : 0, 0),
      share_error_(same_as_.size(), 0.0),
      warm_(static_cast<std::size_t>(layout.floors()), 0),
      known_(static_cast<std::size_t>(layout.places()), 0),
      place_known_(static_cast<std::size_t>(layout.unknowns()), 0) {
  for (int u = 0; u < layout.unknowns(); ++u) {
    const int parameter = layout.parameter_of(u);
    const ParameterKind kind = table[parameter].kind;
    const double limit =
        kind == ParameterKind::frame_stiffness ? options.max_error_k
        : kind == ParameterKind::panel_stiffness || kind == ParameterKind::bending_stiffness
            ? options.max_error_g
            : options.max_error_c;
    const double tolerance = design_tolerance(kind);
    unknowns_.push_back({parameter, kind, kInflation / (tolerance * tolerance), limit});
  }
}

void WindowSolution::hold(int unknown, double ratio, double std_error) {
  const auto u = static_cast<std::size_t>(unknown);
  unknowns_[u].held = true;
  unknowns_[u].prior = kInflation / (kHeld * kHeld);
  centre_[u] = ratio;
  doubt_[u] = std_error / design_tolerance(unknowns_[u].kind);
}

void WindowSolution::restart() {
  errors_.cancel();
  influential_.cancel();
  errors_known_ = solved_ = false;
  fresh_ = true;
  overcompensated_ = false;
  noise_scale_ = noise_level_ = residual_energy_ = 0;
}

void WindowSolution::solve(const WindowParts& sums, const RowFilter& rows, const Trust& trust,
                           bool closes_block) {
  if (fresh_) {
    fresh_ = false;
    noise_level_ = 0;
    for (int i = 0; i < kFirstPasses; ++i) solve(sums, rows, trust, true);
  }
  solved_ = true;
  noise_known_ = trust.noise_known;
  const double compensation =
      trust.regularise && trust.noise_known ? std::min(noise_level_, 1.0) : 0.0;
  noise_.update(rows, sums, compensation);
  for (std::size_t f = 0; f < warm_.size(); ++f)
    warm_[f] = (*sums.instants)[f] >= warm_share_ * sums.rows ? kWarm
               : (*sums.instants)[f] > 0                      ? kFilling
                                                              : kRowless;
  if (layout_.grouped()) {
    same_as_ = rows.floor_rows(0).same_as;
    share_error_ = rows.floor_rows(0).share_error;
  }
  const double prior_scale = trust.regularise && options_.prior ? noise_level_ : 0.0;
  for (std::size_t u = 0; u < prior_.size(); ++u)
    prior_[u] = (unknowns_[u].held ? noise_level_ : prior_scale) * unknowns_[u].prior;
  solver_.factor(sums, prior_, centre_, noise_);
  const double residual = solver_.residual_energy() + compensation * noise_.residual();
  overcompensated_ = compensation > 0 && residual < -kRounding * solver_.response_energy();
  residual_energy_ = std::max(residual, 0.0);
  noise_scale_ = noise_.residual() > 0 ? residual_energy_ / noise_.residual() : 0.0;
  if (!std::isfinite(noise_scale_)) noise_scale_ = noise_level_ = 0;  // or it would never recover
  if (closes_block && !overcompensated_) noise_level_ = noise_scale_;
  if (closes_block) misfit_.update(sums, solver_.solution(), noise_, trust.noise_known);
}

bool WindowSolution::advance_errors(int steps) {
  influential_.advance(steps);
  if (!errors_.advance(steps)) return false;
  errors_known_ = true;
  checked_ = influential_.solution();
  for (std::size_t u = 0; u < std_error_.size(); ++u)
    std_error_[u] = influential_.error(static_cast<int>(u), errors_.std_error()[u]);
  for (std::size_t u = 0; u < misfit_error_.size(); ++u)
    misfit_error_[u] = misfit_.error(static_cast<int>(u), errors_.inverse_diagonal()[u]);
  return true;
}

void WindowSolution::rescale(int unknown, double factor) {
  std_error_[static_cast<std::size_t>(unknown)] *= factor;
  checked_[static_cast<std::size_t>(unknown)] *= factor;
}

/// Returns the standard error of the present solution. std_error() is that of an earlier one, at
/// most two blocks ago. Noise alone moves the solution in that time by less than kExplained of its
/// errors; what it moved beyond is an error too.
double WindowSolution::present_error(int unknown, const ModelMisfit& usual) const {
  const auto u = static_cast<std::size_t>(unknown);
  const double moved = std::abs(solver_.solution()[u] - checked_[u]);
  const double known = std::max(std_error_[u], moved - InfluentialPart::kExplained * std_error_[u]);
  return std::hypot(known, misfit_.new_error(unknown, errors_.inverse_diagonal()[u], usual));
}

double WindowSolution::misfit(int unknown) const {
  return errors_known_ && shown(unknown) ? misfit_.misfit(unknown) : kNaN;
}

double WindowSolution::misfit_error(int unknown) const {
  const auto u = static_cast<std::size_t>(unknown);
  return errors_known_ && shown(unknown) ? misfit_error_[u] / solver_.solution()[u] : kNaN;
}

bool WindowSolution::shown(int unknown) const {
  const auto u = static_cast<std::size_t>(unknown);
  return !overcompensated_ && solver_.usable(unknown) && solver_.solution()[u] > 0 &&
         solver_.information()[u] > options_.min_snr * noise_.energy()[u] * gate_level();
}

double WindowSolution::gate_level() const {
  return layout_.grouped() && noise_known_ ? std::min(noise_scale_, kMaxOfKnownNoise)
                                           : noise_scale_;
}

bool WindowSolution::published(int unknown, const ModelMisfit& usual) const {
  const auto u = static_cast<std::size_t>(unknown);
  return shown(unknown) &&
         present_error(unknown, usual) < unknowns_[u].error_limit * solver_.solution()[u];
}

bool WindowSolution::place_known(int unknown) const {
  if (layout_.grouped()) return true;  // its floor becomes an inner floor
  const int frames = layout_.frames();
  const int floor = unknown / layout_.own();
  const int position = unknown % layout_.own();
  const auto is_known = [&](int level, int f) {
    return known_[static_cast<std::size_t>(level * frames + f)] != 0;
  };
  if (position < 2 * frames)
    return is_known(floor, position % frames) && is_known(floor + 1, position % frames);
  for (int f = 0; f < frames; ++f)
    if (layout_.coefficient(position, f) != 0 && !is_known(floor + 1, f)) return false;
  return true;
}

/// Returns true if an equation of the unknown is missing, because a motion of its frame, or of any
/// frame for a panel, is unknown on the floors around.
bool WindowSolution::equation_lost(int unknown) const {
  if (layout_.grouped()) return false;
  const int frames = layout_.frames();
  const int floor = unknown / layout_.own(), position = unknown % layout_.own();
  const bool of_frame = position < 2 * frames;
  const int last = std::min(floor + 2, layout_.floors());
  for (int level = std::max(floor - 1, 0); level <= last; ++level)
    for (int f = 0; f < frames; ++f)
      if ((!of_frame || f == position % frames) &&
          known_[static_cast<std::size_t>(level * frames + f)] == 0)
        return true;
  return false;
}

/// Returns true if no equation of the floor is left, because a motion around it is unknown.
bool WindowSolution::rowless(int floor) const {
  if (!solved_ || warm_[static_cast<std::size_t>(floor)] != kRowless) return false;
  if (layout_.grouped())
    return std::any_of(known_.begin(), known_.end(), [](auto k) { return k == 0; });
  const int levels = layout_.next(floor) > 0 ? 3 : 2;
  const auto first = known_.begin() + floor * layout_.frames();
  return std::any_of(first, first + levels * layout_.frames(), [](auto k) { return k == 0; });
}

void WindowSolution::see(const std::vector<std::uint8_t>& known) {
  if (known == known_) return;
  known_ = known;
  for (std::size_t u = 0; u < place_known_.size(); ++u)
    place_known_[u] = place_known(static_cast<int>(u)) ? 1 : 0;
}

/// Returns true if, in every direction that moves, the frames of each story have equal stiffness
/// over mass within their errors. Then no floor shears, however flexible it is.
bool WindowSolution::looks_symmetric(const WindowEstimate& estimate) const {
  for (int story = 1; story <= structure_.stories; ++story) {
    for (const Direction direction : {Direction::x, Direction::y}) {
      double lowest = std::numeric_limits<double>::infinity(), highest = 0;
      for (int f = 0; f < structure_.frames(); ++f) {
        const auto p = static_cast<std::size_t>(table_.frame_stiffness(story, f));
        if (structure_.direction(f) != direction || estimate.reason[p] != Observability::observable)
          continue;
        const double mass = structure_.frame_mass(story, f);
        const double doubt = 2 * estimate.std_error[p];
        lowest = std::min(lowest, (estimate.value[p] + doubt) / mass);
        highest = std::max(highest, (estimate.value[p] - doubt) / mass);
      }
      if (highest > (1 + kSymmetric) * lowest) return false;
    }
  }
  return true;
}

void WindowSolution::fill(const Situation& situation, WindowEstimate& e) {
  see(*situation.known);
  const ModelMisfit& usual = (situation.main != nullptr ? *situation.main : *this).misfit_;
  bool any = false, any_frame = false, warming = true;
  for (int own = 0; own < layout_.unknowns(); ++own) {
    const int u = stands_for(own);
    const auto i = static_cast<std::size_t>(u);
    const int parameter = unknowns_[static_cast<std::size_t>(own)].parameter;
    const auto p = static_cast<std::size_t>(parameter);
    const double theta0 = (*situation.theta0)[parameter];
    const int floor = u / layout_.own();
    const bool warm = solved_ && errors_known_ && situation.tuned && this->warm(floor) &&
                      (situation.main == nullptr || situation.main->warm(floor));
    e.reason[p] = place_known_[i] == 0 || rowless(floor) ? Observability::channel_lost
                  : !warm                                ? Observability::warming_up
                  : published(u, usual)                  ? Observability::observable
                  : equation_lost(u)                     ? Observability::channel_lost
                                                         : Observability::quiet;
    const bool observable = e.reason[p] == Observability::observable;
    any = any || observable;
    any_frame = any_frame || (observable && unknowns_[i].kind == ParameterKind::frame_stiffness);
    warming = warming && (e.reason[p] == Observability::warming_up ||
                          e.reason[p] == Observability::channel_lost);
    e.solution[p] = solved_ ? theta0 * solver_.solution()[i] : kNaN;
    e.value[p] = observable ? e.solution[p] : kNaN;
    const double of_share =
        share_error_.empty() ? 0 : share_error_[static_cast<std::size_t>(own)] * e.solution[p];
    e.std_error[p] = observable ? std::hypot(theta0 * present_error(u, usual), of_share) : kNaN;
    const double noise = noise_.energy()[i] * gate_level();
    e.snr[p] = solved_ && noise > 0 ? solver_.information()[i] / noise : 0;
    const bool shares = solved_ && errors_known_;
    e.prior_share[p] = shares ? std::clamp(errors_.prior_share()[i], 0.0, 1.0) : 0;
    e.noise_share[p] = shares ? std::clamp(errors_.noise_share()[i], 0.0, 1.0) : 0;
  }
  if (any_frame && layout_.panels() > 0 && !layout_.grouped()) {
    const Observability why =
        looks_symmetric(e) ? Observability::symmetric_plan : Observability::floor_too_stiff;
    for (const Unknown& unknown : unknowns_) {
      Observability& reason = e.reason[static_cast<std::size_t>(unknown.parameter)];
      const bool panel = unknown.kind == ParameterKind::panel_stiffness ||
                         unknown.kind == ParameterKind::panel_damping;
      if (panel && reason == Observability::quiet) reason = why;
    }
  }
  e.residual_ratio = solved_ && solver_.response_energy() > 0
                         ? std::sqrt(residual_energy_ / solver_.response_energy())
                         : 0;
  e.status = any       ? WindowStatus::valid
             : warming ? WindowStatus::warming_up
                       : WindowStatus::nothing_identifiable;
}

}  // namespace framewatch::estimator
