#include "estimator/diagnose/fit/axis_readings.h"

#include <cmath>
#include <complex>
#include <utility>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXd;

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
  out.array() /= (1 + model.gain.array()).square();
  for (Index a = 0; a < out.size(); ++a)
    if (segment.is_displaced(a)) out[a] *= std::pow(segment.w[bin], 4);
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::swapped) std::swap(out[e.place.channel], out[e.place.with_channel]);
  return out;
}

}  // namespace framewatch::estimator
