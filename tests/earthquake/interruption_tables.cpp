// SPDX-License-Identifier: MIT
#include "tests/earthquake/interruption_tables.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/core.h>

#include "estimator/numeric/quantile.h"
#include "tests/earthquake/coverage.h"

namespace framewatch::earthquake {
namespace {

constexpr double kLatest_s = 1.2, kMinCoverage = 0.90, kMaxCoverage = 0.99;
constexpr double kAsOften =
    0.05;  // largest share of cases or of time that an interruption may cost

using Chosen = std::function<bool(const InterruptionCase&)>;

/// A line of a table: its title and the cases it is about.
struct Line {
  std::string title;
  Chosen chosen;
};

std::vector<Line> lines_by_kind(const std::vector<InterruptionCase>& cases) {
  std::vector<Line> out;
  for (const InterruptionCase& c : cases) {
    const std::string title = text_of(c.kind, c.length_s);
    const bool there =
        std::any_of(out.begin(), out.end(), [&](const Line& l) { return l.title == title; });
    if (!there)
      out.push_back({title, [title](const InterruptionCase& of) {
                       return text_of(of.kind, of.length_s) == title;
                     }});
  }
  std::stable_sort(out.begin(), out.end(), [](const Line& a, const Line& b) {
    const auto order = [](const Line& l) { return l.title.starts_with("one channel m") ? 1 : 0; };
    return order(a) < order(b);
  });
  return out;
}

bool is_interrupted(const InterruptionCase& c) {
  return c.kind != Interruption::none;
}

std::vector<Line> lines_by_building() {
  std::vector<Line> out;
  for (int b = 0; b < static_cast<int>(interruption_buildings().size()); ++b)
    for (const bool off : {false, true})
      out.push_back(
          {fmt::format("{}, design {}", interruption_buildings()[static_cast<std::size_t>(b)].name,
                       off ? "off by 30 %" : "right"),
           [=](const InterruptionCase& c) {
             return is_interrupted(c) && c.building == b && c.design_off == off;
           }});
  return out;
}

std::string seconds(double s) {
  return std::isfinite(s) ? fmt::format("{:.2f}", s) : "> 10";
}

std::string percent(double ratio) {
  return std::isnan(ratio) ? "-" : fmt::format("{:.3g} %", 100 * ratio);
}

std::string with_error(const Coverage& c) {
  if (c.count() == 0) return "-";
  return fmt::format("{:.1f} ± {:.1f} %", 100 * c.ratio(), 100 * c.std_error());
}

struct Run {
  const std::vector<InterruptionCase>& cases;
  const std::vector<InterruptionResult>& results;

  template <typename Function>
  void each(const Chosen& chosen, const Function& function) const {
    for (std::size_t i = 0; i < cases.size(); ++i)
      if (chosen(cases[i])) function(static_cast<int>(i), results[i]);
  }
  bool has(const Chosen& chosen) const { return std::any_of(cases.begin(), cases.end(), chosen); }
  std::vector<double> firsts(const Chosen& chosen, int window, double FirstWindow::*what) const {
    std::vector<double> out;
    each(chosen, [&](int, const InterruptionResult& r) {
      out.push_back(r.first[static_cast<std::size_t>(window)].*what);
    });
    return out;
  }
  /// Share of the time from 1.2 s to 8 s in which windows with a value of a stiffness end.
  double shown_ratio(const Chosen& chosen, int window) const {
    int count = 0, all = 0;
    each(chosen, [&](int, const InterruptionResult& r) {
      for (const bool slot : r.shown[static_cast<std::size_t>(window)]) count += slot ? 1 : 0;
      all += kSlots;
    });
    return all > 0 ? static_cast<double>(count) / all : 0;
  }
  /// Selects one bin, or all bins after the interruption.
  Coverage coverage(const Chosen& chosen, int window, int bin, int group) const {
    Coverage out;
    each(chosen, [&](int i, const InterruptionResult& r) {
      const auto& bins = r.tally[static_cast<std::size_t>(window)];
      for (std::size_t b = 0; b < bins.size(); ++b)
        for (std::size_t g = 0; g < kParameterGroups; ++g)
          if ((bin < 0 ? b > 0 : static_cast<int>(b) == bin) &&
              (group < 0 || static_cast<int>(g) == group) && bins[b][g].count > 0)
            out.add_values(i, bins[b][g].count, bins[b][g].held, bins[b][g].square_sum);
    });
    return out;
  }
};

std::string first_table(const Run& run, const std::vector<Line>& lines) {
  std::string out =
      "| | cases | 1 s: any k | all k | 90 % | latest | published | shown | 5 s: any k | all k | "
      "90 % "
      "| shown |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Line& line : lines) {
    const auto at = [&](int window, double FirstWindow::*what, double share) {
      return seconds(estimator::quantile(run.firsts(line.chosen, window, what), share));
    };
    out += fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", line.title,
        run.firsts(line.chosen, kShort, &FirstWindow::any_s).size(),
        at(kShort, &FirstWindow::any_s, 0.5), at(kShort, &FirstWindow::all_s, 0.5),
        at(kShort, &FirstWindow::any_s, 0.9), at(kShort, &FirstWindow::any_s, 1),
        at(kShort, &FirstWindow::published_s, 0.5), percent(run.shown_ratio(line.chosen, kShort)),
        at(kMain, &FirstWindow::any_s, 0.5), at(kMain, &FirstWindow::all_s, 0.5),
        at(kMain, &FirstWindow::any_s, 0.9), percent(run.shown_ratio(line.chosen, kMain)));
  }
  return out;
}

std::string error_table(const Run& run, const std::vector<Line>& lines) {
  std::string out = "| |";
  for (const char* window : {"1 s", "5 s"})
    for (const double at_s : kErrorAt_s) out += fmt::format(" {}, {:g} s after |", window, at_s);
  out += "\n| --- |";
  for (std::size_t i = 0; i < 2 * kErrorAt_s.size(); ++i) out += " --- |";
  out += "\n";
  for (const Line& line : lines) {
    if (!run.has(line.chosen)) continue;
    out += "| " + line.title + " |";
    for (const std::size_t of : {1U, 0U})
      for (std::size_t t = 0; t < kErrorAt_s.size(); ++t) {
        std::vector<double> k, c;
        int wanted = 0;
        run.each(line.chosen, [&](int, const InterruptionResult& r) {
          const auto& e = r.error[of][t];
          k.insert(k.end(), e[stiffnesses].begin(), e[stiffnesses].end());
          c.insert(c.end(), e[dampings].begin(), e[dampings].end());
          wanted += r.wanted[stiffnesses];
        });
        const double share = wanted > 0 ? static_cast<double>(k.size()) / wanted : 0;
        out += k.empty() ? " - |"
                         : fmt::format(" {}, {} ({:.0f} %) |", percent(estimator::quantile(k, 0.5)),
                                       percent(estimator::quantile(c, 0.5)), 100 * share);
      }
    out += "\n";
  }
  return out;
}

std::string coverage_table(const Run& run, const std::vector<Line>& lines, int window) {
  std::string out = "| | while it lasts |";
  for (std::size_t b = 1; b < kUntil_s.size(); ++b)
    out += fmt::format(" {:g} to {:g} s |", kUntil_s[b - 1], kUntil_s[b]);
  out += " all | rms of error / stated |\n| --- |";
  for (std::size_t b = 0; b < kUntil_s.size() + 2; ++b) out += " --- |";
  out += "\n";
  for (const Line& line : lines) {
    if (!run.has(line.chosen)) continue;
    out += "| " + line.title + " |";
    for (int b = 0; b < static_cast<int>(kUntil_s.size()); ++b)
      out += " " + with_error(run.coverage(line.chosen, window, b, -1)) + " |";
    const Coverage all = run.coverage(line.chosen, window, -1, -1);
    out += fmt::format(" {} | {:.2f} |\n", with_error(all), all.rms_of_errors());
  }
  return out;
}

std::string kinds_table(const Run& run) {
  std::string out =
      "| window | k | G | c, G_c | no interruption: k | G | c, G_c |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const int window : {1, 2, 0, 3}) {
    out += fmt::format("| {:g} s |", kWindow_s[static_cast<std::size_t>(window)]);
    for (const bool interrupted : {true, false})
      for (int g = 0; g < kParameterGroups; ++g)
        out += " " +
               with_error(run.coverage(
                   [=](const InterruptionCase& c) { return is_interrupted(c) == interrupted; },
                   window, -1, g)) +
               " |";
    out += "\n";
  }
  return out;
}

std::string times_table(const Run& run) {
  std::string out = "| window |";
  for (std::size_t b = 1; b < kUntil_s.size(); ++b)
    out += fmt::format(" {:g} to {:g} s |", kUntil_s[b - 1], kUntil_s[b]);
  out += " no interruption |\n| --- |";
  for (std::size_t b = 0; b < kUntil_s.size(); ++b) out += " --- |";
  out += "\n";
  for (const int window : {1, 2, 0, 3}) {
    out += fmt::format("| {:g} s |", kWindow_s[static_cast<std::size_t>(window)]);
    for (int b = 1; b < static_cast<int>(kUntil_s.size()); ++b)
      out += " " + with_error(run.coverage(is_interrupted, window, b, -1)) + " |";
    const auto control = [](const InterruptionCase& c) { return !is_interrupted(c); };
    out += " " + with_error(run.coverage(control, window, -1, -1)) + " |\n";
  }
  return out;
}

}  // namespace

std::string interruption_tables(const std::vector<InterruptionCase>& cases,
                                const std::vector<InterruptionResult>& results) {
  const Run run{cases, results};
  const std::vector<Line> kinds = lines_by_kind(cases), buildings = lines_by_building();
  std::string out =
      "Seconds to the end of the first window with a value of any and of all frame stiffnesses: "
      "median, 90 % and latest of the cases; *published*: median of when that was. *Shown*: share "
      "of "
      "the time from 1.2 s to 8 s in which such windows end.\n\n" +
      first_table(run, kinds) + "\n" + first_table(run, buildings);
  out +=
      "\nMedian of |relative error| of published k, c; in brackets the share of k that is "
      "published.\n\n" +
      error_table(run, kinds) + "\n" + error_table(run, buildings);
  for (const int window : {1, 0}) {
    out += fmt::format(
        "\nShare of published values whose stated 95 % interval holds the truth, by time since the "
        "start or the end of the interruption: {:g}-s windows.\n\n",
        kWindow_s[static_cast<std::size_t>(window)]);
    out += coverage_table(run, kinds, window) + "\n" + coverage_table(run, buildings, window);
  }
  out += "\nThe same by length of window, all interruptions.\n\n" + times_table(run);
  out += "\nThe same by length of window and kind of parameter, all times.\n\n" + kinds_table(run);
  return out;
}

std::vector<Demand> interruption_demands(const std::vector<InterruptionCase>& cases,
                                         const std::vector<InterruptionResult>& results) {
  const Run run{cases, results};
  std::vector<Demand> out;
  const auto control = [](const InterruptionCase& c) { return !is_interrupted(c); };
  // If too little moves within a second, nothing can be published, with or without an
  // interruption.
  const auto in_time = [&](const Chosen& chosen) {
    const std::vector<double> firsts = run.firsts(chosen, kShort, &FirstWindow::any_s);
    const auto count =
        std::count_if(firsts.begin(), firsts.end(), [](double s) { return s <= kLatest_s; });
    return firsts.empty() ? 0 : static_cast<double>(count) / static_cast<double>(firsts.size());
  };
  out.push_back(
      {fmt::format("a valid 1-s estimate within {} s: {} of cases, {} without an "
                   "interruption",
                   kLatest_s, percent(in_time(is_interrupted)), percent(in_time(control))),
       in_time(is_interrupted) >= in_time(control) - kAsOften});
  for (const int w : {kShort, kMain})
    out.push_back(
        {fmt::format(
             "{:g}-s estimates from 1.2 s to 8 s: {} of the time, {} without an interruption",
             kWindow_s[static_cast<std::size_t>(w)], percent(run.shown_ratio(is_interrupted, w)),
             percent(run.shown_ratio(control, w))),
         run.shown_ratio(is_interrupted, w) >= run.shown_ratio(control, w) - kAsOften});
  const auto add = [&](const std::string& what, const Coverage& c) {
    if (c.count() == 0) return;
    out.push_back({fmt::format("{}: {} of {:.0f} values", what, with_error(c), c.count()),
                   c.ratio() >= kMinCoverage && c.ratio() <= kMaxCoverage});
  };
  for (int w = 0; w < kWindowLengths; ++w)
    for (int b = 1; b < static_cast<int>(kUntil_s.size()); ++b)
      add(fmt::format("{:g}-s windows, {:g} to {:g} s", kWindow_s[static_cast<std::size_t>(w)],
                      kUntil_s[static_cast<std::size_t>(b - 1)],
                      kUntil_s[static_cast<std::size_t>(b)]),
          run.coverage(is_interrupted, w, b, -1));
  return out;
}

}  // namespace framewatch::earthquake
