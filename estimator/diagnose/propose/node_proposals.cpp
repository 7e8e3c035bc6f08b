// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/node_proposals.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "estimator/diagnose/propose/law_kind.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kLineBins = 4;       ///< on either side of a line
constexpr Index kFewestBins = 5;     ///< at an edge of the band
constexpr double kHzStep = 0.2;      ///< over the record's length
constexpr double kOnsetStep = 0.01;  ///< of the record
constexpr double kFineStep = 5e-4;   ///< of the record
constexpr double kLatestOnset = 0.6;
constexpr std::size_t kLines = 4;  ///< of a force, to be fitted with a linear element
constexpr int kNear = 4;           ///< steps of a frequency to either side of a line's bin

/// Returns the sum of exp(j angle i) over n samples.
Complex geometric(double angle, double n) {
  const Complex q = std::polar(1.0, angle);
  return std::abs(q - 1.0) < 1e-9 ? Complex(n) : (std::polar(1.0, angle * n) - 1.0) / (q - 1.0);
}

/// Returns the reduction of the misfit around a frequency by a cosine and a sine as long as the
/// record.
double line_gain(const RecordSegment& s, const VectorXcd& force, const VectorXd& weights,
                 double hz) {
  const double step = s.w[1] - s.w[0];
  const auto middle = static_cast<Index>(std::lround((2 * M_PI * hz - s.w[0]) / step));
  MatrixXcd shape(2 * kLineBins + 1, 2);
  VectorXcd value(2 * kLineBins + 1);
  VectorXd weight(2 * kLineBins + 1);
  Index rows = 0;
  const double n = static_cast<double>(s.intervals());
  const Index last = std::min(s.bins() - 1, middle + kLineBins);
  for (Index b = std::max<Index>(0, middle - kLineBins); b <= last; ++b) {
    const double w0 = 2 * M_PI * hz / s.rate_hz, w = s.w[b] / s.rate_hz;
    const Complex up = geometric(w0 - w, n), down = geometric(-w0 - w, n);
    shape(rows, 0) = 0.5 * (up + down);
    shape(rows, 1) = 0.5 * (up - down) / kJ;
    value[rows] = force[b];
    weight[rows++] = weights[b];
  }
  if (rows < kFewestBins) return 0;
  NeededSignal part;
  part.force = value.head(rows);
  part.weight = weight.head(rows);
  const ScalarFit fit = scalar_fit(
      {part}, {{VectorXcd(shape.col(0).head(rows)), VectorXcd(shape.col(1).head(rows))}});
  return (part.weight.array() * part.force.array().abs2()).sum() - fit.misfit;
}

/// Returns the frequency whose line reduces the misfit of all records most; 0 if no line does.
double strongest_line_hz(const Fitter& fitter, const std::vector<NeededSignal>& needed) {
  const Band band = fit_band(fitter);
  double best_gain = 0, best_hz = 0;
  const double seconds = fitter.segments()[0].seconds();
  std::vector<VectorXcd> force;
  for (std::size_t r = 0; r < needed.size(); ++r)
    force.push_back(beyond_linear(fitter.segments()[r], needed[r]));
  for (double hz = band.low_hz; hz < band.high_hz; hz += kHzStep / seconds) {
    double gain = 0;
    for (std::size_t r = 0; r < needed.size(); ++r)
      gain += line_gain(fitter.segments()[r], force[r], needed[r].weight, hz);
    if (gain > best_gain) {
      best_gain = gain;
      best_hz = hz;
    }
  }
  return best_hz;
}

struct OnsetFit {
  ScalarFit fit;
  double onset_s = 0;
};

/// Fits a harmonic force from an onset on, together with a linear element.
ScalarFit fit_from(const RecordSegment& s, const NeededSignal& needed, double hz, double onset_s) {
  VectorXd c(s.intervals()), q(s.intervals());
  for (Index i = 0; i < c.size(); ++i) {
    const double t = static_cast<double>(i) / s.rate_hz;
    c[i] = t < onset_s ? 0 : std::cos(2 * M_PI * hz * t);
    q[i] = t < onset_s ? 0 : std::sin(2 * M_PI * hz * t);
  }
  // The needed force is a restoring force; an external force has the opposite sign.
  std::vector<VectorXcd> columns{-band_of(c, s, 1), -band_of(q, s, 1)};
  if (needed.d.size() > 0)
    for (VectorXcd& column : linear_columns(needed, s.w)) columns.push_back(std::move(column));
  return scalar_fit({needed}, {columns});
}

/// Returns the onset that fits one record best, on a coarse grid, then on a fine one around its
/// best.
OnsetFit best_onset(const RecordSegment& s, const NeededSignal& needed, double hz) {
  OnsetFit best;
  const auto try_onset = [&](double onset_s) {
    const ScalarFit fit = fit_from(s, needed, hz, onset_s);
    if (fit.misfit < best.fit.misfit) best = {fit, onset_s};
  };
  for (double from = 0; from < kLatestOnset * s.seconds(); from += kOnsetStep * s.seconds())
    try_onset(from);
  const double coarse = best.onset_s;
  for (int i = -20; i <= 20; ++i) try_onset(std::max(0.0, coarse + kFineStep * i * s.seconds()));
  return best;
}

/// Returns the misfit of all records with a line from their start and a linear element.
double misfit_with_line(const Fitter& fitter, const std::vector<NeededSignal>& needed, double hz) {
  double out = 0;
  for (std::size_t r = 0; r < needed.size(); ++r)
    out += fit_from(fitter.segments()[r], needed[r], hz, 0).misfit;
  return out;
}

/// Returns the frequencies of the strongest lines of the whole force. If the line causes most of
/// the motion, a linear element would explain the line.
std::vector<double> lines_of_force_hz(const RecordSegment& s, const NeededSignal& needed) {
  const VectorXd power = needed.weight.array() * needed.force.array().abs2();
  std::vector<Index> peaks;
  for (Index b = 1; b + 1 < power.size(); ++b)
    if (power[b] > power[b - 1] && power[b] >= power[b + 1]) peaks.push_back(b);
  std::sort(peaks.begin(), peaks.end(), [&](Index i, Index j) { return power[i] > power[j]; });
  if (peaks.size() > kLines) peaks.resize(kLines);
  std::vector<double> out;
  for (const Index b : peaks) out.push_back(s.w[b] / (2 * M_PI));
  return out;
}

/// Returns the better of the strongest line beyond a linear element and of a line fitted together
/// with one.
double line_hz(const Fitter& fitter, const std::vector<NeededSignal>& needed) {
  double best_hz = strongest_line_hz(fitter, needed);
  double least = misfit_with_line(fitter, needed, best_hz);
  const double step = kHzStep / fitter.segments()[0].seconds();
  for (const double middle : lines_of_force_hz(fitter.segments()[0], needed[0]))
    for (int i = -kNear; i <= kNear; ++i) {
      const double hz = middle + i * step;
      const double misfit = misfit_with_line(fitter, needed, hz);
      if (misfit >= least) continue;
      least = misfit;
      best_hz = hz;
    }
  return best_hz;
}

/// Returns an external harmonic force at a node: the strongest frequency in the needed force, and
/// its onset and two amplitudes in every record.
Proposal harmonic_proposal(const Fitter& fitter, const Localisation& place,
                           const std::vector<NeededSignal>& needed, const EffectPlace& node) {
  const Band band = fit_band(fitter);
  const double hz = line_hz(fitter, needed);
  ModelEffect e;
  e.form = LawForm::harmonic;
  e.place = node;
  e.parameters = {bounded_parameter(hz, 0.02 / fitter.segments()[0].seconds(), 0.5 * band.low_hz,
                                    2 * band.high_hz)};
  double misfit = 0;
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const OnsetFit best = best_onset(fitter.segments()[r], needed[r], hz);
    const VectorXd& amplitudes = best.fit.coefficients;
    const double size = std::hypot(amplitudes[0], amplitudes[1]);
    e.record_parameters.push_back({linear_parameter(amplitudes[0], 0.01 * size),
                                   linear_parameter(amplitudes[1], 0.01 * size)});
    e.onset_s.push_back(best.onset_s);
    misfit += best.fit.misfit;
  }
  return proposal_of(place, std::move(e), EffectKind::unmeasured_force, misfit);
}

constexpr double kSlow = 0.3;  ///< of the rms rate: width of the friction term

constexpr double kEnds_s = 2;  ///< of a segment, which end effects disturb

/// Adds a hidden mass on a spring: force m a T(w).
void add_resonator(const Fitter& fitter, const Localisation& place,
                   const std::vector<NeededSignal>& needed, const EffectPlace& node,
                   std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  const VectorXd at = node_direction(plant, node.story, node.frame);
  const Eigen::RowVectorXd motion = at.transpose() * plant.motion;
  std::vector<VectorXcd> accel;
  for (std::size_t r = 0; r < needed.size(); ++r)
    accel.push_back((motion * place.motion[r]).transpose());
  ScalarFit least;
  double chosen_hz = 0, chosen_h = 0;
  const Band band = fit_band(fitter);
  const bool has_element = needed.front().d.size() > 0;
  for (double hz = band.low_hz; hz < 0.9 * band.high_hz; hz *= 1.03)
    for (const double h : {0.01, 0.03, 0.1, 0.3}) {
      std::vector<std::vector<VectorXcd>> columns(needed.size());
      for (std::size_t r = 0; r < needed.size(); ++r) {
        const VectorXd& w = fitter.segments()[r].w;
        const double wr = 2 * M_PI * hz;
        const auto spring = (wr * wr + 2 * h * wr * w.array() * kJ).eval();
        if (has_element) columns[r] = linear_columns(needed[r], w);
        columns[r].push_back((accel[r].array() * spring / (spring - w.array().square())).matrix());
      }
      const ScalarFit fit = scalar_fit(needed, columns);
      if (fit.misfit < least.misfit && fit.coefficients.tail(1)[0] > 0) {
        least = fit;
        chosen_hz = hz;
        chosen_h = h;
      }
    }
  if (least.misfit < 1e299) {
    ModelEffect e;
    e.form = LawForm::resonator;
    e.place = node;
    const double mass = least.coefficients.tail(1)[0];
    e.parameters = {bounded_parameter(mass, 0.02 * mass, 1e-6 * mass, 1e15),
                    logarithmic_parameter(chosen_hz, 0.3 * band.low_hz, 3 * band.high_hz),
                    logarithmic_parameter(chosen_h, 1e-3, 2)};
    out.push_back(proposal_of(place, std::move(e), EffectKind::tuned_mass_damper, least.misfit));
  }
}

/// Power of `force` in every second, and that of the ground's motion.
struct Seconds {
  std::vector<double> force, ground;
};

Seconds seconds_of(const Plant& plant, const RecordSegment& s, const VectorXcd& force) {
  Seconds out;
  const VectorXd f = signal_of(force, s, 1);
  const auto length = std::max<Index>(1, static_cast<Index>(std::lround(s.rate_hz)));
  const Index ends =
      std::min<Index>(static_cast<Index>(std::lround(kEnds_s * s.rate_hz)), f.size() / 10);
  for (Index at = ends; at + length <= f.size() - ends; at += length) {
    out.force.push_back(f.segment(at, length).squaredNorm() / static_cast<double>(length));
    double ground = 0;
    for (Index a = 0; a < plant.axis_count(); ++a)
      if (plant.axes[static_cast<std::size_t>(a)].story == 0)
        ground += s.accel.col(a).segment(at, length).squaredNorm();
    out.ground.push_back(ground);
  }
  return out;
}

/// Returns the power of a force while the ground is at rest, over its mean power. A law of the
/// building has no such power. Returns 0 if the force does not exceed its noise.
double share_at_rest(const Fitter& fitter, const RecordSegment& s, const NeededSignal& needed) {
  const SearchSettings& settings = fitter.settings();
  const Seconds seconds = seconds_of(fitter.plant(), s, beyond_linear(s, needed));
  const std::size_t count = seconds.force.size();
  if (count < 8) return 0;
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return seconds.ground[a] < seconds.ground[b];
  });
  const double intervals = static_cast<double>(s.intervals());
  const double noise = 2 * needed.weight.cwiseInverse().sum() / (intervals * intervals);
  const auto quiet = std::max<std::size_t>(
      2, static_cast<std::size_t>(settings.at_rest * static_cast<double>(count)));
  double rest = 0, all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    all += seconds.force[order[i]] / static_cast<double>(count);
    if (i < quiet) rest += seconds.force[order[i]] / static_cast<double>(quiet);
  }
  return all > settings.stands_out * noise ? (rest - noise) / (all - noise) : 0;
}

/// Returns true if nonlinear laws of the element's deformation explain more than `share` of a force
/// beyond its linear part. The force is then a law of the element.
bool follows_motion(const RecordSegment& s, const NeededSignal& needed, int ratio, double share) {
  if (needed.d_t.size() == 0) return false;
  std::vector<VectorXcd> columns = linear_columns(needed, s.w);
  const double linear = scalar_fit({needed}, {columns}).misfit;
  const auto d = needed.d_t.array(), v = needed.v_t.array();
  const double slow = kSlow * std::sqrt(v.square().mean());
  for (const VectorXd& law :
       {VectorXd(d.cube()), VectorXd(d * d.abs()), VectorXd(v * v.abs()),
        VectorXd((v / std::max(slow, 1e-300)).tanh()), VectorXd(d.square() * v)})
    columns.push_back(band_of(law, s, ratio));
  const double curved = scalar_fit({needed}, {columns}).misfit;
  const auto noise = static_cast<double>(s.bins());
  return linear - curved > share * std::max(linear - noise, 0.0) + noise;
}

}  // namespace

void add_node_proposals(const Fitter& fitter, const Localisation& place,
                        const std::vector<NeededSignal>& needed, const EffectPlace& node,
                        std::vector<Proposal>& out) {
  const SearchSettings& settings = fitter.settings();
  add_resonator(fitter, place, needed, node, out);
  out.push_back(harmonic_proposal(fitter, place, needed, node));
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const RecordSegment& s = fitter.segments()[r];
    const double at_rest = share_at_rest(fitter, s, needed[r]);
    if (at_rest < settings.some_at_rest) return;
    const double share =
        at_rest < settings.much_at_rest ? settings.follows : settings.follows_at_rest;
    if (follows_motion(s, needed[r], fitter.ratio(r), share)) return;
  }
  if (needed.front().d_t.size() > 0 && follows_motion(kind_of_law(fitter, needed).kind)) return;
  ModelEffect e;
  e.form = LawForm::broadband;
  e.place = node;
  out.push_back(proposal_of(place, std::move(e), EffectKind::unmeasured_force));
}

}  // namespace framewatch::estimator
