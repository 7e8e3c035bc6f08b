// SPDX-License-Identifier: MIT
#include "daemon/tools/report/session_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/utc_time.h"
#include "daemon/base/words.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/monitor/events/change_words.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

std::string session_section(const SessionReport& r) {
  const SessionEstimates& e = r.estimates;
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const char* name, const std::string& value) {
    if (!value.empty()) rows.push_back({name, value});
  };
  row("test", html_text(r.test));
  row("operator", html_text(r.operator_name));
  row("notes", html_text(r.notes));
  row("structure", html_text(e.table.structure));
  row("begins", sensor_time_text(r.motion ? r.motion->first_us : e.start_us.front()));
  const std::int64_t end =
      r.motion ? r.motion->time_us(r.motion->accel.rows() - 1) : e.end_us.back();
  row("length", fmt::format("{:.1f} s", session_seconds(r, end)));
  if (r.session) {
    row("began by",
        r.session->triggered_by.empty()
            ? r.session->asked_by.empty() ? "hand"
                                          : "a command of " + html_text(r.session->asked_by)
            : fmt::format("{}, {:g} m/s^2 from rest, with {:g} s before it",
                          html_text(r.session->triggered_by), r.session->request.trigger_mps2,
                          r.session->request.pre_trigger_s));
    row("lost", fmt::format("{} samples, {} of the recorder's {} messages", r.session->lost,
                            r.session->dropped, r.session->messages));
  }
  row("windows",
      fmt::format("{} of {:g} s, {:g} s apart", e.windows(), e.table.window_rows / e.table.rate_hz,
                  e.table.hop_rows / e.table.rate_hz));
  return "<h2>Session</h2>\n" + html_table({"", ""}, rows);
}

std::string provenance(const SessionReport& r) {
  std::vector<std::vector<std::string>> rows;
  for (const ReportFile& file : r.files)
    rows.push_back({html_text(file.path), file.use, "<code>" + file.sha256 + "</code>"});
  std::string out = "<h2>Provenance</h2>\n" + html_table({"file", "use", "SHA-256"}, rows);
  const parameter_table_t& table = r.estimates.table;
  out += fmt::format(
      "<p>Estimated by framewatch {} with the configuration <code>{}</code>; reported by "
      "framewatch " FRAMEWATCH_VERSION ".</p>\n",
      html_text(table.version), html_text(table.config_sha256));
  if (r.config && r.config->sha256 != table.config_sha256)
    out +=
        "<p><strong>The configuration of this report differs from the one that the estimates were "
        "made with.</strong></p>\n";
  std::vector<std::string> notes = r.estimates.notes;
  if (r.motion) notes.insert(notes.end(), r.motion->notes.begin(), r.motion->notes.end());
  for (const std::string& note : notes) out += html_paragraph(note);
  if (!r.motion)
    out +=
        "<p>Stages, transfer functions, drifts and forces need the raw samples: "
        "<code>framewatch report EST --config CONFIG --raw RAW</code>.</p>\n";
  return out;
}

constexpr double kLoop_s = 10;
constexpr std::int64_t kTimeError_us = 500'000;  ///< error of a change's time

const Stage* longest(const std::vector<Stage>& stages, StageKind kind) {
  const Stage* best = nullptr;
  for (const Stage& stage : stages)
    if (stage.kind == kind && (!best || stage.seconds() > best->seconds())) best = &stage;
  return best;
}

/// Adds a stretch of the session as a stage. Its boxes are next to the end of the shaking, where
/// forced vibration ends and free vibration begins, so that both show the same specimen.
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

/// Adds a stretch of the session as a stage, or as two when the building changed in it.
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

/// Returns the design of the identified parameters, from the drawings; empty without drawings.
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
    const auto at = static_cast<std::size_t>(p);
    std::string& reason = r.no_reference_dynamic[at];
    if (table[p].kind != estimator::ParameterKind::frame_stiffness) {
      reason = "only frame stiffness has a reference-dynamic value";
      continue;
    }
    reason = r.config->pipeline.design.size() == 0 ? "the configuration has no [design]"
             : r.config->pipeline.bending_nmprad.any()
                 ? "the model of transfer functions does not bend"
                 : fmt::format(
                       "no transfer function along {}: it needs 8 s of forced vibration "
                       "without missing samples, and channels at base and top",
                       letter(table[p].direction));
    for (const TransferFunction& t : r.transfer) {
      if (t.direction != table[p].direction) continue;
      r.reference_dynamic[at] = r.reference_static[at] * t.stiffness_ratio();
      if (std::isfinite(r.reference_dynamic[at]))
        reason.clear();
      else if (!t.no_pair.empty())
        reason = t.no_pair;
    }
  }
}

/// Returns the most frequent reason why a parameter had no value: "quiet".
std::string without(const SessionReport& r, std::size_t p, WindowRange windows) {
  std::array<std::size_t, kReasons> counts{};
  for (std::size_t w = windows.from; w < windows.to; ++w) ++counts[r.estimates.reason[p][w]];
  const auto worst = std::max_element(counts.begin() + 1, counts.end());
  return *worst == 0 ? "" : reason_word(static_cast<int>(worst - counts.begin()));
}

/// Returns the model's error of an absolute value, and how the model fits: "1.2 N/m, fits".
std::string model_error(const ModelFitTold* fit, std::size_t p, double value) {
  static constexpr std::array kWords{"", "fits", "only changes mean something", "does not fit"};
  if (fit == nullptr || fit->word[p] < 1 || fit->word[p] > 3) return "-";
  const char* word = kWords[static_cast<std::size_t>(fit->word[p])];
  return fit->word[p] == 3 ? word : or_dash(fit->error[p] * value, "{:#.2g}") + ", " + word;
}

const char* polarity_word(int polarity) {
  return polarity > 0 ? "right" : polarity < 0 ? "<strong>reversed</strong>" : "not tapped";
}

std::string of_range(const ChannelResult& r) {
  return r.range > 0 ? fmt::format("{:.0f}", 100 * r.peak / r.range) : "";
}

/// Numbers the reasons why cells of a table are empty.
class Reasons {
 public:
  /// Returns the text of a number, or a dash with the number of the reason.
  std::string cell(double value, const char* format, const std::string& reason) {
    if (std::isfinite(value)) return fmt::format(fmt::runtime(format), value);
    return mark("-", reason);
  }
  /// Returns the text with the number of the reason.
  std::string mark(const std::string& text, const std::string& reason) {
    const auto at = std::find(reasons_.begin(), reasons_.end(), reason);
    const auto number = at - reasons_.begin() + 1;
    if (at == reasons_.end()) reasons_.push_back(reason);
    return fmt::format("{}<sup>{}</sup>", text, number);
  }
  /// Returns the list of the reasons.
  std::string list() const {
    std::string out;
    for (std::size_t i = 0; i < reasons_.size(); ++i)
      out += fmt::format("{}<sup>{}</sup> {}", i == 0 ? "" : "; ", i + 1, html_text(reasons_[i]));
    return out.empty() ? out : "<p>" + out + ".</p>\n";
  }

 private:
  std::vector<std::string> reasons_;
};

std::string parameter_section(const SessionReport& r) {
  std::string out =
      "<h2>Table of parameters</h2>\n<p>Over every window that lies wholly in the stage. The "
      "standard error is that of one window. Neighboring windows share most of their samples, so "
      "the mean of many windows is not much better. The standard error applies to changes; for "
      "absolute values the larger of it and the model's error applies, which is the same in every "
      "window.</p>\n";
  for (const ReportStage& stage : r.compared) {
    std::vector<std::vector<std::string>> rows;
    Reasons reasons;
    const ModelFitTold* fit = model_fit_at_end(r.estimates, stage.whole);
    for (std::size_t p = 0; p < r.estimates.parameters(); ++p) {
      const auto [factor, unit] = r.units.of(r.estimates.table.kind[p]);
      const ParameterSummary one = summarise(r.estimates, p, stage.whole);
      std::vector<std::string> row{html_text(place_of(r, p)), html_text(r.estimates.table.name[p]),
                                   unit};
      const std::string no_static = "the estimates have no start value and no design of it";
      const std::string empty_word = without(r, p, stage.whole);
      const std::string no_value = empty_word.empty() ? "no window lies wholly in the stage"
                                                      : "no window shows it: " + empty_word;
      row.push_back(reasons.cell(factor * r.reference_static[p], "{:#.4g}", no_static));
      row.push_back(reasons.cell(factor * r.reference_dynamic[p], "{:#.4g}",
                                 "reference-dynamic: " + r.no_reference_dynamic[p]));
      row.push_back(reasons.cell(factor * one.mean, "{:#.4g}", no_value));
      row.push_back(reasons.cell(factor * one.std_error, "{:#.2g}", no_value));
      const std::string model = model_error(fit, p, factor * one.mean);
      row.push_back(model == "-" ? reasons.mark(model,
                                                "the model is not judged: it takes a window "
                                                "that shows the parameter")
                                 : model);
      for (const double value : {one.boxplot.q1, one.boxplot.median, one.boxplot.q3})
        row.push_back(reasons.cell(factor * value, "{:#.4g}", no_value));
      row.push_back(reasons.cell(100 * one.observable_ratio, "{:.1f}", no_value));
      row.push_back(reasons.cell(100 * (one.boxplot.median / r.reference_static[p] - 1), "{:+.1f}",
                                 std::isfinite(r.reference_static[p]) ? no_value : no_static));
      row.push_back(empty_word);
      rows.push_back(std::move(row));
    }
    out +=
        "<h3>" + html_text(stage.name) + "</h3>\n" +
        html_table({"place", "parameter", "unit",
                    r.reference_from_drawings ? "reference-static" : "start value",
                    "reference-dynamic", "mean", "standard error", "model's error", "q1", "median",
                    "q3", "windows with value, %", "median to reference, %", "without, mostly"},
                   rows) +
        reasons.list();
  }
  return out;
}

std::string health_section(const SessionReport& r) {
  std::string out = "<h2>Health of the measurement</h2>\n";
  if (r.estimates.status) {
    const status_t& s = *r.estimates.status;
    out += fmt::format(
        "<p>{} windows published, {} instants used, {} interruptions, {} messages refused, {} lost "
        "to a full queue (at most {} waited).</p>\n",
        s.windows, s.sample_sets, s.gaps, s.rejected_messages, s.queue_dropped, s.queue_high_water);
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < s.name.size(); ++i)
      rows.push_back({html_text(s.name[i]), fmt::format("{}", s.received[i]),
                      fmt::format("{}", s.lost[i]), fmt::format("{}", s.late[i]),
                      fmt::format("{}", s.repaired[i]), fmt::format("{}", s.rejected[i]),
                      fmt::format("{}", s.stuck[i]), fmt::format("{}", s.clipped[i]),
                      or_dash(1e6 * s.noise_mps2_per_rthz[i], "{:#.3g}")});
    out += html_table({"channel", "received", "lost", "late", "repaired", "rejected", "stuck",
                       "clipped", "noise, um/s^2/sqrt(Hz)"},
                      rows);
  }
  return out;
}

std::string check_section(const SessionReport& r) {
  if (!r.session || r.session->run.empty()) return "";
  std::vector<std::vector<std::string>> rows;
  const std::vector<ChannelResult>& before = r.session->check;
  for (std::size_t i = 0; i < r.session->run.size(); ++i) {
    const ChannelResult& run = r.session->run[i];
    std::vector<std::string> row{html_text(run.name)};
    if (i < before.size()) {
      const ChannelResult& c = before[i];
      row.push_back(std::isfinite(c.noise_density) ? fmt::format("{:.3g}", 1e6 * c.noise_density)
                                                   : "");
      row.push_back(fmt::format("{:.2g}", c.rms));
      row.push_back(fmt::format("{:+.3f}", c.offset));
    } else {
      row.resize(4);
    }
    row.push_back(fmt::format("{:.3g}", run.peak));
    row.push_back(of_range(run));
    row.push_back(fmt::format("{}", run.saturated));
    row.push_back(polarity_word(run.polarity));
    std::string problem = i < before.size() ? before[i].problem : "";
    if (run.problem != problem) problem += (problem.empty() ? "" : "; then ") + run.problem;
    row.push_back(html_text(problem));
    rows.push_back(std::move(row));
  }
  return "<h2>Channels</h2>\n" +
         html_table({"channel", "noise before, um/s^2/sqrt(Hz)", "rms before, m/s^2",
                     "offset before, m/s^2", "peak in the test, m/s^2", "of its range, %",
                     "saturated", "polarity (tap test)", ""},
                    rows) +
         (before.empty() ? "<p>The channels were not checked before the test.</p>\n" : "");
}

}  // namespace

std::string session_report_html(const SessionReport& r) {
  const std::string title = r.title.empty() ? "Session of " + r.estimates.table.structure : r.title;
  const std::string head = verdict_section(r) + (r.drifts ? placard_section(*r.drifts) : "") +
                           "<h1>" + html_text(title) + "</h1>\n" + about_section(r.about);
  return html_page(
      title, head + with_contents(events_section(r) + session_section(r) +
                                  photograph_section(r.about) + figure_10_section(r) +
                                  (r.drifts ? drift_table_section(*r.drifts, *r.config) : "") +
                                  floors_section(r) + loops_section(r) + transfer_section(r) +
                                  modes_section(r) + histories_section(r) + parameter_section(r) +
                                  check_section(r) + health_section(r) + provenance(r)));
}

void evaluate(SessionReport& r) {
  const std::size_t count = r.estimates.parameters();
  r.units = ReportUnits(r.estimates.table);
  if (r.config) r.labels = frame_labels(r.config->pipeline.structure);
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
  r.no_reference_dynamic.assign(
      count, "it needs the raw samples: framewatch report EST --config CONFIG --raw RAW");
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
      r.config->pipeline.bending_nmprad.any() ? Eigen::VectorXd() : r.config->pipeline.design;
  for (std::size_t i = 0; i < r.compared.size(); ++i) {
    const ReportStage& stage = r.compared[i];
    if (stage.kind != StageKind::forced) continue;
    const Eigen::Index from = m.row_at(stage.from_us), to = m.row_at(stage.to_us);
    std::vector<double> identified;
    for (std::size_t p = 0; p < count; ++p)
      identified.push_back(summarise(r.estimates, p, stage.whole).boxplot.median);
    r.modes.push_back({i, record_modes(*r.config, m, identified, from, to)});
    auto& transfer = stage.after ? r.transfer_after : r.transfer;
    if (transfer.empty()) transfer = transfer_functions(structure, m, from, to, reference);
    if (grouped) continue;
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

std::string place_of(const SessionReport& r, std::size_t p) {
  return place_words(r.estimates.table.name[p], r.labels);
}

std::string element_of(const SessionReport& r, std::size_t p) {
  return element_words(r.estimates.table, p, r.labels);
}

std::string stages_section(const SessionReport& r) {
  if (r.stages.empty()) return "";
  std::vector<std::vector<std::string>> rows;
  for (const Stage& s : r.stages) {
    const WindowRange w = windows_within(r.estimates, s.from_us, s.to_us);
    rows.push_back({stage_word(s.kind), fmt::format("{:.1f}", session_seconds(r, s.from_us)),
                    fmt::format("{:.1f}", session_seconds(r, s.to_us)),
                    fmt::format("{:.1f}", s.seconds()), fmt::format("{}", w.size())});
  }
  return "<h3>Stages</h3>\n" +
         html_table({"stage", "from, s", "to, s", "length, s", "whole windows"}, rows) +
         "<p>Forced: the base moves. Free: the base rests and the building still moves.</p>\n";
}

}  // namespace framewatch::daemon
