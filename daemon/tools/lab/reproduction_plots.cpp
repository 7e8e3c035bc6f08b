#include "daemon/tools/lab/reproduction_plots.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/svg_plot.h"
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

}  // namespace framewatch::daemon
