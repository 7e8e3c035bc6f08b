// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/free_run.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Core>

#include "estimator/diagnose/model/law_port.h"
#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/model/modal_system.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/model/run_system.h"
#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Motion of the coordinates relative to the ground at one sample of a segment's lead.
struct InitialMotion {
  Eigen::Index sample = 0;                 ///< of the lead
  Eigen::VectorXd displacement, velocity;  ///< m, m/s
};

constexpr Index kFewestSamples = 64;
constexpr double kTaper = 0.05;    ///< of the record, at either end
constexpr Index kFirstShare = 20;  ///< the lead begins with its first 1/20
constexpr double kMoving = 0.1;
constexpr Index kOfLead = 4;  ///< the initial instant lies a quarter into the lead

double taper(Index i, Index size) {
  const double edge = kTaper * static_cast<double>(size);
  const double at = static_cast<double>(std::min(i, size - 1 - i)) / edge;
  return at < 1 ? 0.5 - 0.5 * std::cos(M_PI * at) : 1.0;
}

/// Returns true if the floors move at the start: compares the rms of the readings there with that
/// of the whole lead.
bool begins_in_motion(const Plant& plant, const RecordSegment& segment) {
  const Index first = std::max<Index>(1, segment.lead.rows() / kFirstShare);
  double begin = 0, all = 0;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    if (plant.is_input(a)) continue;
    begin += segment.lead.col(a).head(first).squaredNorm() / static_cast<double>(first);
    all += segment.lead.col(a).squaredNorm() / static_cast<double>(segment.lead.rows());
  }
  return begin > kMoving * kMoving * all;
}

/// Returns the measured motion a quarter into the lead, so that a record that begins in motion need
/// not be simulated from rest. Integrates the readings within the segment's band. Returns nullopt
/// if there is no lead, or if the lead begins at rest: a run from rest is then exact.
std::optional<InitialMotion> initial_motion(const Plant& plant, const Model& model,
                                            const RecordSegment& segment) {
  const Index lead = segment.lead.rows();
  const Index size = smooth_size(lead + segment.accel.rows());
  if (lead == 0 || size < kFewestSamples || segment.w.size() == 0) return std::nullopt;
  if (!begins_in_motion(plant, segment)) return std::nullopt;
  InitialMotion out;
  out.sample = std::max(lead / kOfLead, static_cast<Index>(kTaper * static_cast<double>(size)) + 1);
  if (out.sample >= lead) return std::nullopt;
  VectorXd place = VectorXd::Zero(plant.building.axes()), rate = place;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    VectorXd reading(size);
    for (Index i = 0; i < size; ++i)
      reading[i] = taper(i, size) * (i < lead ? segment.lead(i, a) : segment.accel(i - lead, a)) /
                   (1 + model.gain[a]);
    VectorXcd bins = forward_fourier(reading), rates = bins;
    for (Index k = 0; k < bins.size(); ++k) {
      const double w =
          2 * M_PI * segment.rate_hz * static_cast<double>(k) / static_cast<double>(size);
      const bool inside = w >= segment.w[0] && w <= segment.w.tail(1)[0];
      bins[k] = !inside ? 0 : segment.is_displaced(a) ? bins[k] : Complex(-bins[k] / (w * w));
      rates[k] = kJ * w * bins[k];
    }
    place[a] = inverse_fourier(bins, size)[out.sample];
    rate[a] = inverse_fourier(rates, size)[out.sample];
  }
  const LeastSquares coordinates(plant.constraint);
  const auto relative = [&](const VectorXd& of_axes) {
    return VectorXd(plant.motion * of_axes - coordinates.solve(VectorXd(plant.ground * of_axes)));
  };
  out.displacement = relative(place);
  out.velocity = relative(rate);
  return out;
}

constexpr double kStepsPerPeriod = 30;
constexpr double kNotResolved = 1e-4;  ///< share of the power of the floors' displacements
constexpr int kFewestSteps = 2, kMaxSteps = 12;  ///< per sample
constexpr int kContactSteps =
    4;  ///< for each step without contacts: contacts open and close within a step
constexpr int kPrescribedSteps = 6;  ///< per sample: corners of laws lie between samples
constexpr double kDiverged_m = 1e6;
constexpr int kSweeps = 2;  ///< over several laws within a step
constexpr int kGrows = 60, kIllinois = 60;
constexpr double kRootPart = 1e-9, kMinForce_n = 1e-12;
/// Bounds of stored slopes: steps by steeper slopes are too short if a law softens.
constexpr double kSteepest = -2, kFlattest = -0.5;

/// Finds the root of `miss` near `start`. slope: of `miss` near the root; updated. `miss` falls by
/// at least one per unit unless the law softens.
template <typename Miss>
double root_near(const Miss& miss, double start, double& slope) {
  double before = start, value_before = miss(before);
  double f = before;
  const auto is_small = [&](double change) {
    return std::abs(change) <= kRootPart * std::max({std::abs(f), std::abs(before), kMinForce_n});
  };
  if (is_small(value_before)) return start;
  f = before - value_before / slope;
  double value = miss(f);
  for (int i = 0; i < kGrows && value * value_before > 0 && !is_small(value); ++i) {
    const double width = 2 * (f - before);
    before = std::exchange(f, f + width);
    value_before = std::exchange(value, miss(f));
  }
  if (f != before) slope = std::clamp((value - value_before) / (f - before), kSteepest, kFlattest);
  for (int i = 0; i < kIllinois && !is_small(value) && !is_small(f - before); ++i) {
    const double next = (before * value - f * value_before) / (value - value_before);
    const double found = miss(next);
    if (found * value < 0) {
      before = f;
      value_before = value;
    } else {
      value_before /= 2;
    }
    f = next;
    value = found;
  }
  return f;
}

/// Returns the frequency up to which the measured floors are displaced against the ground.
double highest_of_motion_hz(const Plant& plant, const RecordSegment& segment) {
  const MatrixXd relative = relative_motion(plant).leftCols(plant.axis_count());
  const MatrixXd real = relative * segment.spectrum.real();
  const MatrixXd imaginary = relative * segment.spectrum.imag();
  const VectorXd power =
      (real.colwise().squaredNorm() + imaginary.colwise().squaredNorm()).transpose().array() /
      segment.w.array().pow(4);
  const double unresolved = kNotResolved * power.sum();
  double above = 0;
  for (Index k = segment.bins() - 1; k >= 0; --k) {
    above += power[k];
    if (above > unresolved) return segment.w[k] / (2 * M_PI);
  }
  return plant.highest_hz;
}

std::vector<Index> driving_axes(const Plant& plant) {
  std::vector<Index> out;
  for (Index a = 0; a < plant.axis_count(); ++a)
    if (plant.ground.col(a).cwiseAbs().maxCoeff() > 0 || plant.is_force(a)) out.push_back(a);
  return out;
}

/// The forces of a model's effects during a run. Those of harmonic forces are known in advance;
/// those of element laws and springs depend on the motion at the end of the step.
class RunForces {
 public:
  /// first_input: index of the first effect's force among the inputs.
  RunForces(const Plant& plant, const Model& model, std::size_t record,
            const std::vector<SmallSpring>& springs, const RunSystem& parts, Index first_input,
            ModalSystem& system)
      : record_(record) {
    const Index coordinates = parts.mass.rows();
    const auto force_of = [&](Index element) {
      VectorXd out = VectorXd::Zero(coordinates);
      out.head(plant.equations()) = plant.building.act.col(element);
      return out;
    };
    std::vector<Index> inputs;
    const MatrixXd per_force = springs.empty() ? MatrixXd() : inverse(parts.mass);
    for (const SmallSpring& spring : springs)
      inputs.push_back(system.add_input(-(per_force * force_of(spring.element))));
    for (std::size_t i = 0; i < springs.size(); ++i)
      springs_.push_back(
          {springs[i].stiffness, system.observe(force_of(springs[i].element)), inputs[i]});
    Index input = first_input;
    for (const ActiveLaw& active : active_laws(plant, model)) {
      VectorXd row = VectorXd::Zero(coordinates);
      row.head(plant.equations()) = active.port.act;
      laws_.push_back({LawMotion(law_at(model, active, record)), system.observe(row), input++});
    }
    for (const ModelEffect& e : model.effects)
      if (e.form == LawForm::harmonic) harmonics_.emplace_back(&e, input++);
    at_step_.resize(laws_.size());
  }

  std::size_t laws() const { return laws_.size(); }

  /// Sets the harmonic forces at time t.
  void set_harmonics(double t, VectorXd& inputs) const {
    for (const auto& [e, at] : harmonics_) {
      const double phase = 2 * M_PI * e->parameters[0].plain() * t;
      const std::vector<LawParameter>& r = e->record_parameters[record_];
      inputs[at] =
          t < e->onset_s[record_] ? 0 : r[0].value * std::cos(phase) + r[1].value * std::sin(phase);
    }
  }

  /// Solves for the forces of the laws at the end of a step that `system` has predicted.
  void solve_laws(const ModalSystem& system, double t, VectorXd& inputs) {
    const int sweeps = laws_.size() > 1 ? kSweeps : 1;
    for (RunLaw& law : laws_) law.before = std::exchange(law.force, 2 * law.force - law.before);
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (std::size_t l = 0; l < laws_.size(); ++l) {
        solve(system, l, t);
        inputs[laws_[l].input] = laws_[l].force;
      }
    for (const RunSpring& spring : springs_) {
      double d = system.displacement(spring.seen);
      for (const RunLaw& law : laws_) d += spring.seen.displacement_gain[law.input] * law.force;
      inputs[spring.input] = spring.stiffness * d;
    }
  }

  /// Ends the step. Returns false if the motion has diverged.
  bool accept(std::size_t law, double t) {
    laws_[law].motion.accept(at_step_[law].d, at_step_[law].v, t);
    return std::abs(at_step_[law].d) < kDiverged_m;
  }

  void store(std::size_t law, Index step, LawTrack& track) const {
    track.d[step] = at_step_[law].d;
    track.v[step] = at_step_[law].v;
    track.force[step] = laws_[law].force;
  }

 private:
  struct RunLaw {
    LawMotion motion;
    ModalSystem::Observer seen;
    Index input;
    double force = 0, before = 0;  ///< at the end of this step and of the previous one
    double slope = -1;             ///< of the miss in solve()
  };
  struct RunSpring {
    double stiffness;
    ModalSystem::Observer seen;
    Index input;
  };
  struct Step {
    double d, v;
  };

  /// Solves for the force of one law with the forces of the others held.
  void solve(const ModalSystem& system, std::size_t l, double t) {
    RunLaw& law = laws_[l];
    double d = system.displacement(law.seen), v = system.velocity(law.seen);
    for (std::size_t other = 0; other < laws_.size(); ++other) {
      if (other == l) continue;
      d += law.seen.displacement_gain[laws_[other].input] * laws_[other].force;
      v += law.seen.velocity_gain[laws_[other].input] * laws_[other].force;
    }
    const double gd = law.seen.displacement_gain[law.input];
    const double gv = law.seen.velocity_gain[law.input];
    // f = F(d + gd f, v + gv f): gd, gv < 0 and F rises, so the root is bracketed.
    const auto miss = [&](double f) { return law.motion.force(d + gd * f, v + gv * f, t) - f; };
    law.force = root_near(miss, law.force, law.slope);
    at_step_[l] = {d + gd * law.force, v + gv * law.force};
  }

  std::size_t record_;
  std::vector<RunLaw> laws_;
  std::vector<RunSpring> springs_;
  std::vector<std::pair<const ModelEffect*, Index>> harmonics_;
  std::vector<Step> at_step_;
};

}  // namespace

int steps_per_sample(const Plant& plant, const RecordSegment& segment) {
  if (plant.prescribed) return kPrescribedSteps;
  const double highest_hz = std::min(plant.highest_hz, highest_of_motion_hz(plant, segment));
  return std::clamp(static_cast<int>(std::ceil(kStepsPerPeriod * highest_hz / segment.rate_hz)),
                    kFewestSteps, kMaxSteps);
}

int steps_of(const Model& model, int ratio) {
  const bool contact = std::any_of(model.effects.begin(), model.effects.end(),
                                   [](const ModelEffect& e) { return is_contact(e.form); });
  return contact ? std::max(ratio, std::min(kContactSteps * ratio, kMaxSteps)) : ratio;
}

FreeRun free_run(const Plant& plant, const Model& model, const RecordSegment& segment,
                 std::size_t record, int ratio, RunCache* cache,
                 const std::vector<SmallSpring>& springs) {
  FreeRun out;
  RunCache own;
  RunCache& common = cache ? *cache : own;
  const std::vector<Index> driving = driving_axes(plant);
  const RunSystem parts = run_system(plant, model, driving);
  const double step_s = 1 / (segment.rate_hz * ratio);
  ModalSystem system = common.modes(parts, step_s);
  if (!system.good()) return out;
  const MatrixXd& ground = common.driving(model, segment, record, driving, ratio);
  const Index steps = segment.intervals() * ratio, lead = segment.lead.rows() * ratio;
  RunForces forces(plant, model, record, springs, parts, ground.rows(), system);
  out.tracks.assign(forces.laws(), {VectorXd(steps), VectorXd(steps), VectorXd(steps)});

  VectorXd now = VectorXd::Zero(parts.inputs.cols() + static_cast<Index>(springs.size()));
  VectorXd law_forces = now;
  Index first = -lead;
  if (const auto moving = initial_motion(plant, model, segment)) {
    const Index n = plant.equations();
    VectorXd y = VectorXd::Zero(parts.mass.rows()), v = y;
    y.head(n) = moving->displacement;
    v.head(n) = moving->velocity;
    system.start(y, v);
    first += moving->sample * ratio + 1;
  }
  for (Index i = first; i < steps; ++i) {
    const double t = step_s * static_cast<double>(i);
    now.head(ground.rows()) = ground.col(lead + i);
    forces.set_harmonics(t, now);
    system.predict(now);
    law_forces.setZero();
    forces.solve_laws(system, t, law_forces);
    system.correct(law_forces);
    for (std::size_t l = 0; l < forces.laws(); ++l) {
      if (!forces.accept(l, t)) return out;
      if (i >= 0) forces.store(l, i, out.tracks[l]);
    }
  }
  out.good = true;
  return out;
}

}  // namespace framewatch::estimator
