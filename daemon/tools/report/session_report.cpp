#include "daemon/tools/report/session_report.h"

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/utc_time.h"

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
            : fmt::format("{}, {:g} m/s^2 from rest, {:g} s stored from before",
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
        "<p><strong>The configuration given to this report is not the one the estimates were made "
        "with.</strong></p>\n";
  std::vector<std::string> notes = r.estimates.notes;
  if (r.motion) notes.insert(notes.end(), r.motion->notes.begin(), r.motion->notes.end());
  for (const std::string& note : notes) out += "<p>" + html_text(note) + "</p>\n";
  if (!r.motion)
    out +=
        "<p>Without the raw samples there are no stages, transfer functions, drifts and forces: "
        "<code>framewatch report EST --config CONFIG --raw RAW</code>.</p>\n";
  return out;
}

}  // namespace

std::string drifts_section(const SessionReport& r) {
  return r.drifts ? drift_table_section(*r.drifts, *r.config) : "";
}

std::string session_report_html(const SessionReport& r) {
  const std::string title = r.title.empty() ? "Session of " + r.estimates.table.structure : r.title;
  return html_page(title, verdict_section(r) + (r.drifts ? placard_section(*r.drifts) : "") +
                              "<h1>" + html_text(title) + "</h1>\n" + events_section(r) +
                              session_section(r) + figure_10_section(r) + drifts_section(r) +
                              floors_section(r) + loops_section(r) + transfer_section(r) +
                              histories_section(r) + parameter_section(r) + check_section(r) +
                              health_section(r) + provenance(r));
}

}  // namespace framewatch::daemon
