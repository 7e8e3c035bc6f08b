// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_modes.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/monitor/events/change_words.h"
#include "daemon/tools/replay/refined_segment.h"
#include "estimator/identify/elements/story_design.h"

namespace framewatch::daemon {
namespace {

/// theta of the identified building. The variance is of values of the newest window, or of others.
struct ModalValues {
  Eigen::VectorXd theta, newest_variance, other_variance;
};

bool has_value(const NewestValues& newest, std::size_t p) {
  return newest.end_us[p] != 0 && newest.value[p] > 0 && std::isfinite(newest.std_error[p]);
}

/// Returns the newest values, with the design's for elements without one. Sets the reasons and the
/// times in `out`.
ModalValues modal_values(const Config& config, const NewestValues& newest, PageModes& out) {
  using enum estimator::ParameterKind;
  const estimator::ParameterTable table = config.pipeline.parameters();
  const bool designed = config.pipeline.design.size() > 0;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(table.size());
  ModalValues m{identified_design(config.pipeline), zero, zero};
  out.newest_us = *std::ranges::max_element(newest.end_us);
  out.oldest_us = out.newest_us;
  for (int p = 0; p < table.size(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    const auto kind = table[p].kind;
    if (has_value(newest, at)) {
      m.theta[p] = newest.value[at];
      out.oldest_us = std::min(out.oldest_us, newest.end_us[at]);
      (newest.end_us[at] == out.newest_us ? m.newest_variance : m.other_variance)[p] =
          newest.std_error[at] * newest.std_error[at];
      continue;
    }
    m.other_variance[p] = std::pow(estimator::design_tolerance(kind) * m.theta[p], 2);
    if (designed && kind != frame_stiffness && kind != frame_damping) continue;
    std::string& why =
        kind == frame_damping || kind == panel_damping ? out.why_no_damping : out.why;
    if (why.empty())
      why =
          named_place(table[p].name, frame_labels(config.pipeline.structure)) + " has no value yet";
  }
  return m;
}

}  // namespace

PageModes page_modes(const Config& config, const NewestValues& newest) {
  const estimator::PipelineConfig& pipeline = config.pipeline;
  PageModes out;
  if (pipeline.structure.degrees_of_freedom() > kMostPageFreedoms) {
    out.why = fmt::format(
        "the building has more than {} degrees of freedom; framewatch modes computes them from a "
        "record",
        kMostPageFreedoms);
    return out;
  }
  const estimator::ParameterTable table = pipeline.parameters();
  if (newest.value.size() != static_cast<std::size_t>(table.size())) {
    out.why = "no window has values yet";
    return out;
  }
  const ModalValues values = modal_values(config, newest, out);
  if (!out.why.empty()) return out;
  const auto modes = [&](const Eigen::VectorXd& variance) {
    return natural_modes(pipeline.structure, table, estimator::story_design(pipeline), values.theta,
                         Eigen::MatrixXd(variance.asDiagonal()), kMostPageModes, false)
        .modes;
  };
  out.modes = modes(values.newest_variance);
  out.other_errors.resize(out.modes.size());
  if (!values.other_variance.isZero(0)) {
    const auto of_others = modes(values.other_variance);
    for (std::size_t i = 0; i < of_others.size(); ++i)
      out.other_errors[i] = {of_others[i].frequency_error_hz, of_others[i].damping_error};
  }
  if (out.modes.empty()) out.why = "the building is overdamped";
  return out;
}

}  // namespace framewatch::daemon
