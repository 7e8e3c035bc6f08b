#include "daemon/tools/lab/reproduction_report.h"

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/tools/lab/reproduction_plots.h"
#include "daemon/tools/lab/reproduction_sections.h"

namespace framewatch::daemon {
namespace {

std::string promises_section(const Reproduction& all) {
  const std::vector<Promise> list = promises(all);
  if (list.empty())
    return fmt::format("<p>Fewer than {} seeds: nothing is judged.</p>\n", kSeedsToJudge);
  std::vector<std::vector<std::string>> rows;
  int kept = 0;
  for (const Promise& promise : list) {
    rows.push_back(
        {html_text(promise.what), html_text(promise.measured), promise.kept ? "✓" : "<b>✗ no</b>"});
    kept += promise.kept ? 1 : 0;
  }
  return fmt::format("<p>{} of {} promises kept.</p>\n", kept, list.size()) +
         html_table({"promise", "measured", "kept"}, rows);
}

std::string introduction(const Reproduction& all, const std::string& only) {
  std::string out =
      "<h1>The paper's examples, reproduced</h1>\n"
      "<p>K. Shintani, S. Yoshitomi, I. Takewaki et al., <i>Stiffness and Damping Identification "
      "for Asymmetric Building Frame With In-plane Flexible Floors</i>, Front. Built Environ. "
      "5:103 (2019). Its Tables 1 and 2 and Figures 3, 5, 6, 7 and 10, by its own method and by "
      "framewatch, on the same motions.</p>\n";
  out += command_html(only, all.seeds);
  out += fmt::format(
      "<p>framewatch {}. Seeds 1 to {}: each is one artificial ground motion "
      "(Kanai-Tajimi, 15 s, 45°), one draw of sensor noise, one wrong design. Motion "
      "is the exact response (first-order hold at 1 ms, band-limited, decimated to "
      "100 Hz), not the estimator's own scheme.</p>\n",
      FRAMEWATCH_VERSION, all.seeds);
  out += fmt::format("<p>Ground motion of Figures 3 and 5: {}; of Figures 6 and 7: {}.{}</p>\n",
                     html_text(all.hachinohe), html_text(all.el_centro),
                     all.measured_table_missing
                         ? " The measured shaking table is not in FRAMEWATCH_DATA; only the "
                           "virtual one is shown."
                         : "");
  return out +
         "<p><b>Least possible</b>: what the Cramer-Rao bound leaves to any unbiased estimator "
         "with the same accelerometers and the same five seconds (in tables of medians: 0.6745 "
         "times the bound's standard deviation, the median of a normal error; in tables of "
         "parameters: the standard deviation). <b>Refined</b>: framewatch refine, maximum "
         "likelihood, "
         "on the first window of each motion. <b>Paper, from accel.</b>: the paper's equations "
         "on accelerations integrated behind a 0.1-Hz high-pass, 5 s. <b>Paper's example</b>: as "
         "the paper does it, 10 s, independent noise on accelerations, velocities and "
         "displacements, which are given. <b>Denoised</b>: behind its singular value "
         "decomposition. Errors are relative, their medians over parameters, windows and "
         "motions.</p>\n";
}
}  // namespace

std::string reproduction_html(const Reproduction& all, const std::string& only) {
  std::string body = introduction(all, only);
  std::vector<const AccuracyRow*> rows;
  for (const BuildingReproduction& b : all.buildings)
    for (const AccuracyRow& row : b.rows) rows.push_back(&row);
  if (!rows.empty()) {
    body += "<h2>Accuracy under noise</h2>\n" +
            html_figure(median_errors(rows), "Medians of |relative error|, 5-s windows.") +
            row_table(rows);
  }
  for (const BuildingReproduction& b : all.buildings) body += building_section(b, all);
  if (all.noise) body += noise_section(all);
  if (all.denoise) body += denoise_section(all);
  if (!all.tables.empty())
    body += "<h2>Shaking-table test</h2>\n" + command_html("table-test", all.seeds);
  for (const TableTest& test : all.tables) body += table_section(test);
  if (all.robustness) body += robustness_section(*all.robustness, all.seeds);
  if (!all.few_sensors.empty()) body += few_sensors_section(all);
  body += "<h2>Promises</h2>\n" + promises_section(all);
  return html_page("framewatch: the paper's examples, reproduced", body);
}

}  // namespace framewatch::daemon
