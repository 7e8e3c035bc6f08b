// SPDX-License-Identifier: MIT
#include "estimator/shaking/story_drift.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "estimator/identify/elements/story_design.h"
#include "estimator/identify/groups/group_equations.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Error of an unknown slow part, over its size: its phase decides what it adds to a peak.
constexpr double kUnknownSlow = 0.5;

/// Returns the identified parameters, and those of the design where nothing was identified.
VectorXd completed(const PipelineConfig& c, const ParameterTable& table,
                   const DriftKnowledge& known) {
  const GroupDesign design = story_design(c);
  VectorXd out =
      table.grouped() ? group_parameters(c.structure, table, design) : VectorXd(design.theta);
  for (std::size_t p = 0; p < known.theta.size() && static_cast<Index>(p) < out.size(); ++p)
    if (known.theta[p] > 0) out[static_cast<Index>(p)] = known.theta[p];
  return out;
}

/// Returns the absolute displacement of every frame, at the base, then on every floor, by the
/// displacements of the axes, at frequencies far below the floors' own.
MatrixXd frames_by_axes(const PipelineConfig& c, const ParameterTable& table,
                        const VectorXd& theta) {
  const Structure& s = c.structure;
  const auto axes = static_cast<Index>(c.axes.size());
  if (table.grouped()) {
    const GroupDesign design = story_design(c);
    const ReducedBuilding b = reduced_building(s, c.axes, table, design, identifying(c.axes), true);
    if (b.rows() == 0) return {};
    const VectorXd factor = theta.cwiseQuotient(group_parameters(s, table, design));
    return group_equations(b, factor, c.options.rate_hz).frames * b.from_axes;
  }
  MatrixXd out = MatrixXd::Zero((s.stories + 1) * s.frames(), axes);
  for (int f = 0; f < s.frames(); ++f) {
    for (Index a = 0; a < axes; ++a) {
      const SensorAxis& axis = c.axes[static_cast<std::size_t>(a)];
      if (!axis.horizontal()) continue;
      if (axis.story == 0 && axis.direction == s.direction(f)) out(f, a) = 1;
      if (axis.story > 0 && axis.frame == f) out(axis.story * s.frames() + f, a) = 1;
    }
    if (const double base = out.row(f).sum(); base > 0) out.row(f) /= base;
  }
  return out;
}

/// Returns the standard deviation of every drift due to the sensors' noise, m, Structure::dof.
VectorXd noise_of_drifts(const PipelineConfig& c, const MatrixXd& frames,
                         const std::vector<double>& densities) {
  const Index frames_count = c.structure.frames(), dofs = c.structure.degrees_of_freedom();
  if (frames.rows() != dofs + frames_count) return VectorXd::Constant(dofs, kNaN);
  const MatrixXd drifts = frames.bottomRows(dofs) - frames.topRows(dofs);
  VectorXd variance(frames.cols());
  for (Index a = 0; a < frames.cols(); ++a)
    variance[a] = std::pow(densities[static_cast<std::size_t>(a)], 2) * c.options.rate_hz / 2;
  return (displacement_noise_gain(c.options) * (drifts.cwiseAbs2() * variance)).cwiseSqrt();
}

/// Returns the share of a slow motion of this frequency that the corner removes.
double removed_share(double frequency_hz, double corner_hz) {
  const std::complex<double> s(0, frequency_hz / corner_hz);
  return std::abs((2 * StoryResponse::kDamping * s + 1.0) /
                  (s * s + 2 * StoryResponse::kDamping * s + 1.0));
}

double lowest_hz(const PipelineConfig& c, const ParameterTable& table, const VectorXd& theta) {
  const VectorXd stories =
      table.grouped() ? story_parameters(c.structure, table, story_design(c), theta) : theta;
  return lowest_frequency_hz(c.structure, ParameterTable(c.structure), stories);
}

bool reads_along(const Structure& s, const SensorAxis& a, Direction direction) {
  return a.horizontal() && !a.check && direction_of(s, a) == direction;
}

/// Returns the relative standard error of a story's stiffness by the windows; 0: not known.
double own_error(const ParameterTable& table, const DriftKnowledge& known, int story, int frame) {
  const int p = table.frame_stiffness(story, frame);
  if (p < 0 || static_cast<std::size_t>(p) >= known.std_error.size()) return 0;
  const double error = known.std_error[static_cast<std::size_t>(p)];
  return std::isfinite(error) ? error : 0;
}

/// Returns the relative error of the slow part: that of the stiffness it was computed with.
double stiffness_error(const PipelineConfig& c, const ParameterTable& table,
                       const DriftKnowledge& known, int story, int frame) {
  const double misfit = std::isfinite(known.misfit) ? known.misfit : 0;
  return std::hypot(own_error(table, known, story, frame), std::hypot(c.mass_tolerance, misfit));
}

/// Returns the relative error of a drift that is computed between the measured floors around it.
/// The story's share in the flexibility between them is known to profile_tolerance. Above the
/// highest measured floor the error is that of the whole flexibility, the masses and the stiffness
/// used by EveryFloor.
double share_error(const PipelineConfig& c, const ParameterTable& table,
                   const DriftKnowledge& known, int story, int frame) {
  const Structure& s = c.structure;
  int below = 0, above = s.stories + 1;
  for (const SensorAxis& a : c.axes) {
    if (!reads_along(s, a, s.direction(frame))) continue;
    if (a.story < story) below = std::max(below, a.story);
    if (a.story >= story) above = std::min(above, a.story);
  }
  if (above > s.stories) {
    const double followed = EveryFloor::kFar / std::sqrt(3.0);  // uniform within kFar
    return std::hypot(std::hypot(c.profile_tolerance, c.mass_tolerance),
                      std::hypot(own_error(table, known, story, frame), followed));
  }
  const ParameterTable stories(s);
  const VectorXd theta = story_design(c).theta;
  double sum = 0;
  for (int i = below + 1; i <= above; ++i) sum += 1 / theta[stories.frame_stiffness(i, frame)];
  double squares = 0;
  for (int i = below + 1; i <= above; ++i) {
    const double share = 1 / theta[stories.frame_stiffness(i, frame)] / sum;
    squares += i == story ? (1 - share) * (1 - share) : share * share;
  }
  return c.profile_tolerance * std::sqrt(squares);
}

double unseen_share(const PipelineConfig& c, const PeakResponse& peak, int story) {
  const std::size_t axes = peak.accel_mps2.size();
  double out = 0;
  for (int f = 0; f < c.structure.frames(); ++f) {
    const auto dof = static_cast<std::size_t>(c.structure.dof(story, f));
    for (std::size_t a = 0; a < axes && (dof + 1) * axes <= peak.unseen_mps2.size(); ++a)
      if (c.axes[a].horizontal() && peak.accel_mps2[a] > 0)
        if (const double share = peak.unseen_mps2[dof * axes + a] / peak.accel_mps2[a]; share > out)
          out = share;
  }
  return out;
}

/// Raises a peak, which may be NaN, to a larger value.
void raise_peak(double& peak, double value) {
  if (std::isfinite(value) && !(std::abs(value) <= peak)) peak = std::abs(value);
}

}  // namespace

/// Takes the largest drift one instant ago, between instants by the parabola through three.
void PeakResponse::take_drift(std::size_t dof, double drift, double slow) {
  double* before = &before_m_[3 * dof];
  double peak = before[1];
  const double curvature = before[0] - 2 * before[1] + drift;
  const bool turns = std::isfinite(curvature) && (before[1] - before[0]) * (drift - before[1]) < 0;
  if (turns) peak -= (drift - before[0]) * (drift - before[0]) / (8 * curvature);
  if (std::isfinite(peak) && !(std::abs(peak) <= drift_m[dof])) {
    drift_m[dof] = std::abs(peak);
    slow_m[dof] = std::copysign(1.0, peak) * before[2];
  }
  before[0] = before[1];
  before[1] = drift;
  before[2] = slow;
}

void PeakResponse::note_unseen(std::size_t dof, const std::vector<double>& accel) {
  for (std::size_t a = 0; a < accel.size(); ++a)
    raise_peak(unseen_mps2[dof * accel.size() + a], accel[a]);
}

void PeakResponse::take(const StoryResponse& response) {
  const double decay = std::exp(-1 / (kLately_s * response.rate_hz()));
  for (std::size_t dof = 0; dof < drift_m.size(); ++dof) {
    if (response.interrupted()) note_unseen(dof, lately_mps2);
    if (!std::isfinite(response.drift_m()[dof])) note_unseen(dof, response.accel_mps2());
    take_drift(dof, response.drift_m()[dof], response.slow_m()[dof]);
  }
  for (std::size_t a = 0; a < accel_mps2.size(); ++a) {
    raise_peak(accel_mps2[a], response.accel_mps2()[a]);
    lately_mps2[a] *= decay;
    raise_peak(lately_mps2[a], response.accel_mps2()[a]);
  }
  for (std::size_t d = 0; d < 2; ++d) raise_peak(base_shear_n[d], response.base_shear_n()[d]);
}

PeakDrift peak_drift(const PeakResponse& peak, const Structure& structure, int story) {
  PeakDrift out;
  for (int f = 0; f < structure.frames(); ++f) {
    const double ratio = peak.drift_m[static_cast<std::size_t>(structure.dof(story, f))] /
                         structure.story_height[static_cast<std::size_t>(story - 1)];
    if (std::isfinite(ratio) && !(ratio <= out.ratio)) out = {ratio, f};
  }
  return out;
}

bool drift_is_measured(const PipelineConfig& c, int story) {
  const auto has = [&](int floor, Direction along) {
    return floor == 0 || std::any_of(c.axes.begin(), c.axes.end(), [&](const SensorAxis& a) {
             return a.story == floor && reads_along(c.structure, a, along);
           });
  };
  for (const Direction along : {Direction::x, Direction::y}) {
    if ((along == Direction::x ? c.structure.n() : c.structure.m()) == 0) continue;
    if (!has(story, along) || !has(story - 1, along)) return false;
  }
  return true;
}

double largest_drift_ratio(const PeakResponse& peak, const Structure& structure) {
  double most = 0;
  for (int story = 1; story <= structure.stories; ++story)
    if (const double ratio = peak_drift(peak, structure, story).ratio; ratio > most) most = ratio;
  return most;
}

double peak_accel_mps2(const PeakResponse& peak, const std::vector<SensorAxis>& axes, int level) {
  double most = kNaN;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].story == level && axes[a].horizontal()) raise_peak(most, peak.accel_mps2[a]);
  return most;
}

double displacement_noise_gain(const EstimatorOptions& options) {
  constexpr double kForgotten = 12;  // periods of the mean's corner
  const double corner = options.high_pass_hz;
  const OscillatorSection section(corner, StoryResponse::kDamping, options.rate_hz);
  const double over_w2 = std::pow(2 * std::numbers::pi * corner, -2);
  double x1 = 0, x2 = 0, s1 = 0, s2 = 0, energy = 0;
  // The mean's part is a hundredth of it.
  const auto instants = static_cast<std::int64_t>(kForgotten * options.rate_hz / corner);
  for (std::int64_t i = 0; i < instants; ++i) {
    const double x = i == 0 ? 1 : 0;
    const double s = section.gain * (x + 4 * x1 + x2) / 6 - section.a1 * s1 - section.a2 * s2;
    x2 = x1, x1 = x, s2 = s1, s1 = s;
    energy += s * over_w2 * s * over_w2;
  }
  return energy;
}

std::vector<StoryDrift> story_drifts(const PipelineConfig& c, const PeakResponse& peak,
                                     const DriftKnowledge& known) {
  const Structure& s = c.structure;
  const ParameterTable table = c.parameters();
  const VectorXd theta = completed(c, table, known);
  const VectorXd noise = noise_of_drifts(
      c, frames_by_axes(c, table, theta),
      known.noise_density.size() == c.axes.size() ? known.noise_density : noise_densities(c.axes));
  const bool any_stiffness =
      std::any_of(known.theta.begin(), known.theta.end(), [](double value) { return value > 0; });
  const double removed =
      any_stiffness ? removed_share(lowest_hz(c, table, theta), c.options.high_pass_hz) : kNaN;
  std::vector<StoryDrift> out;
  for (int story = 1; story <= s.stories; ++story) {
    StoryDrift one;
    one.story = story;
    one.measured = drift_is_measured(c, story);
    one.unseen_share = unseen_share(c, peak, story);
    const PeakDrift most = peak_drift(peak, s, story);
    out.push_back(one);
    if (most.frame < 0) continue;
    const double height = s.story_height[static_cast<std::size_t>(story - 1)];
    const auto dof = static_cast<std::size_t>(s.dof(story, most.frame));
    one.frame = most.frame;
    one.ratio = most.ratio;
    one.noise_error = noise[static_cast<Index>(dof)] / height;
    const double slow = dof < peak.slow_m.size() ? peak.slow_m[dof] / height : kNaN;
    one.slow_ratio = slow;
    one.slow_error = std::isfinite(slow)
                         ? stiffness_error(c, table, known, story, most.frame) * std::abs(slow)
                         : kUnknownSlow * removed * one.ratio;
    const double misfit = std::isfinite(known.misfit) ? known.misfit : 0;
    if (!one.measured)
      one.model_error =
          std::hypot(share_error(c, table, known, story, most.frame), misfit) * one.ratio;
    one.std_error = std::hypot(one.noise_error, std::hypot(one.slow_error, one.model_error));
    out.back() = one;
  }
  return out;
}

}  // namespace framewatch::estimator
