#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/tools/lab/reproduction_plots.h"
#include "daemon/tools/lab/reproduction_sections.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kSymbols[] = {"k", "G", "c", "G<sub>c</sub>"};

std::string figure_of(const std::string& group) {
  if (group == "table1") return "Figure 3";
  return group == "table2c" ? "Figure 5" : "As Figure 5";
}

const char* reason_word(estimator::Observability reason) {
  switch (reason) {
    case estimator::Observability::observable:
      return "";
    case estimator::Observability::warming_up:
      return "warming up";
    case estimator::Observability::quiet:
      return "quiet";
    case estimator::Observability::floor_too_stiff:
      return "floor too stiff";
    case estimator::Observability::symmetric_plan:
      return "plan symmetric";
    case estimator::Observability::channel_lost:
      return "channel lost";
  }
  return "";
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
                    shown ? value_and_error(w.value[i], b.truth[p]) : reason_word(w.reason[i]),
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

std::string value_and_error(double value, double truth) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.5g} ({}{})", 1e-3 * value, value >= truth ? "+" : "",
                     percent(value / truth - 1));
}

std::string row_table(const std::vector<const AccuracyRow*>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const AccuracyRow* row : rows)
    for (int kind = 0; kind < 4; ++kind) {
      const ErrorStatistics& ours = row->of(Method::matched, kind);
      cells.push_back({kind == 0 ? html_text(row->name) : "", kSymbols[kind],
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
