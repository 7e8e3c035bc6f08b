#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxPerPlot = 24;  ///< parameters beside each other

constexpr const char* kKindName[] = {"frame stiffness", "floor-panel stiffness", "frame damping",
                                     "floor-panel damping"};

std::vector<std::size_t> of_kind(const SessionReport& r, int kind) {
  std::vector<std::size_t> out;
  for (std::size_t p = 0; p < r.estimates.parameters(); ++p)
    if (r.estimates.table.kind[p] == kind) out.push_back(p);
  return out;
}

SvgAxis names(const SessionReport& r, const std::vector<std::size_t>& shown) {
  SvgAxis axis{""};
  for (const std::size_t p : shown) axis.categories.push_back(r.estimates.table.name[p]);
  return axis;
}

/// Offset of member i of `count` that stand at one place of the axis.
double offset(std::size_t i, std::size_t count) {
  return 0.7 * ((static_cast<double>(i) + 0.5) / static_cast<double>(count) - 0.5);
}

/// Two plots stand beside each other as long as their names have room.
int width(std::size_t shown) {
  return shown <= 3 ? 300 : shown <= 8 ? 485 : 980;
}

struct MeanGroup {
  std::string name;
  int color;
  std::vector<double> value, error;
};

/// Left of Figure 10: means beside the references.
std::string means(const SessionReport& r, int kind, const std::vector<std::size_t>& shown) {
  const auto [per_unit, unit] = paper_unit(kind);
  const double factor = per_unit;
  std::vector<MeanGroup> groups;
  const auto reference = [&](const char* name, int color, const std::vector<double>& values) {
    MeanGroup group{name, color, {}, {}};
    bool any = false;
    for (const std::size_t p : shown) {
      group.value.push_back(factor * values[p]);
      any = any || std::isfinite(values[p]);
    }
    if (any) groups.push_back(std::move(group));
  };
  reference("reference-dynamic", 4, r.reference_dynamic);
  reference(r.reference_from_drawings ? "reference-static" : "start value", 6, r.reference_static);
  for (std::size_t s = 0; s < r.compared.size(); ++s) {
    MeanGroup group{r.compared[s].name, static_cast<int>(s), {}, {}};
    for (const std::size_t p : shown) {
      const ParameterSummary one = summarise(r.estimates, p, r.compared[s].boxes);
      group.value.push_back(factor * one.mean);
      group.error.push_back(factor * one.std_error);
    }
    groups.push_back(std::move(group));
  }
  SvgPlot plot(std::string("means: ") + kKindName[kind], names(r, shown),
               {std::string(kKindName[kind]) + ", " + unit, 0}, width(shown.size()), 300);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<double> x;
    for (std::size_t i = 0; i < shown.size(); ++i)
      x.push_back(static_cast<double>(i + 1) + offset(g, groups.size()));
    plot.add(SvgSeries{groups[g].name, groups[g].color, SvgMark::bars, x, groups[g].value,
                       groups[g].error});
  }
  return plot.svg();
}

/// Right of Figure 10: boxplots of the windows.
std::string boxes(const SessionReport& r, int kind, const std::vector<std::size_t>& shown) {
  const auto [factor, unit] = paper_unit(kind);
  SvgPlot plot(fmt::format("windows: {}", kKindName[kind]), names(r, shown),
               {std::string(kKindName[kind]) + ", " + unit}, width(shown.size()), 300);
  for (std::size_t s = 0; s < r.compared.size(); ++s) {
    for (std::size_t i = 0; i < shown.size(); ++i) {
      ParameterSummary one = summarise(r.estimates, shown[i], r.compared[s].boxes);
      for (double* value : {&one.boxplot.q1, &one.boxplot.median, &one.boxplot.q3,
                            &one.boxplot.whisker_low, &one.boxplot.whisker_high})
        *value *= factor;
      for (double& value : one.outliers) value *= factor;
      plot.add(SvgBox{static_cast<double>(i + 1) + offset(s, r.compared.size()), one.boxplot,
                      one.outliers, static_cast<int>(s)});
    }
    plot.add(SvgSeries{r.compared[s].name,
                       static_cast<int>(s),
                       SvgMark::line,
                       {estimator::kNaN},
                       {estimator::kNaN}});
  }
  bool first = true;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double at = factor * r.reference_static[shown[i]];
    if (!std::isfinite(at)) continue;
    const double x = static_cast<double>(i + 1);
    plot.add(SvgSeries{!first                      ? ""
                       : r.reference_from_drawings ? "reference-static"
                                                   : "start value",
                       6,
                       SvgMark::dashed,
                       {x - 0.45, x + 0.45},
                       {at, at}});
    first = false;
  }
  return plot.svg();
}

}  // namespace

std::string figure_10_section(const SessionReport& r) {
  std::string out = "<h2>Identified stiffness and damping</h2>\n";
  for (int kind = 0; kind < 4; ++kind) {
    const std::vector<std::size_t> all = of_kind(r, kind);
    for (std::size_t from = 0; from < all.size(); from += kMaxPerPlot) {
      const std::vector<std::size_t> shown(
          all.begin() + static_cast<std::ptrdiff_t>(from),
          all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), from + kMaxPerPlot)));
      std::string caption = fmt::format(
          "{}: left the means, a bar's whisker being one standard error of a window; right a "
          "boxplot per parameter (median, quartiles, adjacent values, outliers as +), of ",
          kKindName[kind]);
      for (std::size_t s = 0; s < r.compared.size(); ++s)
        caption += fmt::format(
            "{}{} windows of {:g} s in {}", s == 0 ? "" : " and ", r.compared[s].boxes.size(),
            r.estimates.table.window_rows / r.estimates.table.rate_hz, r.compared[s].name);
      out += html_figure({means(r, kind, shown), boxes(r, kind, shown)}, caption + ".");
    }
  }
  return out;
}

}  // namespace framewatch::daemon
