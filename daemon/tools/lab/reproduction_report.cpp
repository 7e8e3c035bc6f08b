// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/reproduction_report.h"

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/tools/lab/reproduction_plots.h"
#include "daemon/tools/lab/reproduction_sections.h"

namespace framewatch::daemon {
namespace {

std::string promises_section(const Reproduction& all) {
  const std::vector<Promise> list = promises(all);
  if (list.empty())
    return fmt::format("<p>Fewer than {} seeds: no promise is judged.</p>\n", kSeedsToJudge);
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
      "<p>framewatch {}. Seeds 1 to {}: each is one artificial ground motion (Kanai-Tajimi, 15 s, "
      "45°), one draw of sensor noise, one wrong design. Motion is the exact response (first-order "
      "hold at 1 ms, band-limited, decimated to 100 Hz), not the estimator's own scheme.</p>\n",
      FRAMEWATCH_VERSION, all.seeds);
  out += fmt::format("<p>Ground motion of Figures 3 and 5: {}; of Figures 6 and 7: {}.{}</p>\n",
                     html_text(all.hachinohe), html_text(all.el_centro),
                     all.measured_table_missing
                         ? " The measured shaking table is not in FRAMEWATCH_DATA; only the "
                           "virtual one is shown."
                         : "");
  return out +
         "<p><b>Least possible</b>: the Cramer-Rao bound of any unbiased estimator with the same "
         "accelerometers and the same five seconds (in tables of medians: 0.6745 times the bound's "
         "standard deviation, the median of a normal error; in tables of parameters: the standard "
         "deviation). <b>Refined</b>: framewatch refine, maximum likelihood, on the first window "
         "of each motion. <b>Paper, from accel.</b>: the paper's equations on accelerations "
         "integrated behind a 0.1-Hz high-pass, 5 s. <b>Paper's example</b>: as in the paper, 10 "
         "s, independent noise on given accelerations, velocities and displacements. "
         "<b>Denoised</b>: behind its singular value decomposition. Errors are relative, their "
         "medians over parameters, windows and motions.</p>\n";
}

constexpr const char* kKinds[] = {"k", "G", "c"};
using Rows = std::vector<const AccuracyRow*>;

constexpr const char kIntroduction[] = R"(# Accuracy

Written by `framewatch reproduce --seeds {} --out DIR`. Errors are in percent unless stated otherwise.

The buildings are the paper's Table 1 (5 stories, 1x1 bay, 50 parameters) and Table 2 (2 stories, 3x3 bays, 68
parameters) with flexible (2b), basic (2c) and stiff (2d) floors. *Random buildings* have one to six stories and one
to four frames each way. Each seed draws a ground motion (Kanai-Tajimi, 15 s, 45 degrees), noise, and a design that is
off by up to 10 % in k and 30 % in G and c.

The response is exact (first-order hold at 1 ms, band-limited, decimated to 100 Hz) and not the estimator's own
scheme. Noise is white, in percent of each channel's rms. Windows are 5 s long and end at 10, 11, .. 15 s.

)";

constexpr const char kWithNoise[] = R"(## With noise

Median of |relative error| over parameters, windows and {} motions.

- *Least*: the Cramer-Rao bound of any unbiased estimator, 0.6745 times its standard deviation.
- *Must*: the limit that is checked.
- *Unaware*: framewatch without configured sensor noise.
- *Refined*: `framewatch refine` on the first window of each motion.
- *Paper*: the paper's equations on the same accelerations, integrated behind a 0.1-Hz high-pass.
- *Example*: the paper's example, 10 s with independent noise on accelerations, velocities and displacements.
- *Denoised*: the example behind the paper's singular value decomposition (p = 200, q = 5, s(r) >= 0.98).

)";

constexpr const char* kBelowTheBound = R"(
An error can be below the least where prior and design add what the window lacks. The published error includes their
pull.

)";

constexpr const char* kIntervals = R"(## Published errors

Share of parameters that are published, and of these the share whose 95 % interval (2.093 standard errors: Student's
t, 19 degrees of freedom) holds the truth. The limit is 90 to 98 %.

)";

constexpr const char* kBatchMeans = R"(
Standard errors are batch means over 20 blocks of a quarter of a second, plus the pull of prior and noise toward a
wrong design ([equations](equations.md), 21).

)";

constexpr const char* kExact = R"(## Without noise

95th percentile of the relative error over parameters and windows, four motions.

)";

constexpr const char* kAliased = R"(
A record sampled without an anti-alias filter is worse: content above half the sampling rate folds into the band, and
no estimator can detect it.

)";

constexpr const char* kExcitation = R"(## Weak motion

The sensors' noise stays and the motion fades: noise is 0.3 % to 3000 % of the motion's rms, and the design is off by
up to 20 % in k and 40 % in G and c. The table gives the share of all k that is published at each level, and the share
of published values that are off by more than 5 % (k) or 25 % (G, c).

)";

constexpr const char kFewSensors[] = R"(## Few sensors

The building is plane and has 20 stories (f1 0.5 Hz, stiffness falling to a third at the top). The true stiffness of
groups of stories is off the design by up to 20 %, their damping by 30 %. Windows of 5 s, {} motions. *Must*: the limit
for four sensors. Bending is identified where the design has it. `framewatch reproduce --case few-sensors` repeats it.

)";

constexpr const char* kWrongModels = R"(
## Wrong models

True masses, stories, bending or damping differ from the model. Buildings are the one above and one of 5 stories with a
sensor on every floor. The table gives the share of published stiffnesses whose 95 % interval holds the truth: by the
window's standard error alone, which is an error of changes, and by it and the model's error together
([equations](equations.md), errors of the model). The limit for both together is 85 %.

)";

constexpr const char* kLimits = R"(## Limits of every estimator

*Least* is the limit. From 5 s at 1 % noise the stiff floors of a 3x3-bay plan cannot be known better than the table
shows, and their damping hardly at all. Such parameters are reported as not observable.

Masses are assumed to be right: a wrong mass gives a wrong stiffness. Different clocks of the nodes and wrong gains
bias the result ([a real table with both faults](shaking-table.md)). So do forces other than the ground's while they
act.
)";

std::string row(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += " " + cell + " |";
  return out + "\n";
}

std::string table(const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& rows = {}) {
  std::string out = row(head) + row(std::vector<std::string>(head.size(), "---"));
  for (const std::vector<std::string>& cells : rows) out += row(cells);
  return out;
}

std::string limit_text(const std::string& name, int kind) {
  for (const AccuracyCase& c : accuracy_cases())
    if (c.name == name) return percent(c.limit[static_cast<std::size_t>(kind)]);
  return "-";
}

std::string with_noise(const Rows& rows) {
  std::string out = table({"case", "", "least", "framewatch", "must", "times least", "unaware",
                           "refined", "paper", "example", "denoised"});
  for (const AccuracyRow* r : rows)
    for (int kind = 0; kind < 3; ++kind) {
      const double ours = r->of(Method::matched, kind).quantile(0.5);
      std::vector<std::string> cells{
          kind == 0 ? r->name : "",       kKinds[kind],
          percent(r->least_median(kind)), "**" + percent(ours) + "**",
          limit_text(r->name, kind),      fmt::format("{:.2f}", ours / r->least_median(kind))};
      add_other_medians(*r, kind, cells);
      out += row(cells);
    }
  return out;
}

std::string intervals(const Rows& rows) {
  std::string out = table({"case", "k published", "holds", "G published", "holds", "c published",
                           "holds", "unaware: k", "G", "c hold"});
  for (const AccuracyRow* r : rows) {
    std::vector<std::string> cells{r->name};
    for (int kind = 0; kind < 3; ++kind) {
      cells.push_back(percent(r->of(Method::matched, kind).published_ratio()));
      cells.push_back(percent_1(r->of(Method::matched, kind).coverage_ratio()));
    }
    for (int kind = 0; kind < 3; ++kind)
      cells.push_back(percent_1(r->of(Method::matched_unaware, kind).coverage_ratio()));
    out += row(cells);
  }
  return out;
}

std::string exact_motion(const Reproduction& all) {
  std::string out = table({"case", "k", "G", "c", "G_c"});
  for (const BuildingReproduction& b : all.buildings) {
    std::vector<std::string> cells{"Table " + b.group.substr(5)};
    for (const ErrorStatistics& kind : b.exact)
      cells.push_back(fmt::format("{:.1e}", kind.quantile(0.95)));
    out += row(cells);
  }
  return out;
}

std::string excitation(const Robustness& r) {
  std::vector<std::string> head{"building"};
  for (const ExcitationLevel& level : r.sweeps.front().levels)
    head.push_back(fmt::format("{:g} %", 100 * level.noise_ratio));
  for (const char* kind : {"k off", "G off", "c off"}) head.push_back(kind);
  std::string out = table(head);
  for (const ExcitationSweep& sweep : r.sweeps) {
    std::vector<std::string> cells{sweep.name};
    for (const ExcitationLevel& level : sweep.levels)
      cells.push_back(percent(static_cast<double>(level.published[0]) / level.all[0]));
    for (int kind = 0; kind < 3; ++kind) cells.push_back(percent_1(sweep.wrong_ratio(kind)));
    out += row(cells);
  }
  out += "\nSensor noise alone:\n\n" +
         table({"building", "hours", "windows", "windows with a value"}, silence_rows(r.silences));
  return out + fmt::format(
                   "\nA bias of 0.05 m/s^2 on every channel with a thermal ramp of 0.001 m/s^2 per "
                   "s changes k by at most {:.1e}.\n\n",
                   r.change_by_bias);
}

std::string promise_list(const Reproduction& all) {
  const std::vector<Promise> list = promises(all);
  std::string out = "## Promises\n\n", broken;
  if (list.empty())
    return out + fmt::format("Fewer than {} seeds: no promise is judged.\n\n", kSeedsToJudge);
  int kept = 0;
  for (const Promise& promise : list) {
    kept += promise.kept ? 1 : 0;
    if (!promise.kept) broken += "- not kept: " + promise.what + ": " + promise.measured + "\n";
  }
  return out + fmt::format("{} of {} kept.\n\n", kept, list.size()) +
         (broken.empty() ? "" : broken + "\n");
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

std::string accuracy_markdown(const Reproduction& all) {
  Rows rows;
  for (const BuildingReproduction& b : all.buildings)
    for (const AccuracyRow& r : b.rows) rows.push_back(&r);
  if (all.robustness && all.robustness->random_buildings)
    rows.push_back(&*all.robustness->random_buildings);
  std::string out = fmt::format(kIntroduction, all.seeds);
  if (!rows.empty()) {
    out += fmt::format(kWithNoise, all.seeds) + with_noise(rows) + kBelowTheBound;
    out += kIntervals + intervals(rows) + kBatchMeans;
    out += kExact + exact_motion(all) + kAliased;
  }
  if (all.robustness) out += kExcitation + excitation(*all.robustness);
  if (!all.few_sensors.empty())
    out += fmt::format(kFewSensors, all.seeds) +
           table({"sensors", "k", "95 % of k", "c", "95 % of c", "must (k, c)"},
                 few_sensors_rows(all.few_sensors)) +
           kWrongModels +
           table({"building", "error of k", "published", "window's error holds",
                  "with the model's error"},
                 wrong_model_rows(all.wrong_models)) +
           "\n";
  return out + promise_list(all) + kLimits;
}

}  // namespace framewatch::daemon
