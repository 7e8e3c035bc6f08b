// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/diagnosis_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/model/make_plant.h"
#include "estimator/diagnose/model/run_system.h"
#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/identify/elements/guessed_design.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/quantile.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kBandLow = 0.4, kBandHigh = 1.6;  ///< of the lowest and highest natural frequency
constexpr double kBandOfRead = 2;                  ///< of the highest frequency that axes read
constexpr double kComponentBandLow = 0.1;  ///< displacement is accurate at far lower frequencies
constexpr double kForceTail = 5e-4;  ///< of a measured force's power, below its band and above
constexpr double kHighest = 0.4;     ///< of the sampling rate
/// Bins times equations^1.5, about the work of a fit. The band of a large building ends at this
/// work, but includes the lowest modes.
constexpr double kMaxWork = 4e5;
constexpr double kLowestModes = 5;  ///< times the lowest natural frequency
constexpr int kDesignFits = 2;      ///< of a building without a design
constexpr double kMinOfGuess = 0.01;
constexpr double kMinSignal = 5;  ///< rms of a floor's motion in the band over its noise
constexpr double kSlowLow = 0.1, kSlowHigh = 0.5;  ///< of the lowest natural frequency
constexpr double kApart = 0.25;                    ///< of the lowest natural period
constexpr double kAlike = 0.95,
                 kLessAlike = 0.8;  ///< correlation; undelayed correlation relative to it

/// Returns the natural frequencies of the design, including the bending of its frames.
std::vector<double> design_frequencies(const Structure& structure, const Plant& plant,
                                       const VectorXd& design) {
  if (!plant.bending.any())
    return natural_frequencies_hz(structure, ParameterTable(structure), design);
  const RunSystem system = run_system(plant, initial_model(plant), {});
  const VectorXd squares = generalized_eigenvalues(system.stiffness, system.mass);
  std::vector<double> out;
  for (const double w2 : squares) out.push_back(std::sqrt(std::max(w2, 0.0)) / (2 * M_PI));
  return out;
}

/// Returns twice the highest frequency, Hz, of motions that axes read, with the other read motions
/// at rest and the unread ones following statically. Above it the readings say little about the
/// motion between them.
double highest_read_hz(const Plant& plant) {
  const RunSystem system = run_system(plant, initial_model(plant), {});
  const Eigen::MatrixXd own = plant.unread.transpose() * system.stiffness * plant.unread;
  const Eigen::MatrixXd coupled = plant.unread.transpose() * system.stiffness * plant.read;
  const Eigen::MatrixXd shapes = plant.read - plant.unread * solve_lu(own, coupled);
  const VectorXd stiffness = (shapes.transpose() * system.stiffness * shapes).diagonal();
  const VectorXd mass = (shapes.transpose() * system.mass * shapes).diagonal();
  return kBandOfRead * std::sqrt(stiffness.cwiseQuotient(mass).maxCoeff()) / (2 * M_PI);
}

/// Returns the band that contains nearly all of the force of a prescribed motion. Nothing else
/// limits the band: a component may have any mass, or none.
Band band_of_force(const VectorXd& force, double rate_hz) {
  const Index size = smooth_size(force.size());
  VectorXd periodic = force.head(size).array() - force.head(size).mean();
  periodic[0] = 0.5 * (periodic[0] + periodic[size - 1]);
  const VectorXd power = forward_fourier(periodic).cwiseAbs2();
  const double step_hz = rate_hz / static_cast<double>(size), total = power.sum();
  Index low = 0, high = power.size() - 1;
  for (double below = power[0]; below < kForceTail * total && low < high; below += power[low])
    ++low;
  for (double above = power[high]; above < kForceTail * total && high > low; above += power[high])
    --high;
  low = std::max<Index>(low, 1);
  high = std::max(high, low + kFewestBins);
  return {step_hz * static_cast<double>(low),
          std::min(kHighest * rate_hz, step_hz * static_cast<double>(high))};
}

/// Returns the records in the band of the design's natural frequencies.
std::vector<RecordSegment> segments_of(const Structure& structure, const Plant& plant,
                                       const VectorXd& design, const ComponentTest& component,
                                       const std::vector<RecordSamples>& records) {
  const std::vector<double> hz = design_frequencies(structure, plant, design);
  const std::vector<char> displaced = displaced_axes(plant, component);
  std::vector<RecordSegment> out;
  for (const RecordSamples& record : records) {
    VectorXd noise = VectorXd::Zero(plant.axis_count());
    for (Index i = 0; i < plant.axis_count(); ++i)
      noise[i] =
          plant.axes[static_cast<std::size_t>(i)].noise_density * std::sqrt(record.rate_hz / 2);
    const double low = (component.any() ? kComponentBandLow : kBandLow) * hz.front();
    const double bins = kMaxWork / std::pow(static_cast<double>(plant.equations()), 1.5);
    const double seconds = static_cast<double>(record.accel.rows() - record.lead) / record.rate_hz;
    const double most = std::max(low + bins / seconds, kLowestModes * hz.front());
    const double high = plant.unread.cols() > 0 ? highest_read_hz(plant) : kBandHigh * hz.back();
    Band band{low, std::min({kHighest * record.rate_hz, high, most})};
    if (plant.prescribed && record.accel.rows() > kFewestBins)
      band = band_of_force(record.accel.col(record.accel.cols() - 1), record.rate_hz);
    out.push_back(make_segment(record.accel, record.rate_hz, noise, band, displaced, record.lead));
  }
  return out;
}

/// Returns the upper median, over the axes above the base, of motion in the band over noise.
double signal_ratio(const Plant& plant, const RecordSegment& s) {
  std::vector<double> ratios;
  for (Index a = 0; a < plant.axis_count(); ++a)
    if (plant.axes[static_cast<std::size_t>(a)].story > 0)
      ratios.push_back(std::sqrt(s.spectrum.row(a).squaredNorm() /
                                 (static_cast<double>(s.bins() * s.intervals()) * s.variance[a])));
  std::erase_if(ratios, [](double ratio) { return std::isnan(ratio); });
  return upper_median(ratios, 0);
}

}  // namespace

VectorXd fitted_linear(const Plant& plant, const std::vector<RecordSegment>& segments,
                       const Tolerances& tolerances) {
  const FitResult fit = Fitter(plant, segments, tolerances).fit(initial_model(plant), {}, {});
  return fit.good ? fit.model.theta : VectorXd();
}

std::optional<DiagnosisInput> diagnosis_input(const Structure& structure,
                                              const std::vector<SensorAxis>& axes,
                                              const VectorXd& given, const ComponentTest& component,
                                              const std::vector<RecordSamples>& records,
                                              const BendingStiffness& bending) {
  const ParameterTable table(structure);
  VectorXd design = given.size() > 0 ? given : guessed_design(structure, table);
  const auto input_of = [&]() -> std::optional<DiagnosisInput> {
    const auto plant = make_plant(structure, axes, design, records.front().rate_hz, bending);
    if (!plant) return std::nullopt;
    DiagnosisInput out{component_plant(*plant, component), {}};
    out.segments = segments_of(structure, out.plant, design, component, records);
    return out;
  };
  std::optional<DiagnosisInput> out = input_of();
  if (given.size() > 0 || component.any()) return out;
  for (int i = 0; i < kDesignFits && out; ++i) {
    const VectorXd theta = fitted_linear(out->plant, out->segments, {});
    if (theta.size() == 0) break;
    for (int p = 0; p < table.size(); ++p)
      if (const auto at = out->plant.table.find(table[p].name))
        design[p] = std::max(theta[*at], kMinOfGuess * design[p]);
    out = input_of();
  }
  return out;
}

SegmentFault fault_of(const Plant& plant, const RecordSegment& segment,
                      const ComponentTest& component) {
  if (segment.bins() < kFewestBins) return SegmentFault::too_short;
  if (!component.any() && !(signal_ratio(plant, segment) > kMinSignal))
    return SegmentFault::no_excitation;
  return SegmentFault::none;
}

std::vector<ClockOffset> clocks_apart(const Plant& plant, const RecordSegment& segment) {
  std::vector<ClockOffset> out;
  if (plant.prescribed || segment.bins() == 0) return out;
  const double lowest_hz = segment.w[0] / (2 * M_PI * kBandLow);
  const Band slow{kSlowLow * lowest_hz, kSlowHigh * lowest_hz};
  const auto axis = [&](Index a) { return plant.axes[static_cast<std::size_t>(a)]; };
  for (Index base = 0; base < plant.axis_count(); ++base) {
    if (axis(base).story > 0 || axis(base).frame >= 0 || !axis(base).horizontal()) continue;
    for (Index a = 0; a < plant.axis_count(); ++a) {
      if (axis(a).story == 0 || !axis(a).horizontal() || segment.is_displaced(a) ||
          axis(a).direction != axis(base).direction)
        continue;
      const Delay delay =
          delay_between(segment.accel.col(base), segment.accel.col(a), segment.rate_hz, slow);
      const double seconds = delay.seconds - (axis(a).delay - axis(base).delay);
      if (delay.likeness > kAlike && delay.undelayed < kLessAlike * delay.likeness &&
          std::abs(seconds) * lowest_hz > kApart)
        out.push_back({a, base, seconds});
    }
  }
  return out;
}

}  // namespace framewatch::estimator
