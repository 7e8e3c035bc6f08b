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

/// theta of the identified building with its variances.
struct ModalValues {
  Eigen::VectorXd theta, variance;
};

bool has_value(const NewestValues& newest, std::size_t p) {
  return newest.end_us[p] != 0 && newest.value[p] > 0 && std::isfinite(newest.std_error[p]);
}

/// Returns the newest values, with the design's for elements without one. Sets the reasons and the
/// oldest time in `out`.
ModalValues modal_values(const Config& config, const NewestValues& newest, PageModes& out) {
  using enum estimator::ParameterKind;
  const estimator::ParameterTable table = config.pipeline.parameters();
  const bool designed = config.pipeline.design.size() > 0;
  ModalValues m{identified_design(config.pipeline), Eigen::VectorXd::Zero(table.size())};
  for (int p = 0; p < table.size(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    double error = estimator::design_tolerance(table[p].kind) * m.theta[p];
    if (has_value(newest, at)) {
      m.theta[p] = newest.value[at];
      error = newest.std_error[at];
      out.oldest_us = out.oldest_us == 0 ? newest.end_us[at]
                                         : std::min(out.oldest_us, newest.end_us[at]);
    } else {
      const bool damping = table[p].kind == frame_damping || table[p].kind == panel_damping;
      std::string& why = damping ? out.why_no_damping : out.why;
      if (why.empty() && (!designed || table[p].kind == frame_stiffness ||
                          table[p].kind == frame_damping))
        why = fmt::format("{} ({}) has no value yet", place_words(table[p].name), table[p].name);
    }
    m.variance[p] = error * error;
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
  out.modes = natural_modes(pipeline.structure, table, estimator::story_design(pipeline),
                            values.theta, Eigen::MatrixXd(values.variance.asDiagonal()), kMostPageModes)
                  .modes;
  if (out.modes.empty()) out.why = "the building is overdamped";
  return out;
}

}  // namespace framewatch::daemon
