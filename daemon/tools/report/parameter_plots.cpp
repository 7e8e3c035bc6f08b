// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/words.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxPerPlot = 24;  ///< parameters side by side

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
  for (const std::size_t p : shown) axis.categories.push_back(place_of(r, p));
  return axis;
}

/// Returns the offset of member i of `count` that share a place on the axis.
double offset(std::size_t i, std::size_t count) {
  return 0.7 * ((static_cast<double>(i) + 0.5) / static_cast<double>(count) - 0.5);
}

/// Returns a plot's width: two plots fit side by side while there is room for their names.
int width(std::size_t shown) {
  return shown <= 3 ? 300 : shown <= 8 ? 485 : 980;
}

/// Plots the left part of Figure 10: means next to the references.
SvgPlot means(const SessionReport& r, int kind, const std::vector<std::size_t>& shown) {
  const auto [per_unit, unit] = r.units.of(kind);
  const double factor = per_unit;
  std::vector<SvgSeries> groups;
  const auto reference = [&](const char* name, int color, const std::vector<double>& values) {
    SvgSeries group{name, color, SvgMark::bars, {}, {}};
    for (const std::size_t p : shown) group.y.push_back(factor * values[p]);
    if (std::any_of(group.y.begin(), group.y.end(), [](double v) { return std::isfinite(v); }))
      groups.push_back(std::move(group));
  };
  reference("reference-dynamic", 4, r.reference_dynamic);
  reference(r.reference_from_drawings ? "reference-static" : "start value", 6, r.reference_static);
  for (std::size_t s = 0; s < r.compared.size(); ++s) {
    groups.push_back({r.compared[s].name, static_cast<int>(s), SvgMark::bars, {}, {}});
    for (const std::size_t p : shown) {
      const ParameterSummary one = summarise(r.estimates, p, r.compared[s].boxes);
      groups.back().y.push_back(factor * one.mean);
      groups.back().error.push_back(factor * one.std_error);
    }
  }
  SvgPlot plot(std::string("means: ") + kKindName[kind], names(r, shown),
               {std::string(kKindName[kind]) + ", " + unit, 0}, width(shown.size()), 300);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t i = 0; i < shown.size(); ++i)
      groups[g].x.push_back(static_cast<double>(i + 1) + offset(g, groups.size()));
    plot.add(groups[g]);
  }
  return plot;
}

/// Plots the right part of Figure 10: boxplots of the windows.
SvgPlot boxes(const SessionReport& r, int kind, const std::vector<std::size_t>& shown) {
  const auto [factor, unit] = r.units.of(kind);
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
    const std::string name = r.reference_from_drawings ? "reference-static" : "start value";
    plot.add(
        SvgSeries{first ? name : "", 6, SvgMark::dashed, {x - 0.45, x + 0.45}, {at, at}, {}, name});
    first = false;
  }
  return plot;
}

/// Returns means and boxplots, side by side, of every kind of parameter; `each` gets each pair and
/// its kind.
template <typename Each>
void pairs_of_parameters(const SessionReport& r, const Each& each) {
  constexpr const char* kFile[] = {"frame-stiffness", "panel-stiffness", "frame-damping",
                                   "panel-damping"};
  for (int kind = 0; kind < 4; ++kind) {
    const std::vector<std::size_t> all = of_kind(r, kind);
    for (std::size_t from = 0; from < all.size(); from += kMaxPerPlot) {
      const std::vector<std::size_t> shown(
          all.begin() + static_cast<std::ptrdiff_t>(from),
          all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), from + kMaxPerPlot)));
      const std::string name =
          kFile[kind] + (from == 0 ? "" : fmt::format("-{}", from / kMaxPerPlot + 1));
      each(kind, std::vector<Picture>{{"means-" + name, means(r, kind, shown)},
                                      {"windows-" + name, boxes(r, kind, shown)}});
    }
  }
}

}  // namespace

std::string figure_10_section(const SessionReport& r) {
  std::string out = "<h2>Identified stiffness and damping</h2>\n";
  pairs_of_parameters(r, [&](int kind, const std::vector<Picture>& pair) {
    std::string caption = fmt::format(
        "{}: on the left the means, with whiskers of one standard error of a window; on the "
        "right a boxplot per parameter (median, quartiles, adjacent values, outliers as +), of ",
        with_capital(kKindName[kind]));
    for (std::size_t s = 0; s < r.compared.size(); ++s)
      caption += fmt::format(
          "{}{} windows of {:g} s in {}", s == 0 ? "" : " and ", r.compared[s].boxes.size(),
          r.estimates.table.window_rows / r.estimates.table.rate_hz, r.compared[s].name);
    out += html_figure(pair, caption + ".");
  });
  return out;
}

std::vector<Picture> parameter_pictures(const SessionReport& r) {
  std::vector<Picture> out;
  pairs_of_parameters(r, [&](int, std::vector<Picture> pair) {
    std::move(pair.begin(), pair.end(), std::back_inserter(out));
  });
  return out;
}

}  // namespace framewatch::daemon
