// SPDX-License-Identifier: MIT
#include "estimator/identify/window/long_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

constexpr int kWindowsPerLength = 5;
constexpr double kUsualStep = 0.002;       // adaptation of the usual energy per block
constexpr std::size_t kAddAtOnce = 65536;  // doubles per instant
constexpr int kStepsPerInstant = 4;
/// Gates of a long window. An hour's average may come from motion that is too weak for any ordinary
/// window.
constexpr double kMinSnr = 1.3, kMaxError_k = 0.1, kMaxError_g = 0.5, kMaxError_c = 0.5;

EstimatorOptions lenient(EstimatorOptions o, bool noise_configured) {
  if (noise_configured) o.min_snr = kMinSnr;
  o.max_error_k = kMaxError_k;
  o.max_error_g = kMaxError_g;
  o.max_error_c = kMaxError_c;
  return o;
}

}  // namespace

LongWindow::LongWindow(const Structure& structure, const FloorLayout& layout,
                       const ParameterTable& table, const EstimatorOptions& options, int block_rows,
                       int window, bool noise_configured, Blocks blocks)
    : shape_(layout),
      which_(blocks),
      floors_(layout.floors()),
      own_(static_cast<std::size_t>(layout.own())),
      block_rows_(block_rows),
      piece_blocks_(std::max(
          1, static_cast<int>(
                 std::lround(options.long_window_s * options.rate_hz / block_rows / kPieces)))),
      rate_hz_(options.rate_hz),
      solution_(structure, layout, table, lenient(options, noise_configured), kCompensatedShare),
      estimate_(static_cast<std::size_t>(table.size())),
      ring_(shape_.size * kPieces, 0.0),
      current_(shape_.size, 0.0),
      sum_(shape_.size, 0.0),
      zero_(shape_.size, 0.0),
      ring_instants_(static_cast<std::size_t>(floors_ * kPieces), 0.0),
      instants_(static_cast<std::size_t>(floors_), 0.0),
      ring_rows_(kPieces, 0.0),
      begins_(kPieces),
      whole_instants_(static_cast<std::size_t>(floors_), 0) {
  estimate_.window = window;
  fit_.assign(static_cast<std::size_t>(layout.unknowns()), 1.0);
  x_.assign(static_cast<std::size_t>(layout.most_front()), 0.0);
  known_.reserve(static_cast<std::size_t>(layout.places()));
}

void LongWindow::begin_anew() {
  std::fill(current_.begin(), current_.end(), 0.0);
  std::fill(instants_.begin(), instants_.end(), 0.0);
  rows_ = 0;
  blocks_ = 0;
  pieces_ = 0;
  work_ = Work::none;
  solution_.restart();
}

void LongWindow::rescale(double* block, const std::vector<double>& factor) {
  std::size_t first = 0;
  for (const GramShape::Floor& floor : shape_.floor) {
    const auto scale = [&](int i) {
      return i + 1 < floor.front ? factor[first + static_cast<std::size_t>(i)] : 1;
    };
    std::size_t at = floor.offset;
    for (int i = 0; i < floor.front; ++i) {
      const int begin = packed_row_begin(i);
      for (int k = i; k < floor.front; ++k)
        block[at + static_cast<std::size_t>(k - begin)] *= scale(i) * scale(k);
      at += static_cast<std::size_t>(floor.stride - begin);
    }
    first += own_;
  }
}

void LongWindow::rescale(const std::vector<double>& factor) {
  for (std::size_t piece = 0; piece < kPieces; ++piece)
    rescale(&ring_[piece * shape_.size], factor);
  rescale(current_.data(), factor);
  for (std::size_t u = 0; u < fit_.size(); ++u) fit_[u] /= factor[u];
  work_ = Work::none;
  solution_.retuned();
}

void LongWindow::retuned() {
  begin_anew();
  usual_ = usual_misfit_ = 0;
  std::fill(fit_.begin(), fit_.end(), 1.0);
}

const double* LongWindow::block(int age) const {
  return &ring_[static_cast<std::size_t>((pieces_ - 1 - age) % kPieces) * shape_.size];
}

double LongWindow::energy(const double* block, bool residual) {
  double sum = 0;
  std::size_t first = 0;
  for (const GramShape::Floor& floor : shape_.floor) {
    const auto unknowns = static_cast<std::size_t>(floor.front - 1);
    std::fill(x_.begin(), x_.end(), 0.0);
    if (residual)
      std::copy_n(fit_.begin() + static_cast<std::ptrdiff_t>(first), unknowns, x_.begin());
    x_[unknowns] = -1;
    std::size_t at = floor.offset;
    for (int i = 0; i < floor.front; ++i) {
      const int begin = packed_row_begin(i);
      const double* row = &block[at] - begin;
      double product = row[i] * x_[static_cast<std::size_t>(i)];
      for (int k = i + 1; k < floor.front; ++k)
        product += 2 * row[k] * x_[static_cast<std::size_t>(k)];
      sum += x_[static_cast<std::size_t>(i)] * product;
      at += static_cast<std::size_t>(floor.stride - begin);
    }
    first += own_;
  }
  return sum;
}

double LongWindow::weight(const double* block) {
  const auto limited = [](double now, double& usual, double most) {
    if (usual == 0) usual = now;
    usual *= now > usual ? 1 + kUsualStep : 1 - kUsualStep;
    return now > 0 ? std::min(1.0, most * usual / now) : 1.0;
  };
  const double motion = limited(energy(block, false), usual_, kMaxOfUsual);
  const double misfit = limited(energy(block, true), usual_misfit_, kMaxOfUsualMisfit);
  return std::min(motion, misfit * misfit);  // a block that does not fit at all gets no weight
}

bool LongWindow::fits(const std::vector<std::uint8_t>& known) {
  if (known == known_) {
    left_out_ = 0;
    return true;
  }
  if (!known_.empty() && ++left_out_ <= piece_blocks_) return false;
  retuned();
  known_ = known;
  left_out_ = 0;
  return true;
}

void LongWindow::block_closed(SlidingGram& sums, const std::vector<std::uint8_t>& known,
                              Time time) {
  if (!fits(known)) return;
  const double* block = sums.block(0);
  if (!(energy(block, false) > 0)) return;
  const double weight = which_ == Blocks::limited ? this->weight(block) : 1;
  if (blocks_ == 0) since_ = time - duration_of(block_rows_ - 1, rate_hz_);
  for (std::size_t i = 0; i < shape_.size; ++i) current_[i] += weight * block[i];
  const int* instants = sums.newest_instants();
  for (std::size_t f = 0; f < instants_.size(); ++f) instants_[f] += weight * instants[f];
  rows_ += weight * block_rows_;
  end_ = time;
  if (++blocks_ == piece_blocks_) close_piece();
}

void LongWindow::close_piece() {
  const auto slot = static_cast<std::size_t>(pieces_++ % kPieces);
  const auto floors = static_cast<std::size_t>(floors_);
  std::copy(current_.begin(), current_.end(),
            ring_.begin() + static_cast<std::ptrdiff_t>(slot * shape_.size));
  std::copy(instants_.begin(), instants_.end(),
            ring_instants_.begin() + static_cast<std::ptrdiff_t>(slot * floors));
  ring_rows_[slot] = rows_;
  begins_[slot] = since_;
  std::fill(current_.begin(), current_.end(), 0.0);
  std::fill(instants_.begin(), instants_.end(), 0.0);
  rows_ = 0;
  blocks_ = 0;
  if (pieces_ < kPieces || pieces_ % (kPieces / kWindowsPerLength) != 0) return;
  work_ = Work::adding;
  added_ = 0;
  std::fill(sum_.begin(), sum_.end(), 0.0);
}

void LongWindow::add_some() {
  const std::size_t end = std::min(added_ + kAddAtOnce, ring_.size());
  while (added_ < end) {
    const std::size_t within = added_ % shape_.size;
    const std::size_t length = std::min(shape_.size - within, end - added_);
    kernels::in_use->add(&sum_[within], &ring_[added_], static_cast<long>(length));
    added_ += length;
  }
  if (added_ == ring_.size()) work_ = Work::solving;
}

void LongWindow::solve(const Context& c) {
  double rows = 0;
  for (const double r : ring_rows_) rows += r;
  for (std::size_t f = 0; f < whole_instants_.size(); ++f) {
    double instants = 0;
    for (std::size_t piece = 0; piece < kPieces; ++piece)
      instants += ring_instants_[piece * whole_instants_.size() + f];
    whole_instants_[f] = static_cast<int>(std::lround(instants));
  }
  const WindowParts sums{
      &shape_,         sum_.data(), zero_.data(), zero_.data(), static_cast<int>(std::lround(rows)),
      &whole_instants_};
  solution_.solve(sums, c.regression->rows(), c.trust, true);
  solution_.begin_errors(*this, kPieces, solution_);
  for (std::size_t u = 0; u < fit_.size(); ++u) {
    const double x = solution_.solver().solution()[u];
    fit_[u] = solution_.shown(static_cast<int>(u)) ? x : 1.0;
  }
  work_ = Work::errors;
}

const WindowEstimate* LongWindow::advance(const Context& c) {
  switch (work_) {
    case Work::none:
      break;
    case Work::adding:
      add_some();
      break;
    case Work::solving:
      solve(c);
      break;
    case Work::errors:
      if (solution_.advance_errors(kStepsPerInstant)) return &give(c);
      break;
  }
  return nullptr;
}

const WindowEstimate& LongWindow::give(const Context& c) {
  work_ = Work::none;
  solution_.fill({&c.regression->tuning().theta0(), c.known, c.tuned}, estimate_);
  estimate_.rows = rows();
  estimate_.start = begins_[static_cast<std::size_t>(pieces_ % kPieces)];
  estimate_.end = end_;
  ++estimate_.sequence;
  return estimate_;
}

namespace {

constexpr double kMaxError = 0.5;  // relative error up to which a window counts
constexpr double kSurprise = 2;    // in errors of a step
constexpr double kTiny = 1e-300;
constexpr double kMinStep = 0.6, kMaxStep = 1.6;  // factors per window

EstimatorOptions of_bending(EstimatorOptions options) {
  options.long_window_s = std::max(HeldBending::kWindow_s, 2 * options.window_s);
  return options;
}

}  // namespace

HeldBending::HeldBending(const Structure& structure, const FloorLayout& layout,
                         const ParameterTable& table, const EstimatorOptions& options,
                         int block_rows, bool noise_configured, const Eigen::VectorXd& design)
    : window_(structure, layout, table, of_bending(options), block_rows, 0, noise_configured,
              LongWindow::Blocks::by_energy) {
  for (int u = 0; u < layout.unknowns(); ++u) {
    const int p = layout.parameter_of(u);
    if (table[p].kind == ParameterKind::frame_stiffness) stiffnesses_.push_back(u);
    if (table[p].kind == ParameterKind::bending_stiffness)
      held_.push_back({p, u, design[p], design_tolerance(table[p].kind)});
  }
}

double HeldBending::detuning(const WindowSolution& solution) const {
  double out = 0;
  for (const int u : stiffnesses_) {
    const double ratio = solution.solver().solution()[static_cast<std::size_t>(u)];
    if (solution.shown(u))
      out = std::max(out, std::abs(std::log(std::clamp(ratio, kMinStep, kMaxStep))));
  }
  return out;
}

bool HeldBending::advance(const LongWindow::Context& context) {
  if (window_.advance(context) == nullptr || !context.tuned) return false;
  const WindowSolution& solution = window_.solution();
  const StorySolver& solver = solution.solver();
  const double off = detuning(solution);
  const double misfit = std::sqrt(std::max(solver.residual_energy(), 0.0) /
                                  std::max(solver.response_energy(), kTiny));
  bool changed = false;
  for (Held& h : held_) {
    const auto u = static_cast<std::size_t>(h.unknown);
    // A model that misfits by some share is wrong by about that share.
    const double error = std::max(std::hypot(solution.std_error()[u], misfit), kMin);
    const double with_tuning = std::hypot(error, off);
    if (!solver.usable(h.unknown) || !(with_tuning < kMaxError)) continue;
    // The equations are linear in the ratio only near the tuning.
    const double ratio = std::clamp(solver.solution()[u], kMinStep, kMaxStep);
    const double value = ratio * context.regression->tuning().theta0()[h.parameter];
    const double step = std::log(value / h.value);
    double variance = h.std_error * h.std_error + kDrift * kDrift;
    // Either the held value was far from the right tuning, or the building has changed.
    if (step * step > kSurprise * kSurprise * (variance + error * error)) variance = step * step;
    const double before = 1 / variance, now = 1 / (with_tuning * with_tuning);
    h.value *= std::exp(step * now / (before + now));
    h.std_error = std::max(1 / std::sqrt(before + now), kMin);
    changed = true;
  }
  if (changed) window_.begin_anew();
  return changed;
}

}  // namespace framewatch::estimator
