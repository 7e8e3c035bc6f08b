#include <algorithm>
#include <cmath>

#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kLoop_s = 10;
constexpr std::int64_t kTimeError_us = 500'000;  ///< of the moment of a change

const Stage* longest(const std::vector<Stage>& stages, StageKind kind) {
  const Stage* best = nullptr;
  for (const Stage& stage : stages)
    if (stage.kind == kind && (!best || stage.seconds() > best->seconds())) best = &stage;
  return best;
}

/// A stretch of the session as a stage, its boxes next to where the shaking stops: forced vibration
/// ends and free vibration begins there, and both have seen the same specimen.
void add_stage(SessionReport& r, StageKind kind, const std::string& name, bool after,
               std::int64_t from_us, std::int64_t to_us) {
  const auto most = static_cast<std::size_t>(std::max(1, r.estimates.table.boxplot_windows));
  const WindowRange whole = windows_within(r.estimates, from_us, to_us);
  if (whole.size() == 0) return;
  const std::size_t count = std::min(most, whole.size());
  r.compared.push_back({kind, name, from_us, to_us, after, whole,
                        kind == StageKind::free ? WindowRange{whole.from, whole.from + count}
                                                : WindowRange{whole.to - count, whole.to}});
}

/// The same, cut where the building changed.
void add_cut(SessionReport& r, StageKind kind, const std::string& name, std::int64_t from_us,
             std::int64_t to_us) {
  std::int64_t first_us = INT64_MAX, last_us = INT64_MIN;
  for (const ElementChange& c : r.changes) {
    if (!c.measured()) continue;
    first_us = std::min(first_us, c.since_us - kTimeError_us);
    last_us = std::max(last_us, c.since_us + kTimeError_us);
  }
  if (last_us == INT64_MIN) return add_stage(r, kind, name, false, from_us, to_us);
  add_stage(r, kind, name + ", before the change", false, from_us, std::min(to_us, first_us));
  add_stage(r, kind, name + ", after the change", true, std::max(from_us, last_us), to_us);
}

void compare(SessionReport& r) {
  for (const StageKind kind : {StageKind::forced, StageKind::free})
    if (const Stage* stage = longest(r.stages, kind))
      add_cut(r, kind, stage_word(kind), stage->from_us, stage->to_us);
  if (r.compared.empty())
    add_cut(r, StageKind::forced, "all of it", r.estimates.start_us.front(),
            r.estimates.end_us.back());
  if (r.compared.empty())
    add_stage(r, StageKind::forced, "all of it", false, r.estimates.start_us.front(),
              r.estimates.end_us.back());
}

bool bends(const estimator::PipelineConfig& c) {
  return c.bending_nmprad.any();
}

/// What the drawings say of what is identified; empty: nothing.
Eigen::VectorXd drawn(const estimator::PipelineConfig& c) {
  const estimator::ParameterTable table = c.parameters();
  if (c.design.size() == 0 || !table.grouped()) return c.design;
  return group_parameters(c.structure, table, {c.design, c.bending_nmprad});
}

Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void add_dynamic_references(SessionReport& r) {
  const estimator::ParameterTable table = r.config->pipeline.parameters();
  for (int p = 0; p < table.size(); ++p) {
    if (table[p].kind != estimator::ParameterKind::frame_stiffness) continue;
    for (const TransferFunction& t : r.transfer)
      if (t.direction == table[p].direction)
        r.reference_dynamic[static_cast<std::size_t>(p)] =
            r.reference_static[static_cast<std::size_t>(p)] * t.stiffness_ratio();
  }
}

}  // namespace

void evaluate(SessionReport& r) {
  const std::size_t count = r.estimates.parameters();
  r.reference_static = r.estimates.table.design;
  const Eigen::VectorXd design = r.config ? drawn(r.config->pipeline) : Eigen::VectorXd();
  if (design.size() == static_cast<Eigen::Index>(count)) {
    r.reference_static.assign(design.begin(), design.end());
    r.reference_from_drawings = true;
  }
  r.reference_static.resize(count, estimator::kNaN);
  for (double& value : r.reference_static)
    if (!(value > 0)) value = estimator::kNaN;
  r.reference_dynamic.assign(count, estimator::kNaN);
  r.changes = session_changes(r.estimates);
  r.recoveries = take_recoveries(r.estimates, r.motion ? &*r.motion : nullptr, r.changes);
  r.judged = judged_elements(r.estimates);
  if (r.motion) r.stages = find_stages(*r.motion);
  compare(r);
  if (!r.motion || !r.config) return;

  const SessionMotion& m = *r.motion;
  const estimator::Structure& structure = r.config->pipeline.structure;
  const bool grouped = r.config->pipeline.parameters().grouped();
  // The model of transfer functions does not bend.
  const Eigen::VectorXd reference =
      bends(r.config->pipeline) ? Eigen::VectorXd() : r.config->pipeline.design;
  for (std::size_t i = 0; i < r.compared.size(); ++i) {
    const ReportStage& stage = r.compared[i];
    if (stage.kind != StageKind::forced) continue;
    const Eigen::Index from = m.row_at(stage.from_us), to = m.row_at(stage.to_us);
    auto& transfer = stage.after ? r.transfer_after : r.transfer;
    if (transfer.empty()) transfer = transfer_functions(structure, m, from, to, reference);
    if (grouped) continue;
    std::vector<double> identified;
    for (std::size_t p = 0; p < count; ++p)
      identified.push_back(summarise(r.estimates, p, stage.whole).boxplot.median);
    r.loops.push_back({i, frame_loops(structure, m, as_vector(identified),
                                      r.config->pipeline.options.high_pass_hz, kLoop_s, from, to)});
  }
  add_dynamic_references(r);
  r.drifts = session_drifts(*r.config, m, r.estimates, r.changes);
  if (grouped) r.floors = session_floors(*r.config, m, r.estimates);
}

double session_seconds(const SessionReport& r, std::int64_t time_us) {
  const std::int64_t origin = r.motion ? r.motion->first_us : r.estimates.start_us.front();
  return 1e-6 * static_cast<double>(time_us - origin);
}

bool is_stiffness_kind(int kind) {
  const auto k = static_cast<estimator::ParameterKind>(kind);
  return k == estimator::ParameterKind::frame_stiffness ||
         k == estimator::ParameterKind::panel_stiffness ||
         k == estimator::ParameterKind::bending_stiffness;
}

std::pair<double, std::string> paper_unit(int kind) {
  constexpr const char* kUnits[] = {"kN/m", "kN/(rad*m)", "N*s/m", "N*s/(rad*m)", "kN*m/rad"};
  return {is_stiffness_kind(kind) ? 1e-3 : 1.0, kUnits[std::clamp(kind, 0, 4)]};
}

}  // namespace framewatch::daemon
