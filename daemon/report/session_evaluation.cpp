#include <algorithm>
#include <cmath>

#include "daemon/report/session_report.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kLoop_s = 10;

const Stage* longest(const std::vector<Stage>& stages, StageKind kind) {
  const Stage* best = nullptr;
  for (const Stage& stage : stages)
    if (stage.kind == kind && (!best || stage.seconds() > best->seconds())) best = &stage;
  return best;
}

/// Forced vibration ends, and free vibration begins, where the shaking stops: the windows next to
/// that moment have seen the same specimen.
void compare(SessionReport& r) {
  const auto most = static_cast<std::size_t>(std::max(1, r.estimates.table.boxplot_windows));
  for (const StageKind kind : {StageKind::forced, StageKind::free}) {
    const Stage* stage = longest(r.stages, kind);
    if (!stage) continue;
    const WindowRange whole = windows_within(r.estimates, stage->from_us, stage->to_us);
    if (whole.size() == 0) continue;
    const std::size_t count = std::min(most, whole.size());
    r.compared.push_back({kind, stage_word(kind), whole,
                          kind == StageKind::free ? WindowRange{whole.from, whole.from + count}
                                                  : WindowRange{whole.to - count, whole.to}});
  }
  if (!r.compared.empty()) return;
  const std::size_t windows = r.estimates.windows();
  r.compared.push_back(
      {StageKind::forced, "all of it", {0, windows}, {windows - std::min(most, windows), windows}});
}

Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void add_dynamic_references(SessionReport& r, const estimator::Structure& structure) {
  const estimator::ParameterTable table(structure);
  for (int p = 0; p < table.size(); ++p) {
    if (table[p].kind != estimator::ParameterKind::frame_stiffness) continue;
    for (const TransferFunction& t : r.transfer)
      if (t.direction == structure.direction(table[p].frame))
        r.reference_dynamic[static_cast<std::size_t>(p)] =
            r.reference_static[static_cast<std::size_t>(p)] * t.stiffness_ratio();
  }
}

}  // namespace

void evaluate(SessionReport& r) {
  const std::size_t count = r.estimates.parameters();
  r.reference_static = r.estimates.table.design;
  if (r.config && r.config->pipeline.design.size() == static_cast<Eigen::Index>(count)) {
    const Eigen::VectorXd& design = r.config->pipeline.design;
    r.reference_static.assign(design.begin(), design.end());
    r.reference_from_drawings = true;
  }
  r.reference_static.resize(count, estimator::kNaN);
  for (double& value : r.reference_static)
    if (!(value > 0)) value = estimator::kNaN;
  r.reference_dynamic.assign(count, estimator::kNaN);
  if (r.motion) r.stages = find_stages(*r.motion);
  compare(r);
  if (!r.motion || !r.config) return;

  const SessionMotion& m = *r.motion;
  const estimator::Structure& structure = r.config->pipeline.structure;
  const Stage* forced = longest(r.stages, StageKind::forced);
  const Eigen::Index from = forced ? m.row_at(forced->from_us) : 0,
                     to = forced ? m.row_at(forced->to_us) : m.accel.rows();
  r.transfer = transfer_functions(
      structure, m, from, to,
      r.reference_from_drawings ? as_vector(r.reference_static) : Eigen::VectorXd());
  add_dynamic_references(r, structure);
  std::vector<double> identified;
  for (std::size_t p = 0; p < count; ++p)
    identified.push_back(summarise(r.estimates, p, r.compared.front().whole).boxplot.median);
  r.loops = frame_loops(structure, m, as_vector(identified),
                        r.config->pipeline.options.high_pass_hz, kLoop_s);
}

double session_seconds(const SessionReport& r, std::int64_t time_us) {
  const std::int64_t origin = r.motion ? r.motion->first_us : r.estimates.start_us.front();
  return 1e-6 * static_cast<double>(time_us - origin);
}

std::pair<double, std::string> paper_unit(int kind) {
  constexpr const char* kUnits[] = {"kN/m", "kN/(rad*m)", "N*s/m", "N*s/(rad*m)"};
  const bool stiffness = kind == static_cast<int>(estimator::ParameterKind::frame_stiffness) ||
                         kind == static_cast<int>(estimator::ParameterKind::panel_stiffness);
  return {stiffness ? 1e-3 : 1.0, kUnits[std::clamp(kind, 0, 3)]};
}

}  // namespace framewatch::daemon
