// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/reproduction_plots.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/svg_plot.h"
#include "estimator/identify/estimate/boxplot.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kQuantity[] = {"frame stiffness, kN/m", "floor stiffness, kN/rad/m",
                                     "frame damping, kN s/m", "floor damping, kN s/rad/m"};
constexpr const char* kSymbol[] = {"k", "G", "c"};

/// A group of parameters that share a plot of Figures 6 and 7.
struct Group {
  std::string title;
  std::vector<int> parameters;
};

std::vector<Group> groups(const estimator::ParameterTable& table, bool damping) {
  std::vector<Group> out;
  const auto add = [&](const std::string& title, auto belongs) {
    Group group{title, {}};
    for (int p = 0; p < table.size(); ++p)
      if (belongs(table[p])) group.parameters.push_back(p);
    out.push_back(std::move(group));
  };
  for (const bool damps : {false, true}) {
    if (damps && !damping) continue;
    const std::string letter = damps ? "c" : "k";
    for (const char* direction : {"x", "y"})
      add(letter + direction + ", frames", [&](const estimator::Parameter& p) {
        return p.name.starts_with(letter + direction + "_");
      });
    for (const int floor : {1, 2})
      add(fmt::format("G{}, floor {}", letter, floor), [&](const estimator::Parameter& p) {
        return p.name.starts_with(fmt::format("G{}_{}_", letter, floor));
      });
  }
  return out;
}

SvgAxis categories(std::vector<std::string> names) {
  return {"", estimator::kNaN, estimator::kNaN, false, std::move(names)};
}

std::vector<double> places(std::size_t count, double offset) {
  std::vector<double> out;
  for (std::size_t i = 1; i <= count; ++i) out.push_back(static_cast<double>(i) + offset);
  return out;
}

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

std::vector<std::string> given_and_identified(const BuildingReproduction& b) {
  std::vector<std::string> out;
  for (int kind = 0; kind < 4; ++kind) {
    std::vector<std::string> names;
    std::vector<double> given, paper, matched;
    for (int p = 0; p < b.table.size(); ++p) {
      if (static_cast<int>(b.table[p].kind) != kind) continue;
      names.push_back(b.table[p].name);
      given.push_back(1e-3 * b.truth[p]);
      paper.push_back(b.paper.size() > 0 ? 1e-3 * b.paper[p] : estimator::kNaN);
      matched.push_back(b.matched.size() > 0 ? 1e-3 * b.matched[p] : estimator::kNaN);
    }
    if (names.empty()) continue;
    SvgAxis y{kQuantity[kind]};
    y.low = 0;
    SvgPlot plot("", categories(names), y, 485, 250);
    plot.add({"given", 6, SvgMark::rings, places(names.size(), 0), given});
    plot.add({"paper's method", 1, SvgMark::dots, places(names.size(), -0.18), paper});
    plot.add({"framewatch", 0, SvgMark::dots, places(names.size(), 0.18), matched});
    out.push_back(plot.svg());
  }
  return out;
}

std::vector<std::string> median_errors(const std::vector<const AccuracyRow*>& rows) {
  struct Shown {
    Method method;
    const char* name;
    int color;
    SvgMark mark;
  };
  constexpr Shown kShown[] = {
      {Method::matched, "framewatch", 0, SvgMark::dots},
      {Method::paper_accel, "paper's, from accelerations", 1, SvgMark::dots},
      {Method::paper_example, "paper's example", 4, SvgMark::dots},
      {Method::paper_denoised, "the same, denoised", 3, SvgMark::rings}};
  std::vector<std::string> out;
  for (int kind = 0; kind < 3; ++kind) {
    std::vector<std::string> names;
    std::vector<double> least;
    for (const AccuracyRow* row : rows) {
      names.push_back(row->name);
      least.push_back(100 * row->least_median(kind));
    }
    SvgPlot plot(fmt::format("{}", kSymbol[kind]), categories(names),
                 {"median error, %", estimator::kNaN, estimator::kNaN, true}, 325, 330);
    plot.add({"least possible", 6, SvgMark::rings, places(rows.size(), 0), least});
    for (const Shown& shown : kShown) {
      std::vector<double> errors;
      for (const AccuracyRow* row : rows)
        errors.push_back(100 * row->of(shown.method, kind).quantile(0.5));
      plot.add({shown.name, shown.color, shown.mark, places(rows.size(), 0), errors});
    }
    out.push_back(plot.svg());
  }
  return out;
}

std::vector<std::string> noise_influence(const NoiseSweep& sweep,
                                         const std::vector<Eigen::VectorXd>& ratio,
                                         const std::string& method, int color, bool damping) {
  std::vector<double> levels;
  for (const double level : sweep.noise_ratio) levels.push_back(100 * level);
  std::vector<std::string> out;
  for (const Group& group : groups(sweep.table, damping)) {
    SvgPlot plot(group.title + ": " + method, {"noise, %", 0, levels.back()},
                 {"identified / given", -0.5, 2}, 242, 190);
    plot.add_rule(1);
    for (const int p : group.parameters) {
      std::vector<double> values;
      for (const Eigen::VectorXd& level : ratio) values.push_back(level[p]);
      plot.add({"", color, SvgMark::thin_line, levels, values});
    }
    out.push_back(plot.svg());
  }
  return out;
}

std::string excitation_plot(const ExcitationSweep& sweep) {
  constexpr SvgMark kMarks[] = {SvgMark::line, SvgMark::dashed, SvgMark::thin_line};
  constexpr int kColors[] = {0, 2, 4};
  SvgPlot plot(sweep.name, {"sensor noise / motion, %", estimator::kNaN, estimator::kNaN, true},
               {"published, %", 0, 105}, 485, 240);
  std::vector<double> levels, wrong;
  for (const ExcitationLevel& level : sweep.levels) {
    levels.push_back(100 * level.noise_ratio);
    wrong.push_back(100.0 * level.wrong[0] / std::max(1, level.all[0]));
  }
  for (std::size_t kind = 0; kind < 3; ++kind) {
    std::vector<double> share;
    for (const ExcitationLevel& level : sweep.levels)
      share.push_back(100.0 * level.published[kind] / std::max(1, level.all[kind]));
    plot.add({kSymbol[kind], kColors[kind], kMarks[kind], levels, share});
  }
  plot.add({"k published and off by > 5 %", 1, SvgMark::dots, levels, wrong});
  return plot.svg();
}

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
