#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/propose_parts.h"
#include "estimator/structure/complex.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
constexpr double kFollows = 0.3;  ///< share of a force beyond noise that laws of a motion explain
constexpr double kSlow = 0.3;     ///< of the rate: where friction has turned

constexpr double kStationary = 0.25;  ///< share of the mean power that is there at rest, at least
constexpr double kAsMuch = 0.5;     ///< the same, above which a law must explain most of the force
constexpr double kMostly = 0.6;     ///< instead of kFollows then
constexpr double kStandsOut = 3;    ///< power of a force over its noise
constexpr double kEnds_s = 2;       ///< of a stretch, where what goes on beyond it shows
constexpr double kQuietest = 0.15;  ///< share of the seconds that count as rest

Band band_of_fit(const Fitter& fitter) {
  const VectorXd& w = fitter.stretches()[0].w;
  return {w[0] / (2 * M_PI), w.tail(1)[0] / (2 * M_PI)};
}

/// A hidden mass on a spring: force m a T(w).
void add_resonator(const Fitter& fitter, const Localisation& place,
                   const std::vector<Needed>& needed, const EffectPlace& node,
                   std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  const VectorXd at = node_direction(plant, node.story, node.frame);
  const Eigen::RowVectorXd motion = at.transpose() * plant.motion;
  std::vector<VectorXcd> accel;
  for (std::size_t r = 0; r < needed.size(); ++r)
    accel.push_back((motion * place.motion[r]).transpose());
  ScalarFit least;
  double chosen_hz = 0, chosen_h = 0;
  const Band band = band_of_fit(fitter);
  const bool has_element = needed.front().d.size() > 0;
  for (double hz = band.low_hz; hz < 0.9 * band.high_hz; hz *= 1.03)
    for (const double h : {0.01, 0.03, 0.1, 0.3}) {
      std::vector<std::vector<VectorXcd>> columns(needed.size());
      for (std::size_t r = 0; r < needed.size(); ++r) {
        const VectorXd& w = fitter.stretches()[r].w;
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
    e.knobs = {bounded_knob(mass, 0.02 * mass, 1e-6 * mass, 1e15),
               logarithmic_knob(chosen_hz, 0.3 * band.low_hz, 3 * band.high_hz),
               logarithmic_knob(chosen_h, 1e-3, 2)};
    Proposal p{place.model, EffectKind::tuned_mass_damper, node, least.misfit};
    p.model.effects.push_back(e);
    out.push_back(p);
  }
}

/// A force without what the element that it may as well be of would do linearly.
VectorXcd beyond_linear(const Stretch& s, const Needed& needed) {
  if (needed.d.size() == 0) return needed.force;
  const std::vector<VectorXcd> columns = linear_columns(needed, s.w);
  const VectorXd fit = scalar_fit({needed}, {columns}).coefficients;
  return needed.force - fit[0] * columns[0] - fit[1] * columns[1];
}

/// One frequency from outside: the line that stands out most in the needed force.
void add_harmonic(const Fitter& fitter, const Localisation& place,
                  const std::vector<Needed>& needed, const EffectPlace& node,
                  std::vector<Proposal>& out) {
  const Band band = band_of_fit(fitter);
  const bool has_element = needed.front().d.size() > 0;
  double best_gain = 0, best_hz = 0;
  const Stretch& first = fitter.stretches()[0];
  const double seconds = first.seconds();
  std::vector<VectorXcd> force;
  for (std::size_t r = 0; r < needed.size(); ++r)
    force.push_back(beyond_linear(fitter.stretches()[r], needed[r]));
  for (double hz = band.low_hz; hz < band.high_hz; hz += 0.2 / seconds) {
    double gain = 0;
    for (std::size_t r = 0; r < needed.size(); ++r) {
      const Stretch& s = fitter.stretches()[r];
      const double step = s.w[1] - s.w[0];
      const auto middle = static_cast<Index>(std::lround((2 * M_PI * hz - s.w[0]) / step));
      // A boxcar's line in bins around: two amplitudes explain them.
      MatrixXcd shape(9, 2);
      VectorXcd value(9);
      VectorXd weight(9);
      Index rows = 0;
      const double n = static_cast<double>(s.intervals());
      for (Index b = std::max<Index>(0, middle - 4); b <= std::min(s.bins() - 1, middle + 4); ++b) {
        const auto geometric = [&](double angle) {
          const Complex q = std::polar(1.0, angle);
          return std::abs(q - 1.0) < 1e-9 ? Complex(n)
                                          : (std::polar(1.0, angle * n) - 1.0) / (q - 1.0);
        };
        const double w0 = 2 * M_PI * hz / s.rate_hz, w = s.w[b] / s.rate_hz;
        const Complex up = geometric(w0 - w), down = geometric(-w0 - w);
        shape(rows, 0) = 0.5 * (up + down);
        shape(rows, 1) = 0.5 * (up - down) / kJ;
        value[rows] = force[r][b];
        weight[rows++] = needed[r].weight[b];
      }
      if (rows < 5) continue;
      Needed part;
      part.force = value.head(rows);
      part.weight = weight.head(rows);
      const ScalarFit fit = scalar_fit(
          {part}, {{VectorXcd(shape.col(0).head(rows)), VectorXcd(shape.col(1).head(rows))}});
      gain += (part.weight.array() * part.force.array().abs2()).sum() - fit.misfit;
    }
    if (gain > best_gain) {
      best_gain = gain;
      best_hz = hz;
    }
  }
  ModelEffect e;
  e.form = LawForm::harmonic;
  e.place = node;
  e.knobs = {bounded_knob(best_hz, 0.02 / seconds, 0.5 * band.low_hz, 2 * band.high_hz)};
  double misfit = 0;
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const Stretch& s = fitter.stretches()[r];
    ScalarFit lowest;
    double onset = 0;
    const auto try_onset = [&](double from) {
      VectorXd c(s.intervals()), q(s.intervals());
      for (Index i = 0; i < c.size(); ++i) {
        const double t = static_cast<double>(i) / s.rate_hz;
        c[i] = t < from ? 0 : std::cos(2 * M_PI * best_hz * t);
        q[i] = t < from ? 0 : std::sin(2 * M_PI * best_hz * t);
      }
      // Restoring force is counted; one from outside has the other sign.
      std::vector<VectorXcd> columns{-band_of(c, s, 1), -band_of(q, s, 1)};
      if (has_element)
        for (VectorXcd& column : linear_columns(needed[r], s.w))
          columns.push_back(std::move(column));
      const ScalarFit fit = scalar_fit({needed[r]}, {columns});
      if (fit.misfit < lowest.misfit) {
        lowest = fit;
        onset = from;
      }
    };
    for (double from = 0; from < 0.6 * s.seconds(); from += 0.01 * s.seconds()) try_onset(from);
    const double coarse = onset;
    for (int i = -20; i <= 20; ++i) try_onset(std::max(0.0, coarse + 5e-4 * i * s.seconds()));
    const double size = std::hypot(lowest.coefficients[0], lowest.coefficients[1]);
    e.record_knobs.push_back({linear_knob(lowest.coefficients[0], 0.01 * size),
                              linear_knob(lowest.coefficients[1], 0.01 * size)});
    e.onset_s.push_back(onset);
    misfit += lowest.misfit;
  }
  Proposal p{place.model, EffectKind::unmeasured_force, node, misfit};
  p.model.effects.push_back(e);
  out.push_back(p);
}

/// Power of `force` in every second, and that of the ground's motion.
struct Seconds {
  std::vector<double> force, ground;
};

Seconds seconds_of(const Plant& plant, const Stretch& s, const VectorXcd& force) {
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

/// Share of a force's mean power that is there when the ground is at rest: no law of the building
/// makes such. 0 when the force does not stand out.
double share_at_rest(const Plant& plant, const Stretch& s, const Needed& needed) {
  const Seconds seconds = seconds_of(plant, s, beyond_linear(s, needed));
  const std::size_t count = seconds.force.size();
  if (count < 8) return 0;
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return seconds.ground[a] < seconds.ground[b];
  });
  const double intervals = static_cast<double>(s.intervals());
  const double noise = 2 * needed.weight.cwiseInverse().sum() / (intervals * intervals);
  const auto quiet =
      std::max<std::size_t>(2, static_cast<std::size_t>(kQuietest * static_cast<double>(count)));
  double rest = 0, all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    all += seconds.force[order[i]] / static_cast<double>(count);
    if (i < quiet) rest += seconds.force[order[i]] / static_cast<double>(quiet);
  }
  return all > kStandsOut * noise ? (rest - noise) / (all - noise) : 0;
}

/// Whether a force goes with the deformation of the element it may as well be of, otherwise than
/// linearly, by a share of it: then it is a law of the element, whatever that law is called.
bool follows_motion(const Stretch& s, const Needed& needed, int ratio, double share) {
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
                        const std::vector<Needed>& needed, const EffectPlace& node,
                        std::vector<Proposal>& out) {
  add_resonator(fitter, place, needed, node, out);
  add_harmonic(fitter, place, needed, node, out);
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const Stretch& s = fitter.stretches()[r];
    const double at_rest = share_at_rest(fitter.plant(), s, needed[r]);
    if (at_rest < kStationary) return;
    const double share = at_rest < kAsMuch ? kFollows : kMostly;
    if (follows_motion(s, needed[r], fitter.ratio(r), share)) return;
  }
  ModelEffect e;
  e.form = LawForm::broadband;
  e.place = node;
  Proposal p{place.model, EffectKind::unmeasured_force, node, 0};
  p.model.effects.push_back(e);
  out.push_back(p);
}

}  // namespace framewatch
