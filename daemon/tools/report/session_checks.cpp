#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/tools/report/session_report.h"

namespace framewatch::daemon {
namespace {

const char* polarity_word(int polarity) {
  return polarity > 0 ? "right" : polarity < 0 ? "<strong>reversed</strong>" : "not tapped";
}

std::string of_range(const ChannelResult& r) {
  return r.range > 0 ? fmt::format("{:.0f}", 100 * r.peak / r.range) : "";
}

}  // namespace

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

}  // namespace framewatch::daemon
