// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/words.h"
#include "daemon/tools/report/mode_pictures.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostPictures = 6;

/// Returns the pictures of the lowest modes.
std::string pictures(const RecordModes& m) {
  std::vector<Picture> out = mode_pictures(m, "");
  if (out.empty()) return "";
  if (out.size() > kMostPictures) out.erase(out.begin() + kMostPictures, out.end());
  return html_figure(out,
                     std::string("Shapes of the lowest modes beside the building at rest, "
                                 "gray. Frequency and damping ratio of the ") +
                         (m.identified.modes.empty() ? "design." : "identified model.") +
                         (m.measured.empty() ? "" : " Rings: the measured shape at the channels."));
}

std::string modes_table(const RecordModes& m) {
  std::vector<std::vector<std::string>> rows;
  int number = 0;
  const auto percent = [](double ratio, const char* format) {
    return or_dash(100 * ratio, format);
  };
  for (const ModeRow& row : m.rows) {
    const estimator::NaturalMode none{
        estimator::kNaN, estimator::kNaN, estimator::kNaN, estimator::kNaN, {}, {}};
    const auto natural = [&](const estimator::NaturalModes& of, int at) {
      return at < 0 ? none : of.modes[static_cast<std::size_t>(at)];
    };
    const estimator::NaturalMode identified = natural(m.identified, row.identified),
                                 design = natural(m.design, row.design);
    const estimator::MeasuredMode measured =
        row.measured < 0 ? estimator::MeasuredMode{estimator::kNaN, estimator::kNaN, 0, 0, {}, 0}
                         : m.measured[static_cast<std::size_t>(row.measured)];
    const auto with_error = [](double value, double error, const char* format) {
      return or_dash(value, format) +
             (std::isfinite(error) ? fmt::format(" &plusmn; {:.1g}", error) : "");
    };
    rows.push_back(
        {fmt::format("{}", ++number),
         with_error(identified.frequency_hz, identified.frequency_error_hz, "{:.4f}"),
         with_error(100 * identified.damping_ratio, 100 * identified.damping_error, "{:.3f}"),
         or_dash(measured.frequency_hz, "{:.4f}"), percent(measured.damping_ratio, "{:.2f}"),
         or_dash(design.frequency_hz, "{:.4f}"), percent(design.damping_ratio, "{:.2f}"),
         or_dash(row.mac_measured, "{:.4f}"), or_dash(row.mac_design, "{:.4f}"),
         or_dash(row.mac_design_measured, "{:.4f}"),
         row.identified >= 0 ? motion_words(identified)
         : row.design >= 0   ? motion_words(design)
                             : "",
         html_text(row.note)});
  }
  std::string out =
      html_table({"mode", "identified, Hz", "damping, %", "measured, Hz", "damping, %",
                  "design, Hz", "damping, %", "MAC i-m", "MAC i-d", "MAC d-m", "motion", ""},
                 rows);
  for (const auto& [list, reason] : {std::pair{"Identified", m.no_identified},
                                     {"Measured", m.no_measured},
                                     {"Design", m.no_design}})
    if (!reason.empty()) out += fmt::format("<p>{}: - because {}.</p>\n", list, html_text(reason));
  return out;
}

/// Compares the identified modes before and after a change.
std::string changed_modes(const RecordModes& before, const RecordModes& after) {
  if (before.identified.modes.empty() || after.identified.modes.empty()) return "";
  const auto were = compared_modes(before.identified, before.weights),
             are = compared_modes(after.identified, after.weights);
  const std::vector<int> pairs = paired_modes(were, are);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] < 0) continue;
    const estimator::NaturalMode& was = before.identified.modes[i];
    const estimator::NaturalMode& is = after.identified.modes[static_cast<std::size_t>(pairs[i])];
    const double error = std::hypot(was.frequency_error_hz, is.frequency_error_hz);
    rows.push_back({fmt::format("{:.4f}", was.frequency_hz), fmt::format("{:.4f}", is.frequency_hz),
                    fmt::format("{:+.2f}", 100 * (is.frequency_hz / was.frequency_hz - 1)),
                    fmt::format("{:.2g}", 100 * error / was.frequency_hz),
                    fmt::format("{:.3f}", 100 * was.damping_ratio),
                    fmt::format("{:.3f}", 100 * is.damping_ratio),
                    or_dash(estimator::mac(were, static_cast<int>(i), are, pairs[i]), "{:.4f}")});
  }
  if (rows.empty()) return "";
  return "<h3>Identified modes before and after the change</h3>\n" +
         html_table({"before, Hz", "after, Hz", "change, %", "standard error of it, %",
                     "damping before, %", "damping after, %", "MAC"},
                    rows);
}

}  // namespace

std::string modes_section(const SessionReport& r) {
  if (r.modes.empty()) return "";
  std::string out =
      "<h2>Modes</h2>\n<p>Identified: of the model refined from the stage. Its standard errors "
      "(&plusmn;) come from the covariance of all stiffnesses and dampings and leave out errors of "
      "the model. Measured: from the samples alone. MAC compares shapes at the channels; 1 means "
      "equal: identified with measured (i-m) and with the design (i-d), design with measured "
      "(d-m).</p>\n";
  const RecordModes *before = nullptr, *after = nullptr;
  for (const StageModes& of : r.modes) {
    const ReportStage& stage = r.compared[of.stage];
    (stage.after ? after : before) = &of.modes;
    out += "<h3>" + html_text(stage.name) + "</h3>\n" + pictures(of.modes) + modes_table(of.modes);
  }
  if (before != nullptr && after != nullptr) out += changed_modes(*before, *after);
  return out;
}

}  // namespace framewatch::daemon
