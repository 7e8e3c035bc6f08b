// SPDX-License-Identifier: MIT
#include "daemon/tools/report/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/core.h>

#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/numeric/nan.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;
constexpr double kSegment_s = 20, kShortest_s = 4, kLowest_hz = 0.3;
// Least power of a peak, as a share of the largest's: kFundamental for the model's lowest mode,
// kMinor for a measured one. kNear: largest ratio of their frequencies. kAlike: least MAC of a
// pair.
constexpr double kFundamental = 0.1, kMinor = 0.02, kNear = 1.6, kAlike = 0.8;
constexpr Index kMaxUnknowns = 100;

/// Returns the mean of the axes that `wanted` picks; empty without one.
template <typename Wanted>
Eigen::VectorXd mean_of(const SessionMotion& m, Index from, Index to, Wanted wanted) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(to - from);
  double count = 0;
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    if (!m.axes[a].horizontal() || !wanted(m.axes[a])) continue;
    sum += m.accel.col(static_cast<Index>(a)).segment(from, to - from);
    ++count;
  }
  if (count > 0) sum /= count;
  return count > 0 ? sum : Eigen::VectorXd();
}

/// Computes the model's response to a unit acceleration of the base along x and along y, at one
/// frequency per call.
class ModelResponse {
 public:
  ModelResponse(const estimator::Structure& s, const Eigen::VectorXd& theta,
                estimator::Direction direction) {
    const estimator::Matrices full = assemble(s, estimator::ParameterTable(s), theta);
    const Eigen::MatrixXd t = floor_constraint(s);
    stiffness_ = t.transpose() * full.stiffness * t;
    damping_ = t.transpose() * full.damping * t;
    mass_ = t.transpose() * full.mass.asDiagonal() * t;
    Eigen::VectorXd output = Eigen::VectorXd::Zero(s.degrees_of_freedom());
    Eigen::MatrixXd base = Eigen::MatrixXd::Zero(s.degrees_of_freedom(), 2);
    double count = 0;
    for (int f = 0; f < s.frames(); ++f) {
      const bool along = s.direction(f) == direction;
      if (along) output[s.dof(s.stories, f)] = ++count;
      for (int story = 1; story <= s.stories; ++story)
        base(s.dof(story, f), s.direction(f) == estimator::Direction::x ? 0 : 1) = 1;
    }
    for (Index i = 0; i < output.size(); ++i) output[i] = output[i] > 0 ? 1 / count : 0;
    direct_ = (output.transpose() * base).transpose();
    load_ = t.transpose() * full.mass.asDiagonal() * base;
    output_ = output;
    floors_ = t;
  }

  /// Returns the acceleration of all degrees of freedom relative to the base, for base x and y.
  Eigen::MatrixXcd floors(double w) const {
    const Eigen::MatrixXcd dynamic = stiffness_.cast<Complex>() - w * w * mass_.cast<Complex>() +
                                     Complex(0, w) * damping_.cast<Complex>();
    const estimator::ComplexLu solver(dynamic);
    Eigen::MatrixXcd z(load_.rows(), 2);
    for (Index b = 0; b < 2; ++b)
      z.col(b) = solver.solve(Eigen::VectorXcd(load_.col(b).cast<Complex>()));
    return w * w * (floors_.cast<Complex>() * z);
  }
  /// Returns the absolute mean acceleration of the top floor, from the result of floors().
  Eigen::Vector2cd top(const Eigen::MatrixXcd& floors) const {
    return direct_.cast<Complex>() + (output_.transpose().cast<Complex>() * floors).transpose();
  }

 private:
  Eigen::MatrixXd stiffness_, damping_, mass_, load_, floors_;
  Eigen::VectorXd output_;
  Eigen::Vector2d direct_;
};

/// Returns the frequency of the parabola's peak through three bins, the largest in the middle.
double between_bins(double f, double step_hz, double below, double at, double higher) {
  const double curvature = below - 2 * at + higher;
  return f + (curvature < 0 ? 0.5 * (below - higher) / curvature : 0) * step_hz;
}

struct Signals {
  Eigen::VectorXd top, base_x, base_y;
  /// Relative to the base, samples x degrees of freedom; no columns if a sensor is missing.
  Eigen::MatrixXd floors;
  estimator::Direction direction;
  const Eigen::VectorXd& base() const {
    return direction == estimator::Direction::x ? base_x : base_y;
  }
};

/// Cross and own spectra of one direction, summed over segments.
struct Spectra {
  Eigen::VectorXcd cross, cross_model;
  Eigen::MatrixXcd floors, floors_model;  ///< bins x degrees of freedom
  Eigen::VectorXd base, top;
  int segments = 0;
};

Eigen::VectorXcd tapered(const Eigen::VectorXd& signal, Index from, const Eigen::VectorXd& taper) {
  Eigen::VectorXd part = signal.segment(from, taper.size());
  part.array() -= part.mean();
  return estimator::forward_fourier(part.cwiseProduct(taper));
}

/// The model's response to the base along x and along y: the top floor's mean, bins x 2, and all
/// degrees of freedom, bins x degrees of freedom. Has no rows without a model.
struct ModelSpectra {
  Eigen::MatrixXcd top, floors[2];
};

ModelSpectra model_spectra(const estimator::Structure& structure, const Eigen::VectorXd& theta,
                           estimator::Direction direction, Index bins, double step_hz,
                           double highest_hz) {
  const ModelResponse response(structure, theta, direction);
  ModelSpectra out{Eigen::MatrixXcd::Zero(bins, 2), {}};
  for (Eigen::MatrixXcd& floors : out.floors)
    floors = Eigen::MatrixXcd::Zero(bins, structure.degrees_of_freedom());
  for (Index k = 1; k < bins && static_cast<double>(k) * step_hz <= highest_hz; ++k) {
    const Eigen::MatrixXcd floors =
        response.floors(2 * std::numbers::pi * step_hz * static_cast<double>(k));
    out.top.row(k) = response.top(floors).transpose();
    for (Index b = 0; b < 2; ++b) out.floors[b].row(k) = floors.col(b).transpose();
  }
  return out;
}

Spectra spectra(const Signals& s, const Eigen::VectorXd& taper, const ModelSpectra& model) {
  const Index size = taper.size(), bins = size / 2 + 1;
  Spectra out{Eigen::VectorXcd::Zero(bins),
              Eigen::VectorXcd::Zero(bins),
              Eigen::MatrixXcd::Zero(bins, s.floors.cols()),
              Eigen::MatrixXcd::Zero(bins, model.floors[0].cols()),
              Eigen::VectorXd::Zero(bins),
              Eigen::VectorXd::Zero(bins)};
  for (Index from = 0; from + size <= s.top.size(); from += size / 2) {
    const auto whole = [&](const Eigen::VectorXd& v) {
      return v.size() == 0 || v.segment(from, size).allFinite();
    };
    if (!whole(s.top) || !whole(s.base_x) || !whole(s.base_y)) continue;
    if (!s.floors.middleRows(from, size).allFinite()) continue;
    const Eigen::VectorXcd x = tapered(s.base(), from, taper), y = tapered(s.top, from, taper);
    out.cross += y.cwiseProduct(x.conjugate());
    for (Index d = 0; d < s.floors.cols(); ++d)
      out.floors.col(d) += tapered(s.floors.col(d), from, taper).cwiseProduct(x.conjugate());
    out.base += x.cwiseAbs2();
    out.top += y.cwiseAbs2();
    const Eigen::VectorXd* bases[2] = {&s.base_x, &s.base_y};
    for (Index b = 0; model.top.rows() > 0 && b < 2; ++b) {
      if (bases[b]->size() == 0) continue;
      const Eigen::VectorXcd push = tapered(*bases[b], from, taper).cwiseProduct(x.conjugate());
      out.cross_model += model.top.col(b).cwiseProduct(push);
      out.floors_model += push.asDiagonal() * model.floors[b];
    }
    ++out.segments;
  }
  return out;
}

/// A peak of the motion along one direction, with its shape.
struct ShapePeak {
  double hz, power;
  Eigen::VectorXcd shape;
};

/// Returns the peaks between low_hz and high_hz with at least `share` of the largest one's power,
/// in ascending order. floors: cross spectra of the degrees of freedom with the base, whose
/// spectrum is `base`.
std::vector<ShapePeak> shape_peaks(const Eigen::MatrixXcd& floors, const Eigen::VectorXd& base,
                                   const Eigen::VectorXd& mass, double step_hz, double low_hz,
                                   double high_hz, double share) {
  std::vector<ShapePeak> out;
  const Index low = std::max<Index>(1, static_cast<Index>(std::ceil(low_hz / step_hz)));
  const Index high = std::min<Index>(base.size() - 2, static_cast<Index>(high_hz / step_hz));
  const auto power = [&](Index k) {
    return floors.row(k).transpose().cwiseAbs2().dot(mass) / (base[k] * base[k]);
  };
  double most = 0;
  for (Index k = low; k <= high; ++k) {
    const double below = power(k - 1), at = power(k), above = power(k + 1);
    if (at < below || at < above) continue;
    most = std::max(most, at);
    out.push_back({between_bins(static_cast<double>(k) * step_hz, step_hz, std::sqrt(below),
                                std::sqrt(at), std::sqrt(above)),
                   at, floors.row(k).transpose() / base[k]});
  }
  std::erase_if(out, [&](const ShapePeak& peak) { return peak.power < share * most; });
  return out;
}

/// Returns the modal assurance criterion of two shapes, weighted by mass.
double mac_of(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b, const Eigen::VectorXd& mass) {
  const Complex common = a.dot(Eigen::VectorXcd(b.cwiseProduct(mass.cast<Complex>())));
  return std::norm(common) / (a.cwiseAbs2().dot(mass) * b.cwiseAbs2().dot(mass));
}

/// Pairs the model's lowest peak with the measured peak of the most similar shape.
void pair_modes(const estimator::Structure& structure, const Spectra& s, double step_hz,
                double highest_hz, TransferFunction& out) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(structure.degrees_of_freedom());
  for (int story = 1; story <= structure.stories; ++story)
    for (int f = 0; f < structure.frames(); ++f)
      if (structure.direction(f) == out.direction)
        mass[structure.dof(story, f)] = structure.frame_mass(story, f);
  const auto model =
      shape_peaks(s.floors_model, s.base, mass, step_hz, kLowest_hz, highest_hz, kFundamental);
  if (s.floors.cols() == 0) out.no_pair = "not every frame has a channel on every floor";
  if (model.empty())
    out.no_pair = fmt::format("the design has no resonance along {} between {:g} and {:.3g} Hz",
                              letter(out.direction), kLowest_hz, highest_hz);
  if (!out.no_pair.empty()) return;
  const ShapePeak& wanted = model.front();
  out.model_mode_hz = wanted.hz;
  for (const ShapePeak& peak :
       shape_peaks(s.floors, s.base, mass, step_hz, wanted.hz / kNear, wanted.hz * kNear, kMinor)) {
    const double mac = mac_of(peak.shape, wanted.shape, mass);
    if (mac < kAlike || (std::isfinite(out.mac) && mac <= out.mac)) continue;
    out.mac = mac;
    out.measured_mode_hz = peak.hz;
  }
  if (!std::isfinite(out.mac))
    out.no_pair = fmt::format(
        "no measured peak between {:.3g} and {:.3g} Hz has the shape of the design's lowest mode "
        "along {}",
        wanted.hz / kNear, wanted.hz * kNear, letter(out.direction));
}

TransferFunction quotient(const Signals& s, const estimator::Structure& structure, double rate_hz,
                          Index size, const Eigen::VectorXd& theta) {
  constexpr double none = estimator::kNaN;
  TransferFunction out{s.direction, 0, {}, {}, {}, {}, none, none, none};
  const Index bins = size / 2 + 1;
  const double step_hz = rate_hz / static_cast<double>(size), highest_hz = 0.4 * rate_hz;
  ModelSpectra model;
  if (theta.size() > 0 && structure.degrees_of_freedom() <= kMaxUnknowns)
    model = model_spectra(structure, theta, s.direction, bins, step_hz, highest_hz);
  const bool has_model = model.top.rows() > 0;
  Eigen::VectorXd taper(size);
  for (Index i = 0; i < size; ++i)
    taper[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                    static_cast<double>(size));
  const Spectra spectrum = spectra(s, taper, model);
  out.segments = spectrum.segments;
  if (out.segments == 0) return out;
  for (Index k = 0; k < bins; ++k) {
    const double f = static_cast<double>(k) * step_hz;
    if (f < kLowest_hz || f > highest_hz || !(spectrum.base[k] > 0)) continue;
    out.frequency_hz.push_back(f);
    out.measured.push_back(std::abs(spectrum.cross[k]) / spectrum.base[k]);
    out.coherence.push_back(std::norm(spectrum.cross[k]) / (spectrum.base[k] * spectrum.top[k]));
    if (has_model) out.model.push_back(std::abs(spectrum.cross_model[k]) / spectrum.base[k]);
  }
  if (has_model)
    pair_modes(structure, spectrum, step_hz, highest_hz, out);
  else if (theta.size() > 0)
    out.no_pair = fmt::format("the building has more than {} degrees of freedom", kMaxUnknowns);
  return out;
}

Eigen::MatrixXd floors_of(const estimator::Structure& s, const SessionMotion& m, Index from,
                          Index to, const Eigen::VectorXd& base_x, const Eigen::VectorXd& base_y) {
  if (s.degrees_of_freedom() > kMaxUnknowns) return Eigen::MatrixXd(to - from, 0);
  Eigen::MatrixXd out(to - from, s.degrees_of_freedom());
  int found = 0;
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    if (m.axes[a].story == 0 || m.axes[a].frame < 0 || m.axes[a].is_force) continue;
    const Eigen::VectorXd& base =
        s.direction(m.axes[a].frame) == estimator::Direction::x ? base_x : base_y;
    auto column = out.col(s.dof(m.axes[a].story, m.axes[a].frame));
    column = m.accel.col(static_cast<Index>(a)).segment(from, to - from);
    if (base.size() > 0) column -= base;
    ++found;
  }
  return found == out.cols() ? out : Eigen::MatrixXd(to - from, 0);
}

}  // namespace

double TransferFunction::stiffness_ratio() const {
  return std::pow(measured_mode_hz / model_mode_hz, 2);
}

std::vector<TransferFunction> transfer_functions(const estimator::Structure& structure,
                                                 const SessionMotion& motion, Index from, Index to,
                                                 const Eigen::VectorXd& theta) {
  const auto rows = static_cast<double>(to - from);
  const Index size =
      estimator::smooth_size(static_cast<Index>(std::min(kSegment_s * motion.rate_hz, rows / 2)));
  std::vector<TransferFunction> out;
  if (static_cast<double>(size) < kShortest_s * motion.rate_hz - 1) return out;
  const auto base = [&](estimator::Direction d) {
    return mean_of(motion, from, to, [&](const estimator::SensorAxis& a) {
      return a.horizontal() && a.story == 0 && a.direction == d;
    });
  };
  const Eigen::VectorXd base_x = base(estimator::Direction::x),
                        base_y = base(estimator::Direction::y);
  for (const estimator::Direction d : {estimator::Direction::x, estimator::Direction::y}) {
    Signals s{mean_of(motion, from, to,
                      [&](const estimator::SensorAxis& a) {
                        return a.horizontal() && a.story == structure.stories && a.direction == d;
                      }),
              base_x, base_y, floors_of(structure, motion, from, to, base_x, base_y), d};
    if (s.top.size() == 0 || s.base().size() == 0) continue;
    TransferFunction one = quotient(s, structure, motion.rate_hz, size, theta);
    if (one.segments > 0) out.push_back(std::move(one));
  }
  return out;
}

}  // namespace framewatch::daemon
