// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/place_force.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "estimator/diagnose/fit/measured_deformation.h"
#include "estimator/diagnose/fit/whitened.h"
#include "estimator/diagnose/model/free_run.h"
#include "estimator/diagnose/model/law_port.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::RowVectorXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kCycles = 8;      ///< of the strongest motion that are shown
constexpr double kNothing = 1e-9;  ///< share of a row

bool same_port(const LawPort& a, const LawPort& b) {
  return a.element == b.element && a.act == b.act;
}

/// Spring and dashpot of a port; zero if it is not an element.
struct Linear {
  double stiffness = 0, damping = 0;

  VectorXcd force(const VectorXcd& d, const VectorXd& w) const {
    return stiffness * d.array() + damping * kJ * w.array() * d.array();
  }
};

Linear linear_at(const Plant& plant, const Model& model, const LawPort& port) {
  if (port.element < 0) return {};
  return {model.theta[port.element], model.theta[port.element + plant.element_count()]};
}

/// Returns the place of an element with this index in theta.
EffectPlace place_of(const Plant& plant, int element) {
  EffectPlace out;
  for (const Element& e : plant.elements) {
    if (e.stiffness != element) continue;
    out.story = e.story;
    out.kind = e.panel < 0 ? PlaceKind::frame : PlaceKind::panel;
    (e.panel < 0 ? out.frame : out.panel) = e.panel < 0 ? e.frame : e.panel;
  }
  return out;
}

/// A law without force, which tracks the deformation of its place in a free run.
ModelEffect probe(const EffectPlace& place) {
  ModelEffect out;
  out.form = LawForm::power;
  out.place = place;
  out.parameters = {fixed_parameter(0), fixed_parameter(1)};
  return out;
}

/// Motion of one port in the band.
struct Run {
  VectorXcd d, law;  ///< spectra: deformation, m; force of the laws there, N
};

/// Returns the motion of a port in the model's free run; nullopt if the run diverges.
std::optional<Run> run_of(const Plant& plant, Model model, const RecordSegment& segment,
                          std::size_t record, const EffectPlace& place, const LawPort& port) {
  model.effects.push_back(probe(place));
  const int ratio = steps_of(model, steps_per_sample(plant, segment));
  const FreeRun run = free_run(plant, model, segment, record, ratio);
  if (!run.good) return std::nullopt;
  const std::vector<ActiveLaw> laws = active_laws(plant, model);
  Run out;
  out.law = VectorXcd::Zero(segment.bins());
  for (std::size_t i = 0; i < laws.size(); ++i) {
    if (!same_port(laws[i].port, port)) continue;
    const LawTrack& track = run.tracks[i];
    if (!track.d.allFinite() || !track.force.allFinite()) return std::nullopt;
    out.d = band_of(track.d, segment, ratio);
    out.law += band_of(track.force, segment, ratio);
  }
  return out;
}

/// Returns the virtual displacement of the coordinates that adds up the equations to the force of a
/// port: times the port's `act` it is 1.
VectorXd sum_of_equations(const Plant& plant, const EffectPlace& place, const LawPort& port,
                          bool& of_direction) {
  const Structure& s = plant.structure;
  if (place.kind != PlaceKind::frame || port.element < 0) return port.act / port.act.squaredNorm();
  of_direction = plant.stiff_floors || plant.constraint.rows() != plant.constraint.cols();
  VectorXd moved = VectorXd::Zero(plant.constraint.rows());
  for (int story = place.story; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      if (f == place.frame || (of_direction && s.direction(f) == s.direction(place.frame)))
        moved[s.dof(story, f)] = 1;
  const VectorXd sum = plant.constraint.transpose() * moved;
  const MatrixXd square = plant.constraint.transpose() * plant.constraint;
  const VectorXd out = Ldlt(square).solve(sum);
  return out / out.dot(port.act);
}

/// The measured force of a port.
struct Measured {
  VectorXcd d, force;
  double noise_n = 0, modelled_share = 0;
};

/// Returns the rms of a signal. power: sum of |spectrum|^2 over the bins.
double rms_of(double power, const RecordSegment& segment) {
  return std::sqrt(2 * power) / static_cast<double>(segment.intervals());
}

/// Returns the measured force; nullopt if the sensors do not read it. sum: from sum_of_equations().
std::optional<Measured> measure(const Plant& plant, const Model& model,
                                const RecordSegment& segment, std::size_t record,
                                const LawPort& port, const VectorXd& sum) {
  const MatrixXd mass =
      (1 + model.mass_change.array()).matrix().asDiagonal() * plant.building.mass + plant.push;
  const Eigen::RowVectorXd inertia = sum.transpose() * mass;
  const Index hidden = plant.unread.cols(), axes = plant.axis_count();
  if (port.sense.tail(hidden).norm() > kNothing * port.sense.norm() ||
      inertia.tail(hidden).norm() > kNothing * inertia.norm())
    return std::nullopt;
  const int ratio = steps_of(model, steps_per_sample(plant, segment));
  const Whitened system = whiten(plant, model, segment, record, Forcing::measured, {}, ratio);
  if (!system.good) return std::nullopt;

  Measured out;
  const VectorXd& w = segment.w;
  out.d = -(port.sense * system.calibrated).transpose().array() / w.array().square();
  Linear own = linear_at(plant, model, port);
  out.force = own.force(out.d, w);
  const std::vector<ActiveLaw> laws = active_laws(plant, model);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    if (!same_port(laws[i].port, port)) continue;
    out.force += system.force[i];
    own.stiffness += system.linear[i].stiffness;
    own.damping += system.linear[i].damping;
  }
  // The equations' residual is the part that the model's force lacks.
  const MatrixXcd rest = system.operation.times(system.calibrated) + system.forces;
  out.force -= (sum.transpose().cast<Complex>() * rest).transpose();
  const VectorXcd by_model = out.force + (inertia.cast<Complex>() * system.calibrated).transpose();
  out.modelled_share = by_model.norm() / std::max(out.force.norm(), 1e-300);
  double variance = 0;
  for (Index b = 0; b < segment.bins(); ++b) {
    const Complex per_motion = -own.stiffness / (w[b] * w[b]) - kJ * own.damping / w[b];
    const RowVectorXcd row =
        per_motion * port.sense.cast<Complex>() -
        sum.transpose().cast<Complex>() * system.operation[static_cast<std::size_t>(b)];
    variance += row.head(axes).cwiseAbs2() * bin_noise(model, segment, b);
  }
  out.noise_n = rms_of(variance, segment);
  return out;
}

/// Returns the port of a place's laws; of several, the one whose law is strongest in the measured
/// motion. Sets `place` to its element. nullopt without a port.
std::optional<LawPort> port_at(const Plant& plant, const Model& model, const RecordSegment& segment,
                               EffectPlace& place) {
  const bool many = place.kind == PlaceKind::building || place.kind == PlaceKind::whole_frame;
  const bool one = place.kind == PlaceKind::frame || place.kind == PlaceKind::panel ||
                   place.kind == PlaceKind::node || place.kind == PlaceKind::node_pair;
  if (!many && !one) return std::nullopt;
  ModelEffect at;
  at.place = place;
  std::vector<LawPort> ports = law_ports(plant, model, at);
  if (ports.empty()) return std::nullopt;
  if (one) return ports.front();
  std::size_t best = 0;
  double most = -1;
  const MatrixXcd motion = calibrated(model, segment);
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const VectorXcd d = (ports[i].sense.head(plant.axis_count()) * motion).transpose();
    const double strength =
        ports[i].scale * (d.array() / segment.w.array().square()).matrix().norm();
    if (strength <= most) continue;
    most = strength;
    best = i;
  }
  place = place_of(plant, ports[best].element);
  return ports[best];
}

/// Returns the segment with all frequencies above its band, if the plant is small and the sensors
/// read acceleration. Displacement has too much noise there.
RecordSegment widened(const Plant& plant, const RecordSegment& s) {
  const bool displaced = std::count(s.displaced.begin(), s.displaced.end(), 1) > 0;
  if (plant.is_large() || plant.prescribed || displaced) return s;
  const double step_hz = s.rate_hz / static_cast<double>(s.intervals());
  const Band band{(static_cast<double>(s.first_bin) - 0.5) * step_hz, s.rate_hz / 2};
  RecordSegment out = make_segment(s.accel, s.rate_hz, s.variance.cwiseSqrt(), band);
  out.lead = s.lead;
  out.corner_hz = s.corner_hz;
  return out;
}

/// Returns the samples at each end that are left out: two periods of the lowest frequency, at most
/// a tenth. A motion that has not begun or ended there disturbs its integral.
Index left_out(const RecordSegment& s) {
  const double two_periods = 4 * M_PI / s.w[0] * s.rate_hz;
  return std::min(static_cast<Index>(two_periods), s.intervals() / 10);
}

/// Returns a signal in time, without the samples that are left out.
VectorXd inner(const VectorXcd& bins, const RecordSegment& s) {
  const VectorXd all = signal_of(bins, s, 1);
  const Index ends = left_out(s);
  return all.segment(ends, all.size() - 2 * ends);
}

/// Samples of inner() that are shown.
struct Rows {
  Index from = 0, size = 0;
};

/// d: deformation, and its spectrum `bins`.
Rows strongest(const VectorXd& d, const VectorXcd& bins, const RecordSegment& s) {
  const VectorXd power = bins.cwiseAbs2();
  const double w = std::sqrt(power.dot(s.w.cwiseAbs2()) / std::max(power.sum(), 1e-300));
  const auto size = std::clamp<Index>(
      static_cast<Index>(kCycles * 2 * M_PI / std::max(w, 1e-9) * s.rate_hz), 1, d.size());
  Index peak = 0;
  d.cwiseAbs().maxCoeff(&peak);
  return {std::clamp<Index>(peak - size / 2, 0, d.size() - size), size};
}

double rms(const VectorXd& v) {
  return std::sqrt(v.squaredNorm() / static_cast<double>(std::max<Index>(v.size(), 1)));
}

}  // namespace

std::optional<PlaceForce> force_at(const Plant& plant, const Model& linear, const Model& model,
                                   const RecordSegment& given, std::size_t record,
                                   const EffectPlace& place) {
  const RecordSegment segment = widened(plant, given);
  PlaceForce out;
  out.low_hz = segment.w[0] / (2 * M_PI);
  out.high_hz = segment.w[segment.bins() - 1] / (2 * M_PI);
  out.place = place;
  out.record = record;
  const std::optional<LawPort> port = port_at(plant, model, segment, out.place);
  if (!port) return std::nullopt;
  out.is_element = port->element >= 0;
  for (const ActiveLaw& law : active_laws(plant, model))
    out.has_law = out.has_law || same_port(law.port, *port);
  if (!out.is_element && !out.has_law) return std::nullopt;

  const VectorXd sum = sum_of_equations(plant, out.place, *port, out.of_direction);
  const std::optional<Measured> measured = measure(plant, model, segment, record, *port, sum);
  const auto run = [&](const Model& of) {
    return run_of(plant, of, segment, record, out.place, *port);
  };
  const std::optional<Run> before = run(linear), after = run(model);
  const auto simulated = [&](const Model& of, const Run& r) {
    return VectorXcd(linear_at(plant, of, *port).force(r.d, segment.w) + r.law);
  };
  out.measured = measured.has_value();
  if (!measured && !after && !before) return std::nullopt;
  const VectorXcd& d = measured ? measured->d : after ? after->d : before->d;
  const VectorXd shown = inner(d, segment);
  const Rows rows = strongest(shown, d, segment);
  const Index from = left_out(segment) + rows.from;
  out.from_s = static_cast<double>(from) / segment.rate_hz;
  out.to_s = static_cast<double>(from + rows.size) / segment.rate_hz;
  out.peak_d_m = shown.cwiseAbs().maxCoeff();

  VectorXd truth;  // the measured force
  const auto take = [&](const VectorXcd& at, const VectorXcd& bins, ForceCurve& curve,
                        double& peak) {
    const VectorXd force = inner(bins, segment);
    curve = {inner(at, segment).segment(rows.from, rows.size), force.segment(rows.from, rows.size)};
    peak = force.cwiseAbs().maxCoeff();
    return force;
  };
  const auto off = [&](const VectorXd& force) {
    return measured ? rms(force - truth) / std::max(out.measured_rms_n, 1e-300) : 0;
  };
  if (measured) {
    truth = take(measured->d, measured->force, out.measurement, out.measured_n);
    out.measured_rms_n = rms(truth);
    out.noise_n = measured->noise_n;
    out.modelled_share = measured->modelled_share;
  }
  if (before)
    out.linear_off = off(take(before->d, simulated(linear, *before), out.linear, out.linear_n));
  if (after && out.has_law)
    out.with_effects_off =
        off(take(after->d, simulated(model, *after), out.with_effects, out.with_effects_n));
  return out;
}

}  // namespace framewatch::estimator
