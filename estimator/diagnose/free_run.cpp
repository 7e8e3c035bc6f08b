#include "estimator/diagnose/free_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "estimator/diagnose/linear_operation.h"
#include "estimator/diagnose/modal_system.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStepsPerPeriod = 30;
constexpr int kSincHalf = 12;
constexpr double kRunAway_m = 1e6;
constexpr int kSweeps = 2;  ///< over several laws within a step
constexpr int kGrows = 60, kIllinois = 60;
constexpr double kRootPart = 1e-10, kLeastForce_n = 1e-12;

struct System {
  MatrixXd mass, damping, stiffness, inputs;
};

/// Coordinates: the building's, then one per resonator. Inputs: base axes, harmonic forces, laws.
System assemble_system(const Plant& plant, const Model& model, const std::vector<Index>& base) {
  const Index n = plant.equations();
  Index extra = 0, forces = 0;
  for (const ModelEffect& e : model.effects) {
    extra += e.form == LawForm::resonator;
    forces += e.element_law() || e.form == LawForm::harmonic;
  }
  System out;
  out.mass = MatrixXd::Zero(n + extra, n + extra);
  out.mass.diagonal().head(n) = plant.mass.array() * (1 + model.mass_change.array());
  out.damping = MatrixXd::Zero(n + extra, n + extra);
  out.stiffness = out.damping;
  const MatrixXd& act = plant.building.act;
  const Index elements = plant.element_count();
  out.stiffness.topLeftCorner(n, n) =
      act * model.theta.head(elements).asDiagonal() * act.transpose();
  out.damping.topLeftCorner(n, n) = act * model.theta.tail(elements).asDiagonal() * act.transpose();
  Index next = n;
  for (const ModelEffect& e : model.effects) {
    if (e.element_law() || e.form == LawForm::harmonic || e.knobs.empty()) continue;
    const double size = e.knobs[0].plain();
    if (e.form == LawForm::resonator) {
      const double wr = 2 * M_PI * e.knobs[1].plain(), h = e.knobs[2].plain();
      VectorXd b = VectorXd::Zero(n + extra);
      b.head(n) = node_direction(plant, e.place.story, e.place.frame);
      b[next] = -1;
      out.mass(next, next) = std::max(size, 1e-9);
      out.stiffness += std::max(size, 1e-9) * wr * wr * b * b.transpose();
      out.damping += std::max(size, 1e-9) * 2 * h * wr * b * b.transpose();
      ++next;
      continue;
    }
    // Constant matrices of the other linear effects, read off their operation at two frequencies.
    if (e.form == LawForm::mass) {
      for (const int frame : frames_at(plant.structure, e.place.crossing)) {
        const VectorXd at = node_direction(plant, e.place.story, frame);
        out.mass.topLeftCorner(n, n) += size * at * at.transpose();
      }
    } else if (e.form == LawForm::spring || e.form == LawForm::damper) {
      VectorXd at = node_direction(plant, e.place.story, e.place.frame);
      if (e.place.to_story > 0) at -= node_direction(plant, e.place.to_story, e.place.frame);
      (e.form == LawForm::spring ? out.stiffness : out.damping).topLeftCorner(n, n) +=
          size * at * at.transpose();
    } else if (e.form == LawForm::panels) {
      for (const Element& panel : plant.elements) {
        if (panel.panel < 0 || panel.story != e.place.story) continue;
        const Index at = panel.stiffness;
        out.stiffness.topLeftCorner(n, n) +=
            (size - model.theta[at]) * act.col(at) * act.col(at).transpose();
        out.damping.topLeftCorner(n, n) += (e.knobs[1].plain() - model.theta[at + elements]) *
                                           act.col(at) * act.col(at).transpose();
      }
    } else if (e.form == LawForm::rocking || e.form == LawForm::bending) {
      const Eigen::MatrixXcd change = LinearOperation(plant, model, e).at(1.0);
      const MatrixXd back =
          plant.motion.transpose() * (plant.motion * plant.motion.transpose()).inverse();
      out.stiffness.topLeftCorner(n, n) -= (change * back.cast<std::complex<double>>()).real();
      out.damping.topLeftCorner(n, n) -= (change * back.cast<std::complex<double>>()).imag();
    }
  }
  out.inputs = MatrixXd::Zero(n + extra, static_cast<Index>(base.size()) + forces);
  const VectorXd frame_mass =
      assemble(plant.structure, plant.table, VectorXd::Zero(plant.table.size())).mass;
  for (std::size_t i = 0; i < base.size(); ++i)
    out.inputs.col(static_cast<Index>(i)).head(n) =
        -plant.constraint.transpose() * frame_mass.cwiseProduct(plant.ground.col(base[i]));
  for (std::size_t i = 0; i < base.size(); ++i) {
    auto column = out.inputs.col(static_cast<Index>(i));
    column.head(n) = column.head(n).cwiseProduct((1 + model.mass_change.array()).matrix()) -
                     plant.push.col(base[i]);
  }
  for (const ModelEffect& e : model.effects) {
    if (e.form != LawForm::mass) continue;
    for (std::size_t i = 0; i < base.size(); ++i) {
      for (const int frame : frames_at(plant.structure, e.place.crossing)) {
        out.inputs.col(static_cast<Index>(i)).head(n) -=
            e.knobs[0].plain() * node_direction(plant, e.place.story, frame) *
            plant.ground(plant.structure.dof(e.place.story, frame), base[i]);
      }
    }
  }
  next = n;
  auto column = static_cast<Index>(base.size());
  for (const ModelEffect& e : model.effects) {
    if (e.form == LawForm::resonator) {
      for (std::size_t i = 0; i < base.size(); ++i)
        out.inputs(next, static_cast<Index>(i)) =
            -out.mass(next, next) *
            plant.ground(plant.structure.dof(e.place.story, e.place.frame), base[i]);
      ++next;
    }
    if (e.element_law()) {
      out.inputs.col(column++).head(n) = -act.col(element_of(plant, e.place));
    } else if (e.form == LawForm::harmonic) {
      out.inputs.col(column++).head(n) = node_direction(plant, e.place.story, e.place.frame);
    }
  }
  return out;
}

/// Root of `miss` near `start`. It falls by at least one per unit where the law does not soften:
/// then the root lies between start and start + miss(start).
template <typename Miss>
double root_near(const Miss& miss, double start) {
  double before = start, value_before = miss(before);
  double f = before + value_before, value = miss(f);
  for (int i = 0; i < kGrows && value * value_before > 0; ++i) {
    const double width = 2 * (f - before);
    before = std::exchange(f, f + width);
    value_before = std::exchange(value, miss(f));
  }
  const double small = kRootPart * std::max({std::abs(f), std::abs(before), kLeastForce_n});
  for (int i = 0; i < kIllinois && std::abs(value) > small && std::abs(f - before) > small; ++i) {
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

}  // namespace

VectorXd upsampled(const VectorXd& signal, int ratio, double shift) {
  if (ratio == 1 && shift == 0) return signal;
  const Index size = signal.size();
  VectorXd out = VectorXd::Zero(size * ratio);
  for (int phase = 0; phase < ratio; ++phase) {
    const double at = static_cast<double>(phase) / ratio - shift;
    const auto whole = static_cast<Index>(std::floor(at));
    std::vector<double> taps;
    double sum = 0;
    for (int k = -kSincHalf + 1; k <= kSincHalf; ++k) {
      const double x = k - (at - static_cast<double>(whole));
      const double sinc = std::abs(x) < 1e-12 ? 1.0 : std::sin(M_PI * x) / (M_PI * x);
      const double taper_at = x / (kSincHalf + 0.5);
      const double taper =
          0.42 + 0.5 * std::cos(M_PI * taper_at) + 0.08 * std::cos(2 * M_PI * taper_at);
      taps.push_back(sinc * taper);
      sum += taps.back();
    }
    for (double& tap : taps) tap /= sum;
    for (Index i = 0; i < size; ++i) {
      double value = 0;
      for (int k = -kSincHalf + 1; k <= kSincHalf; ++k) {
        const Index from = std::clamp<Index>(i + whole + k, 0, size - 1);
        value += taps[static_cast<std::size_t>(k + kSincHalf - 1)] * signal[from];
      }
      out[i * ratio + phase] = value;
    }
  }
  return out;
}

int steps_per_sample(const Plant& plant, double rate_hz) {
  return std::clamp(static_cast<int>(std::ceil(kStepsPerPeriod * plant.highest_hz / rate_hz)), 2,
                    12);
}

FreeRun free_run(const Plant& plant, const Model& model, const Stretch& stretch, std::size_t record,
                 int ratio) {
  FreeRun out;
  std::vector<Index> base;
  for (Index a = 0; a < plant.axis_count(); ++a)
    if (plant.ground.col(a).cwiseAbs().maxCoeff() > 0 || plant.is_force(a)) base.push_back(a);
  const System parts = assemble_system(plant, model, base);
  const double step = 1 / (stretch.rate_hz * ratio);
  ModalSystem system(parts.mass, parts.damping, parts.stiffness, parts.inputs, step);
  if (!system.good()) return out;

  const Index steps = stretch.intervals() * ratio, lead = stretch.lead.rows() * ratio;
  MatrixXd ground(static_cast<Index>(base.size()), lead + steps);
  for (std::size_t i = 0; i < base.size(); ++i) {
    VectorXd signal(stretch.lead.rows() + stretch.intervals());
    signal.head(stretch.lead.rows()) = stretch.lead.col(base[i]);
    signal.tail(stretch.intervals()) = stretch.accel.col(base[i]).head(stretch.intervals());
    signal /= 1 + model.gain[base[i]];
    const double late = model.clock_s[base[i]] * stretch.rate_hz;
    ground.row(static_cast<Index>(i)) = upsampled(signal, ratio, -late).transpose();
  }

  struct Active {
    LawMotion motion;
    ModalSystem::Observer seen;
    Index input;
    double force = 0;
  };
  struct Step {
    double d, v;
  };
  std::vector<Active> laws;
  std::vector<std::pair<const ModelEffect*, Index>> harmonics;
  auto input = static_cast<Index>(base.size());
  for (const ModelEffect& e : model.effects) {
    if (e.element_law()) {
      VectorXd row = VectorXd::Zero(parts.mass.rows());
      row.head(plant.equations()) = plant.building.act.col(element_of(plant, e.place));
      laws.push_back({LawMotion(e.law(record)), system.observe(row), input++});
      out.tracks.push_back({VectorXd(steps), VectorXd(steps), VectorXd(steps)});
    } else if (e.form == LawForm::harmonic) {
      harmonics.emplace_back(&e, input++);
    }
  }

  VectorXd now = VectorXd::Zero(parts.inputs.cols());
  VectorXd corrected = now;
  std::vector<Step> at_step(laws.size());
  for (Index i = -lead; i < steps; ++i) {
    const double t = step * static_cast<double>(i);
    now.head(ground.rows()) = ground.col(lead + i);
    for (const auto& [e, at] : harmonics) {
      const double phase = 2 * M_PI * e->knobs[0].plain() * t;
      const std::vector<Knob>& r = e->record_knobs[record];
      now[at] =
          t < e->onset_s[record] ? 0 : r[0].value * std::cos(phase) + r[1].value * std::sin(phase);
    }
    system.predict(now);
    corrected.setZero();
    for (int sweep = 0; sweep < (laws.size() > 1 ? kSweeps : 1); ++sweep) {
      for (std::size_t l = 0; l < laws.size(); ++l) {
        Active& law = laws[l];
        double d = system.displacement(law.seen), v = system.velocity(law.seen);
        for (std::size_t other = 0; other < laws.size(); ++other) {
          if (other == l) continue;
          d += law.seen.displacement_gain[laws[other].input] * laws[other].force;
          v += law.seen.velocity_gain[laws[other].input] * laws[other].force;
        }
        const double gd = law.seen.displacement_gain[law.input];
        const double gv = law.seen.velocity_gain[law.input];
        // f = F(d + gd f, v + gv f): gd, gv < 0, F rises, so the root is bracketed.
        const auto miss = [&](double f) { return law.motion.force(d + gd * f, v + gv * f, t) - f; };
        law.force = root_near(miss, law.force);
        corrected[law.input] = law.force;
        if (sweep + 1 == (laws.size() > 1 ? kSweeps : 1)) {
          at_step[l] = {d + gd * law.force, v + gv * law.force};
        }
      }
    }
    system.correct(corrected);
    for (std::size_t l = 0; l < laws.size(); ++l) {
      laws[l].motion.accept(at_step[l].d, at_step[l].v, t);
      if (!(std::abs(at_step[l].d) < kRunAway_m)) return out;
      if (i < 0) continue;
      out.tracks[l].d[i] = at_step[l].d;
      out.tracks[l].v[i] = at_step[l].v;
      out.tracks[l].force[i] = laws[l].force;
    }
  }
  out.good = true;
  return out;
}

}  // namespace framewatch
