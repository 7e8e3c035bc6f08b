#include "daemon/report/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/numeric/nan.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;
constexpr double kSegment_s = 20, kShortest_s = 4, kLowest_hz = 0.3;
constexpr double kFundamental = 0.3;  // of the highest peak: what the lowest mode has at least
constexpr Index kMostUnknowns = 100;

/// Mean of the axes that `wanted` picks.
template <typename Wanted>
Eigen::VectorXd mean_of(const SessionMotion& m, Index from, Index to, Wanted wanted) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(to - from);
  double count = 0;
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    if (!wanted(m.axes[a])) continue;
    sum += m.accel.col(static_cast<Index>(a)).segment(from, to - from);
    ++count;
  }
  if (count > 0) sum /= count;
  return count > 0 ? sum : Eigen::VectorXd();
}

/// The model's response, absolute acceleration at the top floor, to a unit acceleration of the base
/// along x and along y, at one frequency after the other.
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
    output_ = t.transpose() * output;
    load_ = t.transpose() * full.mass.asDiagonal() * base;
  }

  Eigen::Vector2cd at(double w) const {
    const Eigen::MatrixXcd dynamic = stiffness_.cast<Complex>() - w * w * mass_.cast<Complex>() +
                                     Complex(0, w) * damping_.cast<Complex>();
    const Eigen::VectorXcd z =
        estimator::ComplexLu(dynamic).solve(Eigen::VectorXcd(output_.cast<Complex>()));
    return direct_.cast<Complex>() + w * w * (load_.transpose().cast<Complex>() * z);
  }

 private:
  Eigen::MatrixXd stiffness_, damping_, mass_, load_;
  Eigen::VectorXd output_;
  Eigen::Vector2d direct_;
};

/// Frequency of the lowest peak that reaches `share` of the highest one, between the bins by a
/// parabola.
double peak_hz(const std::vector<double>& f, const std::vector<double>& h, double low_hz,
               double high_hz, double share) {
  const auto is_peak = [&](std::size_t i) {
    return f[i] >= low_hz && f[i] <= high_hz && h[i] >= h[i - 1] && h[i] >= h[i + 1];
  };
  double highest = 0;
  for (std::size_t i = 1; i + 1 < h.size(); ++i)
    if (is_peak(i)) highest = std::max(highest, h[i]);
  std::size_t best = 0;
  for (std::size_t i = 1; i + 1 < h.size() && best == 0; ++i)
    if (is_peak(i) && h[i] >= share * highest) best = i;
  if (best == 0) return estimator::kNaN;
  const double below = h[best - 1], at = h[best], above = h[best + 1];
  const double curvature = below - 2 * at + above;
  return f[best] + (curvature < 0 ? 0.5 * (below - above) / curvature : 0) * (f[1] - f[0]);
}

struct Signals {
  Eigen::VectorXd top, base_x, base_y;
  estimator::Direction direction;
  const Eigen::VectorXd& base() const {
    return direction == estimator::Direction::x ? base_x : base_y;
  }
};

/// Cross and own spectra of one direction, summed over segments.
struct Spectra {
  Eigen::VectorXcd cross, cross_model;
  Eigen::VectorXd base, top;
  int segments = 0;
};

Eigen::VectorXcd tapered(const Eigen::VectorXd& signal, Index from, const Eigen::VectorXd& taper) {
  Eigen::VectorXd part = signal.segment(from, taper.size());
  part.array() -= part.mean();
  return estimator::forward_fourier(part.cwiseProduct(taper));
}

Spectra spectra(const Signals& s, const Eigen::VectorXd& taper, const Eigen::MatrixXcd& model) {
  const Index size = taper.size(), bins = size / 2 + 1;
  Spectra out{Eigen::VectorXcd::Zero(bins), Eigen::VectorXcd::Zero(bins),
              Eigen::VectorXd::Zero(bins), Eigen::VectorXd::Zero(bins)};
  for (Index from = 0; from + size <= s.top.size(); from += size / 2) {
    const auto whole = [&](const Eigen::VectorXd& v) {
      return v.size() == 0 || v.segment(from, size).allFinite();
    };
    if (!whole(s.top) || !whole(s.base_x) || !whole(s.base_y)) continue;
    const Eigen::VectorXcd x = tapered(s.base(), from, taper), y = tapered(s.top, from, taper);
    out.cross += y.cwiseProduct(x.conjugate());
    out.base += x.cwiseAbs2();
    out.top += y.cwiseAbs2();
    if (model.rows() > 0) {
      Eigen::VectorXcd simulated = Eigen::VectorXcd::Zero(bins);
      if (s.base_x.size() > 0)
        simulated += model.col(0).cwiseProduct(tapered(s.base_x, from, taper));
      if (s.base_y.size() > 0)
        simulated += model.col(1).cwiseProduct(tapered(s.base_y, from, taper));
      out.cross_model += simulated.cwiseProduct(x.conjugate());
    }
    ++out.segments;
  }
  return out;
}

TransferFunction quotient(const Signals& s, const estimator::Structure& structure, double rate_hz,
                          Index size, const Eigen::VectorXd& theta) {
  TransferFunction out{s.direction, 0, {}, {}, {}, {}, estimator::kNaN, estimator::kNaN};
  const Index bins = size / 2 + 1;
  const double step_hz = rate_hz / static_cast<double>(size), highest_hz = 0.4 * rate_hz;
  Eigen::MatrixXcd model;
  if (theta.size() > 0 && structure.degrees_of_freedom() <= kMostUnknowns) {
    const ModelResponse response(structure, theta, s.direction);
    model = Eigen::MatrixXcd::Zero(bins, 2);
    for (Index k = 1; k < bins && static_cast<double>(k) * step_hz <= highest_hz; ++k)
      model.row(k) =
          response.at(2 * std::numbers::pi * step_hz * static_cast<double>(k)).transpose();
  }
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
    if (model.rows() > 0) out.model.push_back(std::abs(spectrum.cross_model[k]) / spectrum.base[k]);
  }
  if (!out.model.empty())
    out.model_peak_hz = peak_hz(out.frequency_hz, out.model, kLowest_hz, highest_hz, kFundamental);
  const bool guided = std::isfinite(out.model_peak_hz);
  out.measured_peak_hz =
      peak_hz(out.frequency_hz, out.measured, guided ? 0.7 * out.model_peak_hz : kLowest_hz,
              guided ? 1.4 * out.model_peak_hz : highest_hz, guided ? 1 : kFundamental);
  return out;
}

}  // namespace

double TransferFunction::stiffness_ratio() const {
  return std::pow(measured_peak_hz / model_peak_hz, 2);
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
      return a.story == 0 && a.direction == d;
    });
  };
  const Eigen::VectorXd base_x = base(estimator::Direction::x),
                        base_y = base(estimator::Direction::y);
  for (const estimator::Direction d : {estimator::Direction::x, estimator::Direction::y}) {
    Signals s{mean_of(motion, from, to,
                      [&](const estimator::SensorAxis& a) {
                        return a.story == structure.stories && a.direction == d;
                      }),
              base_x, base_y, d};
    if (s.top.size() == 0 || s.base().size() == 0) continue;
    TransferFunction one = quotient(s, structure, motion.rate_hz, size, theta);
    if (one.segments > 0) out.push_back(std::move(one));
  }
  return out;
}

}  // namespace framewatch::daemon
