#include "daemon/tools/lab/reproduction_sections.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/tools/lab/reproduction_plots.h"

namespace framewatch::daemon {
namespace {

/// Mean and quartiles over the windows that have a value.
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

}  // namespace

std::string command_html(const std::string& name, int seeds) {
  return fmt::format("<pre>framewatch reproduce{} --seeds {} --out DIR</pre>\n",
                     name.empty() ? "" : " --case " + name, seeds);
}

std::string noise_section(const Reproduction& all) {
  std::string out = "<h2>Influence of noise</h2>\n" + command_html("noise", all.seeds);
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
  std::string out = "<h2>Removal of noise</h2>\n" + command_html("denoise", all.seeds);
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
  std::string out = "<h2>What is published when little moves</h2>\n" + command_html("noise", seeds);
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
                     "by up to 20 % in k and 40 % in the rest. Dots: k, of all k, that "
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

std::string few_sensors_section(const Reproduction& all) {
  std::vector<std::vector<std::string>> rows;
  for (const FewSensorsRow& r : all.few_sensors)
    rows.push_back({html_text(r.name), percent(r.errors.stiffness.quantile(0.5)),
                    percent(r.errors.stiffness.quantile(0.95)),
                    percent(r.errors.damping.quantile(0.5)),
                    percent(r.errors.damping.quantile(0.95)), r.must()});
  std::string out =
      "<h2>Few sensors</h2>\n" + command_html("few-sensors", all.seeds) +
      "<p>Groups of stories of a plane building of 20 stories, 5-s windows.</p>\n" +
      html_table({"sensors", "k", "95 % of k", "c", "95 % of c", "must (k, c)"}, rows);
  rows.clear();
  for (const FewSensorsRow& r : all.wrong_models)
    rows.push_back({html_text(r.name), percent(r.errors.stiffness.quantile(0.5)),
                    percent(r.errors.stiffness.published_ratio()),
                    percent(r.errors.stiffness.coverage_ratio()), percent(r.errors.held_ratio())});
  return out +
         "<h3>When the model is wrong</h3>\n<p>Share of published stiffnesses whose 95 % interval "
         "holds the truth.</p>\n" +
         html_table({"building", "error of k", "published", "by the window's error",
                     "with the model's error"},
                    rows);
}

}  // namespace framewatch::daemon
