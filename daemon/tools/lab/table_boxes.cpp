#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/svg_plot.h"
#include "daemon/tools/lab/reproduction_plots.h"
#include "estimator/identify/estimate/boxplot.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

estimator::BoxplotStatistics statistics(const std::vector<double>& values) {
  estimator::BoxplotWindow window(std::max(1, static_cast<int>(values.size())));
  for (const double value : values) window.push(value);
  return window.statistics();
}

std::string boxes(const TableTest& test, const TableStage& stage, estimator::ParameterKind kind,
                  int width) {
  std::vector<std::string> names;
  std::vector<std::size_t> shown;
  std::vector<double> reference;
  for (std::size_t p = 0; p < test.parameters.size(); ++p) {
    if (test.parameters[p].kind != kind) continue;
    shown.push_back(p);
    names.push_back(test.parameters[p].name);
    reference.push_back(1e-3 * test.reference[p]);
  }
  if (shown.empty()) return "";
  const double highest = *std::max_element(reference.begin(), reference.end());
  const bool frames = kind == estimator::ParameterKind::frame_stiffness;
  SvgAxis x, y{frames ? "frame stiffness, kN/m" : "floor stiffness, kN/rad/m", 0};
  x.categories = names;
  if (std::isfinite(highest)) y.high = 1.6 * highest;
  SvgPlot plot(fmt::format("{}: {}", stage.name, frames ? "frames" : "floors"), x, y, width, 300);
  for (std::size_t m = 0; m < stage.methods.size(); ++m) {
    const double offset = 0.25 * (static_cast<double>(m) - 1);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      std::vector<double> values = stage.methods[m].values[shown[i]];
      for (double& value : values) value *= 1e-3;
      SvgBox box{static_cast<double>(i + 1) + offset, statistics(values), {}, static_cast<int>(m)};
      for (const double value : values)
        if (value < box.statistics.whisker_low || value > box.statistics.whisker_high)
          box.outliers.push_back(value);
      plot.add(std::move(box));
    }
    plot.add(SvgSeries{stage.methods[m].method,
                       static_cast<int>(m),
                       SvgMark::bars,
                       {estimator::kNaN},
                       {estimator::kNaN}});
  }
  if (std::isfinite(highest))
    for (std::size_t i = 0; i < shown.size(); ++i)
      plot.add(SvgSeries{i == 0 ? "truth" : "",
                         6,
                         SvgMark::dashed,
                         {static_cast<double>(i) + 0.6, static_cast<double>(i) + 1.4},
                         {reference[i], reference[i]}});
  return plot.svg();
}

}  // namespace

std::vector<std::string> stage_boxes(const TableTest& test, const TableStage& stage) {
  const bool floors = std::any_of(test.parameters.begin(), test.parameters.end(),
                                  [](const estimator::Parameter& p) {
                                    return p.kind == estimator::ParameterKind::panel_stiffness;
                                  });
  std::vector<std::string> out{
      boxes(test, stage, estimator::ParameterKind::frame_stiffness, floors ? 660 : 485)};
  if (floors) out.push_back(boxes(test, stage, estimator::ParameterKind::panel_stiffness, 310));
  return out;
}

}  // namespace framewatch::daemon
