// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/reproduction_sections.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "daemon/tools/lab/reproduction_plots.h"

namespace framewatch::daemon {
namespace {

/// Escapes the names in the first column.
std::vector<std::vector<std::string>> html_rows(std::vector<std::vector<std::string>> rows) {
  for (std::vector<std::string>& row : rows) row.front() = html_text(row.front());
  return rows;
}

/// Returns an identified parameter in thousands of its unit with its relative error:
/// "3505 (+0.14 %)".
std::string value_and_error(double value, double truth) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.5g} ({}{})", 1e-3 * value, value >= truth ? "+" : "",
                     percent(value / truth - 1));
}

/// Returns mean, median and number of the windows that have a value.
std::vector<std::string> window_cells(const std::vector<double>& all, double reference) {
  std::vector<double> values;
  for (const double value : all)
    if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {"-", "-", "0"};
  double mean = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  const auto cell = [&](double value) {
    return std::isfinite(reference) ? value_and_error(value, reference)
                                    : fmt::format("{:.5g}", 1e-3 * value);
  };
  return {cell(mean), cell(median(values)), fmt::format("{}", values.size())};
}

constexpr const char* kSymbols[] = {"k", "G", "c", "G<sub>c</sub>"};

std::string figure_of(const std::string& group) {
  if (group == "table1") return "Figure 3";
  return group == "table2c" ? "Figure 5" : "As Figure 5";
}

std::string parameter_table(const BuildingReproduction& b) {
  const SeedResult& seed = b.rows.front().first_seed;
  std::vector<std::vector<std::string>> rows;
  for (int p = 0; p < b.table.size(); ++p) {
    const auto i = static_cast<std::size_t>(p);
    const estimator::WindowEstimate& w = seed.first_window;
    if (i >= w.value.size() || seed.paper_example.size() == 0) return "";
    const bool shown = w.reason[i] == estimator::Observability::observable;
    rows.push_back({b.table[p].name, fmt::format("{:.5g}", 1e-3 * b.truth[p]),
                    value_and_error(seed.paper_example[p], b.truth[p]),
                    shown ? value_and_error(w.value[i], b.truth[p])
                          : reason_word(static_cast<int>(w.reason[i])),
                    shown ? percent(w.std_error[i] / b.truth[p]) : "",
                    percent(seed.first_bound[p] / b.truth[p])});
  }
  return html_table({"parameter", "truth, 10<sup>3</sup> SI", "paper's method (error)",
                     "framewatch (error)", "its standard error", "least possible"},
                    rows);
}

double worst(const BuildingReproduction& b, const Eigen::VectorXd& theta) {
  return theta.size() == 0 ? NAN : (theta.cwiseQuotient(b.truth).array() - 1).abs().maxCoeff();
}

}  // namespace

void add_other_medians(const AccuracyRow& row, int kind, std::vector<std::string>& cells) {
  for (const Method method : {Method::matched_unaware, Method::refined, Method::paper_accel,
                              Method::paper_example, Method::paper_denoised})
    cells.push_back(percent(row.of(method, kind).quantile(0.5)));
}

std::string command_html(const std::string& name, int seeds) {
  return fmt::format("<pre>framewatch reproduce{} --seeds {} --out DIR</pre>\n",
                     name.empty() ? "" : " --case " + name, seeds);
}

std::string noise_section(const Reproduction& all) {
  std::string out = "<h2>Influence of noise</h2>\n" + command_html("noise", all.seeds);
  out += html_figure(noise_influence(*all.noise, all.noise->paper, "paper", 1, true),
                     "<b>Figure 6</b>. Table 2(c), first 10 s of " + html_text(all.el_centro) +
                         " at 45°, the paper's method: independent noise between 0.075 and 150 "
                         "rad/s on accelerations, velocities and displacements, one line a "
                         "parameter, mean over the seeds.");
  out += html_figure(noise_influence(*all.noise, all.noise->matched, "framewatch", 0, true),
                     "By framewatch: white noise on the accelerometers, 5-s window that ends at 10 "
                     "s, before the gate decides what is published.");
  return out;
}

std::string denoise_section(const Reproduction& all) {
  std::string out = "<h2>Removal of noise</h2>\n" + command_html("denoise", all.seeds);
  out += html_figure(noise_influence(*all.denoise, all.denoise->paper, "before", 1, false),
                     "<b>Figure 7</b>, before denoising: the paper's method, Table 2(c), first 10 "
                     "s of " +
                         html_text(all.el_centro) + ".");
  out += html_figure(noise_influence(*all.denoise, all.denoise->denoised, "after", 3, false),
                     "<b>Figure 7</b>, after denoising by singular value decomposition, p = 200, "
                     "q = 5, s(r) ≥ 0.98. Without noise the removal costs accuracy, because it "
                     "removes motion.");
  out += html_figure(noise_influence(*all.denoise, all.denoise->matched, "framewatch", 0, false),
                     "framewatch on accelerations with the same share of noise, without any "
                     "removal.");
  return out;
}

std::string robustness_section(const Robustness& r, int seeds) {
  std::string out = "<h2>Weak motion</h2>\n" + command_html("noise", seeds);
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
                     "The sensors' noise stays, the motion fades from left to right. The design is "
                     "off by up to 20 % in k and 40 % in the rest. Dots: the share of all k that "
                     "is published and wrong by more than 5 %.");
  out += html_table({"sweep", "k published", "of these off by > 5 %", "G published",
                     "off by > 25 %", "c published", "off by > 25 %"},
                    rows);
  out += "<h3>Sensor noise alone</h3>\n" +
         html_table({"building", "hours", "windows", "windows with a value"},
                    html_rows(silence_rows(r.silences)));
  out += fmt::format(
      "<p>A bias of 0.05 m/s² on every channel with a thermal ramp of 0.001 m/s² "
      "per s changes k by at most {:.1e} (Table 1, exact motion).</p>\n",
      r.change_by_bias);
  if (r.random_buildings) {
    out += fmt::format(
        "<h3>{} random buildings</h3>\n<p>One to six stories, one to four frames each way, drawn "
        "by seed, 1 % noise.</p>\n",
        seeds);
    out += row_table({&*r.random_buildings});
  }
  return out;
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
      const estimator::ParameterKind kind = test.parameters[p].kind;
      if (kind != estimator::ParameterKind::frame_stiffness &&
          kind != estimator::ParameterKind::panel_stiffness)
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

std::vector<std::vector<std::string>> silence_rows(const std::vector<Silence>& silences) {
  std::vector<std::vector<std::string>> out;
  for (const Silence& s : silences)
    out.push_back({s.name + (s.noise_configured ? "" : ", noise not configured"),
                   fmt::format("{:g}", s.hours), fmt::format("{}", s.windows),
                   fmt::format("{}", s.published)});
  return out;
}

std::vector<std::vector<std::string>> few_sensors_rows(const std::vector<FewSensorsRow>& rows) {
  std::vector<std::vector<std::string>> out;
  for (const FewSensorsRow& r : rows)
    out.push_back({r.name, percent(r.errors.stiffness.quantile(0.5)),
                   percent(r.errors.stiffness.quantile(0.95)),
                   percent(r.errors.damping.quantile(0.5)),
                   percent(r.errors.damping.quantile(0.95)), r.must()});
  return out;
}

std::vector<std::vector<std::string>> wrong_model_rows(const std::vector<FewSensorsRow>& rows) {
  std::vector<std::vector<std::string>> out;
  for (const FewSensorsRow& r : rows)
    out.push_back({r.name, percent(r.errors.stiffness.quantile(0.5)),
                   percent(r.errors.stiffness.published_ratio()),
                   percent(r.errors.stiffness.coverage_ratio()), percent(r.errors.held_ratio())});
  return out;
}

std::string few_sensors_section(const Reproduction& all) {
  return "<h2>Few sensors</h2>\n" + command_html("few-sensors", all.seeds) +
         "<p>Groups of stories of a plane building of 20 stories, 5-s windows.</p>\n" +
         html_table({"sensors", "k", "95 % of k", "c", "95 % of c", "must (k, c)"},
                    html_rows(few_sensors_rows(all.few_sensors))) +
         "<h3>Wrong models</h3>\n<p>Share of published stiffnesses whose 95 % interval "
         "holds the truth.</p>\n" +
         html_table({"building", "error of k", "published", "by the window's error",
                     "with the model's error"},
                    html_rows(wrong_model_rows(all.wrong_models)));
}

std::string row_table(const std::vector<const AccuracyRow*>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const AccuracyRow* row : rows)
    for (int kind = 0; kind < 4; ++kind) {
      const ErrorStatistics& ours = row->of(Method::matched, kind);
      cells.push_back({kind == 0 ? html_text(row->name) : "", kSymbols[kind],
                       percent(row->least_median(kind)), percent(ours.quantile(0.5)),
                       fmt::format("{:.2f}", ours.quantile(0.5) / row->least_median(kind))});
      add_other_medians(*row, kind, cells.back());
      cells.back().push_back(percent(ours.published_ratio()));
      cells.back().push_back(percent_1(ours.coverage_ratio()));
    }
  return html_table({"case", "", "least possible", "framewatch", "ratio", "noise not configured",
                     "refined", "paper, from accel.", "paper's example", "denoised", "published",
                     "95 % intervals that hold"},
                    cells);
}

std::string building_section(const BuildingReproduction& b, const Reproduction& all) {
  std::string out = fmt::format("<h2>{}</h2>\n", html_text(b.title));
  out += command_html(b.group, all.seeds);
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

}  // namespace framewatch::daemon
