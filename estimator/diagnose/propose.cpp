#include "estimator/diagnose/propose.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include <Eigen/Cholesky>

namespace framewatch {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
constexpr Complex kJ{0, 1};
constexpr double kBilinear = 40;  ///< exponent that stands for a corner

/// The signal that a place needs, with its noise: what any law there has to explain.
struct Needed {
  VectorXcd force;    ///< per bin
  VectorXd weight;    ///< 1 / variance of it
  VectorXcd d;        ///< deformation of the element, or displacement of the node, m
  VectorXd d_t, v_t;  ///< in time, fine
};

Knob linear(double value, double step) {
  Knob out;
  out.value = value;
  out.step = std::max(std::abs(step), 1e-30);
  return out;
}

Knob logarithmic(double value, double low, double high) {
  Knob out;
  out.logarithmic = true;
  out.value = std::log(value);
  out.step = 0.02;
  out.low = std::log(low);
  out.high = std::log(high);
  return out;
}

Knob bounded(double value, double step, double low, double high, bool free = true) {
  Knob out = linear(value, step);
  out.low = low;
  out.high = high;
  out.free = free;
  return out;
}

/// Weighted least squares of the needed force on complex columns with real coefficients; the last
/// is the law's.
struct ScalarFit {
  double misfit = 1e300;
  VectorXd coefficients;
};

ScalarFit scalar_fit(const std::vector<Needed>& needed,
                     const std::vector<std::vector<VectorXcd>>& columns) {
  const auto count = static_cast<Index>(columns.front().size());
  MatrixXd normal = MatrixXd::Zero(count, count);
  VectorXd right = VectorXd::Zero(count);
  double total = 0;
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const VectorXd& w = needed[r].weight;
    for (Index i = 0; i < count; ++i) {
      const VectorXcd& a = columns[r][static_cast<std::size_t>(i)];
      right[i] += (w.array() * (a.conjugate().array() * needed[r].force.array()).real()).sum();
      for (Index j = 0; j <= i; ++j) {
        const VectorXcd& b = columns[r][static_cast<std::size_t>(j)];
        normal(i, j) += (w.array() * (a.conjugate().array() * b.array()).real()).sum();
        normal(j, i) = normal(i, j);
      }
    }
    total += (w.array() * needed[r].force.array().abs2()).sum();
  }
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  ScalarFit out;
  out.coefficients = scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
  out.misfit = total - out.coefficients.dot(right);
  return out;
}

class ElementProposals {
 public:
  ElementProposals(const Fitter& fitter, const Localisation& place,
                   const std::vector<Needed>& needed, int element)
      : fitter_(fitter), place_(place), needed_(needed), element_(element) {
    for (const Needed& n : needed) {
      peak_ = std::max(peak_, n.d_t.cwiseAbs().maxCoeff());
      rate_ = std::max(rate_, n.v_t.cwiseAbs().maxCoeff());
    }
  }

  std::vector<Proposal> all() {
    const double k = fitter_.plant().design[element_];
    const double force = k * peak_;
    using F = LawForm;
    best(F::power, EffectKind::cubic_stiffness, {1.5, 2, 3, 5}, [&](double p) {
      return std::vector<Knob>{linear(1, 0.01 * force), bounded(p, 0.02, 1.2, 9)};
    });
    std::vector<double> yields;
    for (double y = 0.9; y > 0.004; y *= 0.7) yields.push_back(y);
    for (const double n : {1.0, 2.0, kBilinear})
      best(F::hysteresis, n > 20 ? EffectKind::bilinear_hysteresis : EffectKind::bouc_wen, yields,
           [&](double y) {
             return std::vector<Knob>{
                 linear(1, 0.01 * k), logarithmic(y * peak_, 1e-4 * peak_, 3 * peak_),
                 bounded(n, 0.05, 0.5, 60, false), bounded(0.5, 0.02, 0.1, 1.0, false)};
           });
    if (fitter_.plant().table[element_].frame >= 0)
      for (const double slip : {0.7, 0.9})
        best(F::pinched, EffectKind::pinching, yields, [&](double y) {
          return std::vector<Knob>{linear(1, 0.01 * k),
                                   logarithmic(y * peak_, 1e-3 * peak_, 3 * peak_),
                                   bounded(2, 0.05, 0.5, 60, false),
                                   bounded(0.5, 0.02, 0.1, 1.0, false),
                                   bounded(slip, 0.02, 0.3, 0.99),
                                   logarithmic(0.2, 0.05, 1.0)};
        });
    best(F::friction, EffectKind::coulomb_friction, {0.1, 0.03, 0.01, 0.003}, [&](double v0) {
      return std::vector<Knob>{linear(1, 0.01 * force),
                               logarithmic(v0 * rate_, 1e-4 * rate_, 0.3 * rate_)};
    });
    best(F::power_damping, EffectKind::quadratic_damping, {0.4, 1.5, 2, 3}, [&](double p) {
      return std::vector<Knob>{linear(1, 0.01 * force), bounded(p, 0.02, 0.15, 5)};
    });
    std::vector<double> gaps;
    for (double g = 0.03; g < 0.97; g += g < 0.1 ? 0.03 : 0.07) gaps.push_back(g);
    for (const F form : {F::gap_positive, F::gap_negative, F::gap_both})
      best(form, form == F::gap_both ? EffectKind::two_sided_gap : EffectKind::one_sided_gap, gaps,
           [&](double g) {
             return std::vector<Knob>{linear(1, 0.01 * k),
                                      logarithmic(g * peak_, 1e-3 * peak_, peak_)};
           });
    changing(k);
    return std::move(out_);
  }

 private:
  std::vector<std::vector<VectorXcd>> linear_columns() const {
    std::vector<std::vector<VectorXcd>> out;
    for (std::size_t r = 0; r < needed_.size(); ++r) {
      const VectorXd& w = fitter_.stretches()[r].w;
      out.push_back({needed_[r].d, VectorXcd(needed_[r].d.array() * w.array() * kJ)});
    }
    return out;
  }

  VectorXcd law_bins(const ModelEffect& effect, std::size_t r) const {
    const Stretch& s = fitter_.stretches()[r];
    const int ratio = fitter_.ratio(r);
    return band_of(
        law_force(effect.law(r), needed_[r].d_t, needed_[r].v_t, 1 / (s.rate_hz * ratio)), s,
        ratio);
  }

  ModelEffect effect_of(LawForm form, std::vector<Knob> knobs) const {
    ModelEffect out;
    out.form = form;
    out.place = place_.suspects.front().place;
    out.knobs = std::move(knobs);
    out.deformation = peak_;
    out.rate = rate_;
    return out;
  }

  void add(ModelEffect effect, EffectKind kind, const ScalarFit& fit) {
    effect.knobs[0].value = fit.coefficients[2];
    Proposal p{place_.model, kind, effect.place, fit.misfit, false};
    const Index elements = fitter_.plant().element_count();
    const double least = 0.05 * fitter_.plant().design[element_];
    p.model.theta[element_] = std::max(place_.model.theta[element_] + fit.coefficients[0], least);
    p.model.theta[element_ + elements] += fit.coefficients[1];
    p.model.effects.push_back(std::move(effect));
    out_.push_back(std::move(p));
  }

  void best(LawForm form, EffectKind kind, const std::vector<double>& grid,
            const std::function<std::vector<Knob>(double)>& knobs) {
    ScalarFit least;
    ModelEffect chosen;
    for (const double value : grid) {
      const ModelEffect effect = effect_of(form, knobs(value));
      auto columns = linear_columns();
      for (std::size_t r = 0; r < needed_.size(); ++r) columns[r].push_back(law_bins(effect, r));
      const ScalarFit fit = scalar_fit(needed_, columns);
      const bool dissipates = form == LawForm::friction || form == LawForm::power_damping ||
                              form == LawForm::hysteresis || form == LawForm::pinched;
      if (dissipates && fit.coefficients[2] < 0) continue;
      if (fit.misfit < least.misfit) {
        least = fit;
        chosen = effect;
      }
    }
    if (least.misfit < 1e299) add(std::move(chosen), kind, least);
  }

  /// Onset and duration are each record's own; one change for all.
  void changing(double k) {
    for (const bool sudden : {true, false}) {
      ModelEffect effect = effect_of(LawForm::changing, {linear(1, 0.01 * k)});
      effect.record_knobs.resize(needed_.size());
      for (std::size_t r = 0; r < needed_.size(); ++r) {
        const double seconds = fitter_.stretches()[r].seconds();
        double lowest = 1e300;
        std::vector<double> lengths{0.05};
        if (!sudden) lengths = {0.3 * seconds, 0.6 * seconds, seconds};
        for (const double length : lengths)
          for (double t0 = 0; t0 < seconds - 0.5 * length; t0 += 0.025 * seconds) {
            ModelEffect one = effect;
            one.record_knobs[r] = {bounded(t0, 0.1, -0.2 * seconds, seconds),
                                   logarithmic(length, 0.02, 2 * seconds)};
            std::vector<std::vector<VectorXcd>> columns = linear_columns();
            columns = {columns[r]};
            columns[0].push_back(law_bins(one, r));
            const ScalarFit fit = scalar_fit({needed_[r]}, columns);
            if (fit.misfit < lowest) {
              lowest = fit.misfit;
              effect.record_knobs[r] = one.record_knobs[r];
            }
          }
        effect.record_knobs[r][1].free = !sudden;
      }
      auto columns = linear_columns();
      for (std::size_t r = 0; r < needed_.size(); ++r) columns[r].push_back(law_bins(effect, r));
      add(effect, sudden ? EffectKind::stiffness_drop : EffectKind::stiffness_drift,
          scalar_fit(needed_, columns));
    }
  }

  const Fitter& fitter_;
  const Localisation& place_;
  const std::vector<Needed>& needed_;
  int element_;
  double peak_ = 0, rate_ = 0;
  std::vector<Proposal> out_;
};

/// A resonator's or an oscillating force's proposals at a node.
void add_node_proposals(const Fitter& fitter, const Localisation& place,
                        const std::vector<Needed>& needed, const EffectPlace& node,
                        std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  const VectorXd at = node_direction(plant, node.story, node.frame);
  const Eigen::RowVectorXd motion = at.transpose() * plant.motion;
  std::vector<VectorXcd> accel;
  for (std::size_t r = 0; r < needed.size(); ++r)
    accel.push_back((motion * place.motion[r]).transpose());

  // Hidden mass on a spring: force m a T(w).
  ScalarFit least;
  double chosen_hz = 0, chosen_h = 0;
  const Band band{fitter.stretches()[0].w[0] / (2 * M_PI),
                  fitter.stretches()[0].w.tail(1)[0] / (2 * M_PI)};
  const bool has_element = needed.front().d.size() > 0;
  for (double hz = band.low_hz; hz < 0.9 * band.high_hz; hz *= 1.03)
    for (const double h : {0.01, 0.03, 0.1, 0.3}) {
      std::vector<std::vector<VectorXcd>> columns(needed.size());
      for (std::size_t r = 0; r < needed.size(); ++r) {
        const VectorXd& w = fitter.stretches()[r].w;
        const double wr = 2 * M_PI * hz;
        const auto spring = (wr * wr + 2 * h * wr * w.array() * kJ).eval();
        if (has_element)
          columns[r] = {needed[r].d, VectorXcd(needed[r].d.array() * w.array() * kJ)};
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
    e.knobs = {bounded(mass, 0.02 * mass, 1e-6 * mass, 1e15),
               logarithmic(chosen_hz, 0.3 * band.low_hz, 3 * band.high_hz),
               logarithmic(chosen_h, 1e-3, 2)};
    Proposal p{place.model, EffectKind::tuned_mass_damper, node, least.misfit, false};
    p.model.effects.push_back(e);
    out.push_back(p);
  }

  // One frequency from outside: the line that stands out most in the needed force.
  double best_gain = 0, best_hz = 0;
  const Stretch& first = fitter.stretches()[0];
  const double seconds = first.seconds();
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
        value[rows] = needed[r].force[b];
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
  e.knobs = {bounded(best_hz, 0.02 / seconds, 0.5 * band.low_hz, 2 * band.high_hz)};
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
      if (has_element) {
        columns.push_back(needed[r].d);
        columns.push_back(needed[r].d.array() * s.w.array() * kJ);
      }
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
    e.record_knobs.push_back(
        {linear(lowest.coefficients[0], 0.01 * size), linear(lowest.coefficients[1], 0.01 * size)});
    e.onset_s.push_back(onset);
    misfit += lowest.misfit;
  }
  Proposal p{place.model, EffectKind::unmeasured_force, node, misfit, false};
  p.model.effects.push_back(e);
  out.push_back(p);
}

int flat_samples(const Stretch& s, Index axis, double& level) {
  const VectorXd a = s.accel.col(axis);
  const double top = a.maxCoeff(), bottom = a.minCoeff();
  const double width = 1e-3 * (top - bottom);
  level = 0.5 * (top - bottom);
  int high = 0, low = 0;
  for (Index i = 0; i < a.size(); ++i) {
    high += a[i] > top - width;
    low += a[i] < bottom + width;
  }
  return std::max(high, low);
}

void add_axis_proposals(const Fitter& fitter, const Localisation& place,
                        std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  const int axis = place.suspects.front().axis;
  const EffectPlace here = place.suspects.front().place;
  // What the axis should have read, from all others.
  double own = 0, cross = 0, late = 0, late_weight = 0;
  std::vector<MatrixXcd> truth(place.motion.size());
  for (std::size_t r = 0; r < place.motion.size(); ++r) {
    const Stretch& s = fitter.stretches()[r];
    Model neutral = place.model;
    const Whitened system =
        whiten(plant, neutral, s, r, Forcing::measured, place.motion[r], fitter.ratio(r));
    truth[r] = system.calibrated.row(axis);
    const Index n = plant.equations();
    for (Index b = 0; b < s.bins(); ++b) {
      VectorXcd u = system.operation[static_cast<std::size_t>(b)].col(axis);
      system.factor[static_cast<std::size_t>(b)].triangularView<Eigen::Lower>().solveInPlace(u);
      VectorXcd rest(n);
      rest.real() = system.rest.segment(2 * n * b, n);
      rest.imag() = system.rest.segment(2 * n * b + n, n);
      if (place.suspects.size() > 1) {
        const MatrixXcd basis =
            suspect_basis(system, b, {place.suspects.begin() + 1, place.suspects.end()});
        u -= (basis * (basis.adjoint() * u)).eval();
      }
      const double weight = std::max(u.squaredNorm(), 1e-300);
      const Complex read = truth[r](0, b);
      const Complex should = read - u.dot(rest) / weight;
      truth[r](0, b) = should;
      own += weight * std::norm(should);
      cross += weight * (std::conj(should) * read).real();
      const Complex turn = std::conj(should) * read;
      late += -weight * turn.imag() * s.w[b];
      late_weight += weight * turn.real() * s.w[b] * s.w[b];
    }
  }
  const double gain = own > 0 ? cross / own - 1 : 0;
  {
    Proposal p{place.model, gain < -1.5 ? EffectKind::polarity : EffectKind::gain_error, here, 0,
               false};
    p.model.free_gain.push_back(axis);
    p.model.gain[axis] += gain;
    out.push_back(p);
  }
  {
    Proposal p{place.model, EffectKind::time_shift, here, 0, false};
    p.model.free_clock.push_back(axis);
    if (late_weight > 0) p.model.clock_s[axis] += late / late_weight;
    out.push_back(p);
  }
  const SensorAxis& a = plant.axes[static_cast<std::size_t>(axis)];
  for (std::size_t other = 0; other < plant.axes.size(); ++other) {
    const SensorAxis& b = plant.axes[other];
    if (b.story != a.story || b.direction == a.direction) continue;
    ModelEffect e;
    e.form = LawForm::misaligned;
    e.place = here;
    e.place.kind = PlaceKind::channel_pair;
    e.place.with_channel = static_cast<int>(other);
    e.knobs = {bounded(0.0, 1e-3, -1.5, 1.5)};
    Proposal p{place.model, EffectKind::misalignment, e.place, 0, false};
    p.model.effects.push_back(e);
    out.push_back(p);
  }
  for (std::size_t r = 0; r < fitter.stretches().size(); ++r) {
    double level = 0;
    if (flat_samples(fitter.stretches()[r], axis, level) < 8) continue;
    Proposal p{place.model, EffectKind::clipping, here, 0, true};
    out.push_back(p);
    break;
  }
}

}  // namespace

std::vector<Proposal> propose(const Fitter& fitter, const Localisation& all, std::size_t which) {
  const Plant& plant = fitter.plant();
  Localisation place = all;
  std::swap(place.suspects[0], place.suspects[which]);
  const Suspect& suspect = place.suspects.front();
  std::vector<Proposal> out;
  if (suspect.kind == Suspect::Kind::axis) {
    add_axis_proposals(fitter, place, out);
    return out;
  }
  if (suspect.kind == Suspect::Kind::crossing || suspect.kind == Suspect::Kind::rocking) {
    ModelEffect e;
    const bool mass = suspect.kind == Suspect::Kind::crossing;
    e.place = suspect.place;
    const auto add = [&](LawForm form, EffectKind kind, double start, double step, double low) {
      e.form = form;
      e.knobs = {bounded(start, step, low, 1e15)};
      Proposal p{place.model, kind, e.place, 0, false};
      p.model.effects.push_back(e);
      out.push_back(p);
    };
    if (mass) {
      const double typical = plant.structure.node_mass[0];
      add(LawForm::mass, EffectKind::extra_mass, 0.05 * typical, 0.01 * typical, -typical);
    } else {
      const double k = plant.design.head(plant.element_count()).mean();
      const double h = plant.structure.story_height[0];
      const double flexibility = 0.05 / (k * h * h * plant.structure.frames());
      add(LawForm::rocking, EffectKind::base_rocking, flexibility, 0.1 * flexibility, 0);
      add(LawForm::bending, EffectKind::frame_bending, flexibility, 0.1 * flexibility, 0);
    }
    return out;
  }

  // The force that the place needs.
  std::vector<Needed> needed;
  const VectorXd direction = suspect.directions.col(0);
  for (std::size_t r = 0; r < fitter.stretches().size(); ++r) {
    const Stretch& s = fitter.stretches()[r];
    const Whitened system =
        whiten(plant, place.model, s, r, Forcing::measured, place.motion[r], fitter.ratio(r));
    Needed one;
    one.force.resize(s.bins());
    one.weight.resize(s.bins());
    const Index n = plant.equations();
    for (Index b = 0; b < s.bins(); ++b) {
      // With what the other places do taken out.
      std::vector<Suspect> others(place.suspects.begin() + 1, place.suspects.end());
      VectorXcd u = direction.cast<Complex>();
      system.factor[static_cast<std::size_t>(b)].triangularView<Eigen::Lower>().solveInPlace(u);
      if (!others.empty()) {
        const MatrixXcd basis = suspect_basis(system, b, others);
        u -= (basis * (basis.adjoint() * u)).eval();
      }
      VectorXcd rest(n);
      rest.real() = system.residual.segment(2 * n * b, n);
      rest.imag() = system.residual.segment(2 * n * b + n, n);
      one.weight[b] = std::max(u.squaredNorm(), 1e-300);
      one.force[b] = -u.dot(rest) / one.weight[b];
    }
    if (suspect.kind == Suspect::Kind::element) {
      const VectorXcd q = (plant.building.sense.row(suspect.element) * place.motion[r]).transpose();
      one.d = -q.array() / s.w.array().square();
      one.d_t = signal_of(one.d, s, fitter.ratio(r));
      one.v_t = signal_of(one.d.array() * s.w.array() * kJ, s, fitter.ratio(r));
    }
    needed.push_back(std::move(one));
  }
  if (suspect.kind == Suspect::Kind::element)
    out = ElementProposals(fitter, place, needed, suspect.element).all();
  const bool at_node =
      suspect.kind == Suspect::Kind::node || (suspect.kind == Suspect::Kind::element &&
                                              suspect.place.story == 1 && suspect.place.frame >= 0);
  if (at_node) {
    EffectPlace node = suspect.place;
    node.kind = PlaceKind::node;
    add_node_proposals(fitter, place, needed, node, out);
  }
  if (suspect.kind == Suspect::Kind::link ||
      (suspect.kind == Suspect::Kind::node && suspect.place.story >= 2)) {
    for (const bool spring : {true, false}) {
      ModelEffect e;
      e.form = spring ? LawForm::spring : LawForm::damper;
      e.place = suspect.place;
      e.place.kind = PlaceKind::node_pair;
      const Index element = plant.table.frame_stiffness(1, e.place.frame);
      const double size = plant.design[spring ? element : element + plant.element_count()];
      e.knobs = {bounded(0.05 * size, 0.02 * size, spring ? -10 * size : 0, 1e15)};
      Proposal p{place.model, spring ? EffectKind::added_spring : EffectKind::added_damper, e.place,
                 0, false};
      p.model.effects.push_back(e);
      out.push_back(p);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Proposal& x, const Proposal& y) { return x.misfit < y.misfit; });
  return out;
}

EffectKind name_of_fit(const ModelEffect& effect, const Stretch& stretch) {
  switch (effect.form) {
    case LawForm::power:
      return effect.knobs[1].plain() < 2.45 ? EffectKind::quadratic_stiffness
                                            : EffectKind::cubic_stiffness;
    case LawForm::hysteresis:
      if (effect.knobs[1].plain() < 0.02 * effect.deformation) return EffectKind::coulomb_friction;
      return effect.knobs[2].plain() > 20 ? EffectKind::bilinear_hysteresis : EffectKind::bouc_wen;
    case LawForm::pinched:
      return EffectKind::pinching;
    case LawForm::friction:
      return EffectKind::coulomb_friction;
    case LawForm::power_damping:
      return EffectKind::quadratic_damping;
    case LawForm::gap_positive:
    case LawForm::gap_negative:
      return EffectKind::one_sided_gap;
    case LawForm::gap_both:
      return EffectKind::two_sided_gap;
    case LawForm::changing: {
      double longest = 0;
      for (const std::vector<Knob>& knobs : effect.record_knobs)
        longest = std::max(longest, knobs[1].plain());
      return longest < 0.06 * stretch.seconds() ? EffectKind::stiffness_drop
                                                : EffectKind::stiffness_drift;
    }
    case LawForm::mass:
      return EffectKind::extra_mass;
    case LawForm::resonator:
      return EffectKind::tuned_mass_damper;
    case LawForm::spring:
      return EffectKind::added_spring;
    case LawForm::damper:
      return EffectKind::added_damper;
    case LawForm::rocking:
      return EffectKind::base_rocking;
    case LawForm::bending:
      return EffectKind::frame_bending;
    case LawForm::harmonic:
      return EffectKind::unmeasured_force;
    case LawForm::gain:
      return EffectKind::gain_error;
    case LawForm::shift:
      return EffectKind::time_shift;
    case LawForm::misaligned:
      return EffectKind::misalignment;
    case LawForm::swapped:
      break;
  }
  return EffectKind::swapped;
}

}  // namespace framewatch
