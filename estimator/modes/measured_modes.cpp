// SPDX-License-Identifier: MIT
#include "estimator/modes/measured_modes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "estimator/modes/mode_shapes.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kFewestSignals = 2, kMostSignals = 8;  ///< principal components of the outputs
constexpr Index kInstantsPerSignal = 40;
constexpr Index kMostInputs = 4;      ///< principal components of the inputs
constexpr double kLeastInput = 1e-3;  ///< of the largest component's variance
constexpr Index kMostBlocks = 24, kFewestBlocks = 8;
constexpr Index kFewestInstants = 160;  ///< of a band
constexpr int kTaps = 12;               ///< of the low-pass filter, instants of the band
constexpr Index kOrdersPerSignal = 6;   ///< three modes for each component
constexpr double kRidge = 1e-10;
// A stable pole: relative change of frequency, of damping (or absolute), and MAC to the order
// before.
constexpr double kStableHz = 0.01, kStableDamping = 0.1, kStableRatio = 2e-3, kStableMac = 0.98;
constexpr double kMostDamping = 0.3;
constexpr int kFewestOrders = 5;
constexpr double kMostSpread = 2e-3;              ///< of the frequency over the orders, relative
constexpr double kSameHz = 0.03, kSameMac = 0.9;  ///< of poles of one mode

/// Returns the columns' principal components as a matrix columns x components, the strongest first.
MatrixXd components(const MatrixXd& signals, Index most, double least) {
  if (signals.cols() == 0) return MatrixXd(0, 0);
  const RealEigen eigen = symmetric_eigen(signals.transpose() * signals);
  Index count = 0;
  while (count < std::min(most, signals.cols()) &&
         eigen.values[signals.cols() - 1 - count] > least * eigen.values[signals.cols() - 1])
    ++count;
  return eigen.vectors.rightCols(count).rowwise().reverse();
}

/// Returns the columns behind a low-pass filter at 1/stride of the Nyquist frequency, without
/// delay, without the parts that the filter does not fill.
MatrixXd low_passed(const MatrixXd& signals, Index stride) {
  if (stride == 1) return signals;
  const Index half = kTaps * stride;
  VectorXd taps(2 * half + 1);
  for (Index i = -half; i <= half; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(stride);
    const double hann = 0.5 + 0.5 * std::cos(std::numbers::pi * static_cast<double>(i) /
                                             static_cast<double>(half + 1));
    taps[i + half] = hann * (i == 0 ? 1 : std::sin(std::numbers::pi * t) / (std::numbers::pi * t));
  }
  taps /= taps.sum();
  MatrixXd out(std::max<Index>(0, signals.rows() - 2 * half), signals.cols());
  for (Index c = 0; c < signals.cols(); ++c)
    for (Index i = 0; i < out.rows(); ++i)
      out(i, c) = taps.dot(signals.col(c).segment(i, taps.size()));
  return out;
}

/// A pole of a fitted system above the real axis.
struct FittedPole {
  double hz, ratio;
  VectorXcd shape;  ///< by component
};

/// Systems of every even order that describe one band.
class Band {
 public:
  /// stride: instants between the rows of a Hankel matrix.
  Band(const MatrixXd& outputs, const MatrixXd& inputs, Index stride, double rate_hz)
      : signals_(outputs.cols()), step_s_(static_cast<double>(stride) / rate_hz) {
    const Index instants = outputs.rows() / stride, each = outputs.cols() + inputs.cols();
    blocks_ = std::min(kMostBlocks, instants / (4 * std::max<Index>(each, 1)));
    if (instants < kFewestInstants || blocks_ < kFewestBlocks) return;
    const Index future = blocks_ * inputs.cols(), past = blocks_ * each;
    // Rows: future inputs, past inputs and outputs, future outputs. Neighboring columns would be
    // nearly alike.
    const Index apart = std::max<Index>(1, stride / 4);
    MatrixXd hankel(future + past + blocks_ * signals_,
                    (outputs.rows() - (2 * blocks_ - 1) * stride) / apart);
    Index row = 0;
    const auto add = [&](const MatrixXd& of, Index first_block) {
      for (Index block = 0; block < blocks_; ++block)
        for (Index c = 0; c < of.cols(); ++c)
          hankel.row(row++) = Eigen::Map<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>(
              &of((first_block + block) * stride, c), hankel.cols(), Eigen::InnerStride<>(apart));
    };
    add(inputs, blocks_);
    add(inputs, 0);
    add(outputs, 0);
    add(outputs, blocks_);
    MatrixXd gram = hankel * hankel.transpose();
    const auto without = [&](Index known) {  // the rows after the first ones, less what these tell
      const Index rest = gram.rows() - known;
      MatrixXd own = gram.topLeftCorner(known, known);
      own.diagonal().array() += kRidge * own.diagonal().mean();
      const MatrixXd cross = gram.topRightCorner(known, rest);
      const MatrixXd told = cross.transpose() * Ldlt(own).solve(cross);
      return std::pair{MatrixXd(gram.bottomRightCorner(rest, rest) - told), told};
    };
    if (future > 0) gram = without(future).first;
    const MatrixXd told = without(past).second;  // of the future outputs, by the past
    const RealEigen eigen = symmetric_eigen(0.5 * (told + told.transpose()));
    if (!eigen.good) return;
    states_ = eigen.vectors.rowwise().reverse();
    values_ = eigen.values.reverse().cwiseMax(0).cwiseSqrt();
  }

  Index highest_order() const {
    return states_.size() == 0 ? 0 : std::min(kOrdersPerSignal, blocks_ / 2) * signals_;
  }

  /// Returns the lowest frequency of which the past rows hold a quarter of a period.
  double lowest_hz() const {
    return 0.25 / (static_cast<double>(std::max<Index>(blocks_, 1)) * step_s_);
  }

  std::vector<FittedPole> poles(Index order) const {
    const Index rows = (blocks_ - 1) * signals_;
    const MatrixXd observed = states_.leftCols(order) * values_.head(order).asDiagonal();
    const MatrixXd earlier = observed.topRows(rows), later = observed.bottomRows(rows);
    const ComplexEigen eigen = general_eigen(
        Ldlt(earlier.transpose() * earlier).solve(MatrixXd(earlier.transpose() * later)));
    std::vector<FittedPole> out;
    if (!eigen.good) return out;
    for (Index i = 0; i < order; ++i) {
      const Complex z = eigen.values[i];
      if (!(z.imag() > 0)) continue;
      const Complex lambda = std::log(z) / step_s_;
      out.push_back({std::abs(lambda) / (2 * std::numbers::pi), -lambda.real() / std::abs(lambda),
                     observed.topRows(signals_) * eigen.vectors.col(i)});
    }
    return out;
  }

 private:
  Index signals_, blocks_ = 0;
  double step_s_;
  MatrixXd states_;
  VectorXd values_;
};

double middle(std::vector<double> values, double at) {
  std::sort(values.begin(), values.end());
  const double place = at * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

/// Poles of several orders that are one mode.
struct Cluster {
  std::vector<FittedPole> poles;

  MeasuredMode mode(const MatrixXd& back) const {
    std::vector<double> hz, ratio;
    for (const FittedPole& pole : poles) {
      hz.push_back(pole.hz);
      ratio.push_back(pole.ratio);
    }
    MeasuredMode out;
    out.frequency_hz = middle(hz, 0.5);
    out.damping_ratio = middle(ratio, 0.5);
    out.frequency_spread_hz = (middle(hz, 0.75) - middle(hz, 0.25)) / 2;
    out.damping_spread = (middle(ratio, 0.75) - middle(ratio, 0.25)) / 2;
    out.orders = static_cast<int>(poles.size());
    const auto nearest =
        std::min_element(poles.begin(), poles.end(), [&](const FittedPole& a, const FittedPole& b) {
          return std::abs(a.hz - out.frequency_hz) < std::abs(b.hz - out.frequency_hz);
        });
    out.shape = back * nearest->shape;
    return out;
  }
};

bool same_mode(const MeasuredMode& one, const MeasuredMode& other) {
  return std::abs(one.frequency_hz / other.frequency_hz - 1) < kSameHz &&
         mac(one.shape, other.shape) > kSameMac;
}

/// Returns the clusters of poles between two frequencies that are stable.
std::vector<Cluster> stable_poles(const Band& band, double low_hz, double high_hz) {
  std::vector<Cluster> out;
  std::vector<FittedPole> before;
  for (Index order = 2; order <= band.highest_order(); order += 2) {
    std::vector<FittedPole> now = band.poles(order);
    for (const FittedPole& pole : now) {
      if (pole.hz < low_hz || pole.hz > high_hz || !(pole.ratio > 0) || pole.ratio > kMostDamping)
        continue;
      const bool stable = std::any_of(before.begin(), before.end(), [&](const FittedPole& old) {
        return std::abs(old.hz / pole.hz - 1) < kStableHz &&
               std::abs(old.ratio - pole.ratio) <
                   std::max(kStableRatio, kStableDamping * pole.ratio) &&
               mac(old.shape, pole.shape) > kStableMac;
      });
      if (!stable) continue;
      const auto same = std::find_if(out.begin(), out.end(), [&](const Cluster& cluster) {
        const FittedPole& last = cluster.poles.back();
        return std::abs(last.hz / pole.hz - 1) < kSameHz && mac(last.shape, pole.shape) > kSameMac;
      });
      if (same == out.end())
        out.push_back({{pole}});
      else
        same->poles.push_back(pole);
    }
    before = std::move(now);
  }
  std::erase_if(out, [](const Cluster& cluster) {
    return static_cast<int>(cluster.poles.size()) < kFewestOrders;
  });
  return out;
}

/// Adds a mode, unless its orders agree too little. Of one that several bands have found, the value
/// that the orders of a band agree on best stays.
void keep(MeasuredMode mode, std::vector<MeasuredMode>& modes) {
  const auto disagreement = [](const MeasuredMode& of) {
    return of.frequency_spread_hz / of.frequency_hz;
  };
  if (disagreement(mode) > kMostSpread) return;
  for (const MeasuredMode& other : modes)
    if (same_mode(other, mode) && disagreement(other) <= disagreement(mode)) return;
  std::erase_if(modes, [&](const MeasuredMode& other) { return same_mode(other, mode); });
  modes.push_back(std::move(mode));
}

}  // namespace

RecordedMotion recorded_motion(const Structure& s, const std::vector<SensorAxis>& axes,
                               double rate_hz, const MatrixXd& accel, Index from, Index to) {
  const std::vector<std::size_t> compared = compared_axes(axes);
  RecordedMotion out{rate_hz,
                     MatrixXd(to - from, static_cast<Index>(compared.size())),
                     {},
                     VectorXd(static_cast<Index>(compared.size()))};
  const auto column = [&](std::size_t a) {
    return accel.col(static_cast<Index>(a)).segment(from, to - from);
  };
  MatrixXd base = MatrixXd::Zero(to - from, 2);
  double count[2] = {0, 0};
  std::vector<Index> inputs;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].story > 0 && !axes[a].is_force) continue;
    inputs.push_back(static_cast<Index>(a));
    if (!axes[a].horizontal()) continue;
    const Index along = direction_of(s, axes[a]) == Direction::x ? 0 : 1;
    base.col(along) += column(a);
    ++count[along];
  }
  for (const Index along : {0, 1})
    if (count[along] > 0) base.col(along) /= count[along];
  out.inputs = accel(Eigen::seqN(from, to - from), inputs);
  const MatrixXd carried = channel_weights(s, axes) * ground_influence(s);
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const auto at = static_cast<Index>(i);
    out.outputs.col(at) = column(compared[i]) - base * carried.row(at).transpose();
    out.delay_s[at] = axes[compared[i]].delay;
  }
  return out;
}

std::vector<MeasuredMode> measured_modes(const RecordedMotion& motion) {
  std::vector<MeasuredMode> out;
  const MatrixXd outputs = motion.outputs.rowwise() - motion.outputs.colwise().mean();
  const MatrixXd inputs = motion.inputs.rowwise() - motion.inputs.colwise().mean();
  if (!(motion.rate_hz > 0) || !(outputs.squaredNorm() > 0)) return out;
  for (Index stride = 1;; stride *= 2) {
    const MatrixXd low = low_passed(outputs, stride), drive = low_passed(inputs, stride);
    const Index instants = low.rows() / stride;
    if (instants < kFewestInstants) break;
    const Index signals =
        std::clamp<Index>(instants / kInstantsPerSignal, kFewestSignals, kMostSignals);
    const MatrixXd back = components(low, signals, 0);
    const MatrixXd drives = components(drive, kMostInputs, kLeastInput);
    const auto scaled = [](MatrixXd of) {
      const double rms = std::sqrt(of.squaredNorm() / static_cast<double>(of.rows()));
      if (rms > 0) of /= rms;
      return of;
    };
    const Band band(scaled(low * back), scaled(drive * drives), stride, motion.rate_hz);
    for (const Cluster& cluster :
         stable_poles(band, band.lowest_hz(),
                      kMeasuredBand * motion.rate_hz / static_cast<double>(stride))) {
      MeasuredMode mode = cluster.mode(back);
      const double w = 2 * std::numbers::pi * mode.frequency_hz, h = mode.damping_ratio;
      const Complex lambda = w * Complex(-h, std::sqrt(1 - h * h));
      for (Index i = 0; i < mode.shape.size(); ++i)
        mode.shape[i] *= std::exp(lambda * motion.delay_s[i]);
      Index largest = 0;
      mode.shape.cwiseAbs().maxCoeff(&largest);
      mode.shape /= Complex(mode.shape[largest]);
      keep(std::move(mode), out);
    }
  }
  std::sort(out.begin(), out.end(), [](const MeasuredMode& a, const MeasuredMode& b) {
    return a.frequency_hz < b.frequency_hz;
  });
  return out;
}

}  // namespace framewatch::estimator
