// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/measured_deformation.h"

#include <cmath>
#include <complex>
#include <utility>

#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::RowVectorXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

bool is_prescribed(const Plant& plant, const RecordSegment& segment, const RowVectorXd& sense) {
  if (!plant.prescribed) return false;
  for (Index a = 0; a < sense.size(); ++a)
    if (sense[a] != 0 && !segment.is_displaced(a) && !plant.is_input(a)) return false;
  return true;
}

VectorXd frequencies(const RecordSegment& segment, Index bins) {
  const double step = 2 * M_PI * segment.rate_hz / static_cast<double>(segment.intervals());
  return VectorXd::LinSpaced(bins, 0, step * static_cast<double>(bins - 1));
}

MeasuredDeformation displaced(const RecordSegment& segment, const RowVectorXd& sense, int ratio) {
  const Index samples = segment.intervals();
  VectorXd d = VectorXd::Zero(samples + 1);
  for (Index a = 0; a < sense.size(); ++a)
    if (segment.is_displaced(a)) d += sense[a] * segment.accel.col(a);

  // Subtracts a line between the ends and adds it again, so that the rest is periodic.
  const double slope = (d[samples] - d[0]) / static_cast<double>(samples), first = d[0];
  const VectorXd line =
      VectorXd::LinSpaced(samples, first, first + slope * static_cast<double>(samples - 1));
  const Index bins = segment.first_bin + segment.bins();
  const VectorXcd half = forward_fourier(VectorXd(d.head(samples) - line)).head(bins);
  const VectorXcd rate = half.array() * frequencies(segment, bins).array() * kJ;
  MeasuredDeformation out{ratio * inverse_fourier(half, samples * ratio),
                          ratio * inverse_fourier(rate, samples * ratio)};
  for (Index i = 0; i < out.d.size(); ++i)
    out.d[i] += first + slope * static_cast<double>(i) / ratio;
  out.v.array() += slope * segment.rate_hz;
  return out;
}

/// Returns the spectrum of the deformation's acceleration from 0 to just below half the sampling
/// rate: zero below the band, and the readings above it if axes read all of it.
VectorXcd acceleration(const RecordSegment& segment, const RowVectorXd& sense,
                       const MatrixXcd& motion) {
  const Index samples = segment.intervals(), end = segment.first_bin + segment.bins();
  const Index axes = segment.accel.cols();
  const bool is_read = (sense.tail(sense.size() - axes).array() == 0).all();
  VectorXd read = VectorXd::Zero(samples);
  for (Index a = 0; a < axes && is_read; ++a)
    if (!segment.is_displaced(a)) read += sense[a] * segment.accel.col(a).head(samples);
  VectorXcd out = forward_fourier(read).head((samples + 1) / 2);
  out.head(segment.first_bin).setZero();
  out.segment(segment.first_bin, end - segment.first_bin) = (sense * motion).transpose();
  return out;
}

}  // namespace

MatrixXcd calibrated(const Model& model, const RecordSegment& segment) {
  MatrixXcd out = segment.spectrum;
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::swapped) out.row(e.place.channel).swap(out.row(e.place.with_channel));
  for (Index a = 0; a < out.rows(); ++a)
    for (Index b = 0; b < out.cols(); ++b)
      out(a, b) *= 1 / (1 + model.gain[a]) * std::polar(1.0, segment.w[b] * model.clock_s[a]);
  const MatrixXcd straight = out;
  for (const ModelEffect& e : model.effects) {
    if (e.form != LawForm::misaligned) continue;
    const double angle = e.parameters[0].plain();
    out.row(e.place.channel) =
        (straight.row(e.place.channel) - std::sin(angle) * straight.row(e.place.with_channel)) /
        std::cos(angle);
  }
  return out;
}

VectorXd bin_noise(const Model& model, const RecordSegment& segment, Index bin) {
  VectorXd out = static_cast<double>(segment.intervals()) * segment.variance;
  out *= 1 + 2 * M_PI * segment.corner_hz / segment.w[bin];
  if (segment.model_error.size() > 0) out *= segment.model_error[bin];
  out.array() /= (1 + model.gain.array()).square();
  for (Index a = 0; a < out.size(); ++a)
    if (segment.is_displaced(a)) out[a] *= std::pow(segment.w[bin], 4);
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::swapped) std::swap(out[e.place.channel], out[e.place.with_channel]);
  return out;
}

MeasuredDeformation measured_deformation(const Plant& plant, const RecordSegment& segment,
                                         const RowVectorXd& sense, const MatrixXcd& motion,
                                         int ratio) {
  if (is_prescribed(plant, segment, sense)) return displaced(segment, sense, ratio);
  const VectorXcd accel = acceleration(segment, sense, motion);
  const VectorXd w = frequencies(segment, accel.size()).cwiseMax(1e-12);
  const Index samples = segment.intervals() * ratio;
  return {ratio * inverse_fourier(VectorXcd(-accel.array() / w.array().square()), samples),
          ratio * inverse_fourier(VectorXcd(-accel.array() * kJ / w.array()), samples)};
}

}  // namespace framewatch::estimator
