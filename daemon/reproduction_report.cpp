#include "daemon/reproduction_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/html_page.h"
#include "daemon/percent.h"
#include "daemon/reproduction_plots.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kKinds[] = {"k", "G", "c", "G<sub>c</sub>"};

std::string figure_of(const std::string& group) {
  if (group == "table1") return "Figure 3";
  return group == "table2c" ? "Figure 5" : "As Figure 5";
}

/// "4 of 5": value and relative error of one identified parameter.
std::string value_and_error(double value, double truth) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.5g} ({}{})", 1e-3 * value, value >= truth ? "+" : "",
                     percent(value / truth - 1));
}

const char* reason_word(Observability reason) {
  switch (reason) {
    case Observability::observable:
      return "";
    case Observability::warming_up:
      return "warming up";
    case Observability::quiet:
      return "quiet";
    case Observability::floor_too_stiff:
      return "floor too stiff";
    case Observability::symmetric_plan:
      return "plan symmetric";
    case Observability::channel_lost:
      return "channel lost";
  }
  return "";
}

std::string parameter_table(const BuildingReproduction& b) {
  const SeedResult& seed = b.rows.front().first_seed;
  std::vector<std::vector<std::string>> rows;
  for (int p = 0; p < b.table.size(); ++p) {
    const auto i = static_cast<std::size_t>(p);
    const WindowEstimate& w = seed.first_window;
    if (i >= w.value.size() || seed.paper_example.size() == 0) return "";
    const bool shown = w.reason[i] == Observability::observable;
    rows.push_back({b.table[p].name, fmt::format("{:.5g}", 1e-3 * b.truth[p]),
                    value_and_error(seed.paper_example[p], b.truth[p]),
                    shown ? value_and_error(w.value[i], b.truth[p]) : reason_word(w.reason[i]),
                    shown ? percent(w.std_error[i] / b.truth[p]) : "",
                    percent(seed.first_bound[p] / b.truth[p])});
  }
  return html_table({"parameter", "truth, 10<sup>3</sup> SI", "paper's method (error)",
                     "framewatch (error)", "its standard error", "least possible"},
                    rows);
}

std::string row_table(const std::vector<const AccuracyRow*>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const AccuracyRow* row : rows)
    for (int kind = 0; kind < 4; ++kind) {
      const ErrorStatistics& ours = row->of(Method::matched, kind);
      cells.push_back({kind == 0 ? html_text(row->name) : "", kKinds[kind],
                       percent(row->least_median(kind)), percent(ours.quantile(0.5)),
                       fmt::format("{:.2f}", ours.quantile(0.5) / row->least_median(kind)),
                       percent(row->of(Method::matched_unaware, kind).quantile(0.5)),
                       percent(row->of(Method::refined, kind).quantile(0.5)),
                       percent(row->of(Method::paper_accel, kind).quantile(0.5)),
                       percent(row->of(Method::paper_example, kind).quantile(0.5)),
                       percent(row->of(Method::paper_denoised, kind).quantile(0.5)),
                       percent(ours.published_ratio()), percent_1(ours.coverage_ratio())});
    }
  return html_table({"case", "", "least possible", "framewatch", "ratio", "noise not configured",
                     "refined", "paper, from accel.", "paper's example", "denoised", "published",
                     "95 % intervals that hold"},
                    cells);
}

std::string command(const std::string& name, int seeds) {
  return fmt::format("<pre>framewatch reproduce{} --seeds {} --out DIR</pre>\n",
                     name.empty() ? "" : " --case " + name, seeds);
}

double worst(const BuildingReproduction& b, const Eigen::VectorXd& theta) {
  return theta.size() == 0 ? NAN : (theta.cwiseQuotient(b.truth).array() - 1).abs().maxCoeff();
}

std::string building_section(const BuildingReproduction& b, const Reproduction& all) {
  std::string out = fmt::format("<h2>{}</h2>\n", html_text(b.title));
  out += command(b.group, all.seeds);
  out += html_figure(
      given_and_identified(b),
      fmt::format("<b>{}</b>. Given and identified parameters without noise, first 10 s of {} at "
                  "45°. Largest relative error: paper's method {} (its accelerations, velocities "
                  "and displacements are exact), framewatch {} (from sampled accelerations alone, "
                  "last 5 s, design off by up to 10 % in k and 30 % in the rest).",
                  figure_of(b.group), html_text(all.hachinohe), percent(worst(b, b.paper)),
                  percent(worst(b, b.matched))));
  std::vector<const AccuracyRow*> rows;
  for (const AccuracyRow& row : b.rows) rows.push_back(&row);
  out += fmt::format("<h3>With noise: medians over {} motions</h3>\n", all.seeds);
  out += row_table(rows);
  out += fmt::format("<h3>{}, motion 1: every parameter</h3>\n", html_text(b.rows.front().name));
  return out + parameter_table(b);
}

std::string noise_section(const Reproduction& all) {
  std::string out = "<h2>Influence of noise</h2>\n" + command("noise", all.seeds);
  std::vector<std::string> plots = noise_influence(*all.noise, all.noise->paper, "paper", 1, true);
  const auto ours = noise_influence(*all.noise, all.noise->matched, "framewatch", 0, true);
  out +=
      html_figure(plots, "<b>Figure 6</b>. Table 2(c), first 10 s of " + html_text(all.el_centro) +
                             " at 45°, the paper's method: independent noise between 0.075 and 150 "
                             "rad/s on accelerations, velocities and displacements, one line a "
                             "parameter, mean over the seeds.");
  out += html_figure(ours,
                     "The same by framewatch: white noise on the accelerometers, 5-s window "
                     "that ends at 10 s, before the gate decides what is published.");
  return out;
}

std::string denoise_section(const Reproduction& all) {
  std::string out = "<h2>Removal of noise</h2>\n" + command("denoise", all.seeds);
  out += html_figure(noise_influence(*all.denoise, all.denoise->paper, "before", 1, false),
                     "<b>Figure 7</b>, before denoising: the paper's method, Table 2(c), first 10 "
                     "s of " +
                         html_text(all.el_centro) + ".");
  out += html_figure(noise_influence(*all.denoise, all.denoise->denoised, "after", 3, false),
                     "<b>Figure 7</b>, after denoising by singular value decomposition, p = 200, "
                     "q = 5, s(r) ≥ 0.98. Without noise the removal costs accuracy: what it "
                     "takes off is motion.");
  out += html_figure(noise_influence(*all.denoise, all.denoise->matched, "framewatch", 0, false),
                     "framewatch on accelerations with the same share of noise, without any "
                     "removal.");
  return out;
}

std::string robustness_section(const Robustness& r, int seeds) {
  std::string out = "<h2>What is published when little moves</h2>\n" + command("noise", seeds);
  std::vector<std::string> plots;
  std::vector<std::vector<std::string>> rows;
  for (const ExcitationSweep& sweep : r.sweeps) {
    plots.push_back(excitation_plot(sweep));
    rows.push_back({html_text(sweep.name)});
    for (int kind = 0; kind < 3; ++kind) {
      rows.back().push_back(fmt::format("{}", sweep.published(kind)));
      rows.back().push_back(percent(sweep.wrong_ratio(kind)));
    }
  }
  out += html_figure(plots,
                     "The sensors' noise stays, the motion fades from left to right; design off "
                     "by up to 20 % in k and 40 % in the rest. Red dots: parameters, of all, that "
                     "are published and wrong by more than 5 %.");
  out += html_table({"sweep", "k published", "of these off by > 5 %", "G published",
                     "off by > 25 %", "c published", "off by > 25 %"},
                    rows);
  rows.clear();
  for (const Silence& s : r.silences)
    rows.push_back({html_text(s.name + (s.noise_configured ? "" : ", noise not configured")),
                    fmt::format("{:g}", s.hours), fmt::format("{}", s.windows),
                    fmt::format("{}", s.published)});
  out += "<h3>Nothing but sensor noise</h3>\n" +
         html_table({"building", "hours", "windows", "windows with a value"}, rows);
  out += fmt::format(
      "<p>A bias of 0.05 m/s² on every channel with a thermal ramp of 0.001 m/s² "
      "per s changes k by at most {:.1e} (Table 1, exact motion).</p>\n",
      r.change_by_bias);
  if (r.random_buildings) {
    out += fmt::format(
        "<h3>{} buildings nobody chose</h3>\n<p>One to six stories, one to four "
        "frames each way, everything drawn by seed, 1 % noise.</p>\n",
        seeds);
    out += row_table({&*r.random_buildings});
  }
  return out;
}

/// Mean and quartiles over the windows that have a value.
std::vector<std::string> window_cells(const std::vector<double>& all, double reference) {
  std::vector<double> values;
  for (const double value : all)
    if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {"-", "-", "0"};
  double mean = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  const double median = values[values.size() / 2];
  const auto cell = [&](double value) {
    return std::isfinite(reference) ? value_and_error(value, reference)
                                    : fmt::format("{:.5g}", 1e-3 * value);
  };
  return {cell(mean), cell(median), fmt::format("{}", values.size())};
}

std::string table_section(const TableTest& test) {
  std::string out;
  for (const TableStage& stage : test.stages) {
    out += html_figure(stage_boxes(test, stage),
                       fmt::format("<b>Figure 10</b>, {}: {}. 500 windows of 5 s, one sample "
                                   "apart: boxes as MATLAB draws them (median, quartiles, "
                                   "whiskers, outliers).",
                                   stage.name, html_text(test.motion)));
    std::vector<std::vector<std::string>> rows;
    for (std::size_t p = 0; p < test.parameters.size(); ++p) {
      const ParameterKind kind = test.parameters[p].kind;
      if (kind != ParameterKind::frame_stiffness && kind != ParameterKind::panel_stiffness)
        continue;
      for (const IdentifiedWindows& method : stage.methods) {
        const bool first = &method == &stage.methods.front();
        std::vector<std::string> row{first ? test.parameters[p].name : "", method.method};
        row.push_back(first && std::isfinite(test.reference[p])
                          ? fmt::format("{:.5g}", 1e-3 * test.reference[p])
                          : "");
        for (std::string& cell : window_cells(method.values[p], test.reference[p]))
          row.push_back(std::move(cell));
        rows.push_back(std::move(row));
      }
    }
    out += html_table({"parameter", "method", "truth, 10<sup>3</sup> SI", "mean", "median",
                       "windows with a value"},
                      rows);
  }
  return out;
}

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
  out += command(only, all.seeds);
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
    body += "<h2>Shaking-table test</h2>\n" + command("table-test", all.seeds);
  for (const TableTest& test : all.tables) body += table_section(test);
  if (all.robustness) body += robustness_section(*all.robustness, all.seeds);
  body += "<h2>Promises</h2>\n" + promises_section(all);
  return html_page("framewatch: the paper's examples, reproduced", body);
}

}  // namespace framewatch::daemon
