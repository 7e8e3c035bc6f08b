#include "estimator/diagnose/model/run_cache.h"

#include <utility>

#include "estimator/diagnose/spectra/upsampled.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool are_same(const RunSystem& a, const RunSystem& b) {
  const auto same = [](const MatrixXd& x, const MatrixXd& y) {
    return x.rows() == y.rows() && x.cols() == y.cols() && x == y;
  };
  return same(a.stiffness, b.stiffness) && same(a.damping, b.damping) && same(a.mass, b.mass) &&
         same(a.inputs, b.inputs);
}

MatrixXd driving_signals(const VectorXd& errors, const RecordSegment& segment,
                         const std::vector<Index>& axes, int ratio) {
  const Index lead = segment.lead.rows(), samples = lead + segment.intervals();
  MatrixXd out(static_cast<Index>(axes.size()), samples * ratio);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto at = static_cast<Index>(i);
    VectorXd signal(samples);
    signal.head(lead) = segment.lead.col(axes[i]);
    signal.tail(segment.intervals()) = segment.accel.col(axes[i]).head(segment.intervals());
    signal /= 1 + errors[2 * at];
    out.row(at) = upsampled(signal, ratio, -errors[2 * at + 1] * segment.rate_hz).transpose();
  }
  return out;
}

}  // namespace

const ModalSystem& RunCache::modes(const RunSystem& parts, double step_s) {
  if (!modes_ || modes_->step_s != step_s || !are_same(modes_->parts, parts)) {
    ++computed_;
    modes_ = Modes{parts, step_s,
                   ModalSystem(parts.mass, parts.damping, parts.stiffness, parts.inputs, step_s)};
  }
  return modes_->system;
}

const MatrixXd& RunCache::driving(const Model& model, const RecordSegment& segment,
                                  std::size_t record, const std::vector<Index>& axes, int ratio) {
  VectorXd errors(2 * static_cast<Index>(axes.size()));
  for (std::size_t i = 0; i < axes.size(); ++i)
    errors.segment(2 * static_cast<Index>(i), 2) << model.gain[axes[i]], model.clock_s[axes[i]];
  auto kept = driving_.find(record);
  if (kept == driving_.end() || kept->second.ratio != ratio || kept->second.errors != errors)
    kept = driving_
               .insert_or_assign(
                   record, Driving{errors, ratio, driving_signals(errors, segment, axes, ratio)})
               .first;
  return kept->second.signals;
}

}  // namespace framewatch::estimator
