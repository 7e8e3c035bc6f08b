// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/search_section.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "estimator/diagnose/verdict/evidence.h"

namespace framewatch::daemon {
namespace {

constexpr int kTried = 1, kKept = 0;  ///< colors

/// One step of the search, with everything that it tried.
struct Step {
  std::string name;
  std::vector<double> tried, kept;  ///< left, times noise
};

Step step_of_laws(const DiagnoseOutput& o, std::string name,
                  const std::vector<estimator::Trial>& tried, const estimator::Trial* kept) {
  Step out{std::move(name), {}, {}};
  const auto add = [&](const estimator::Trial& t, std::vector<double>& to) {
    const double left = misfit_ratio(o.plant, o.segments, t);
    if (std::isfinite(left)) to.push_back(left);
  };
  for (const estimator::Trial& t : tried) add(t, out.tried);
  if (kept) add(*kept, out.kept);
  return out;
}

std::vector<Step> steps_of(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  std::vector<Step> out{{"linear", {}, {d.ratio_before}}, {"places", {}, {}}};
  for (const estimator::WhereEntry& w : d.map) out.back().tried.push_back(w.ratio);
  std::vector<const estimator::FoundEffect*> chosen;  // of a pair, only the first
  for (const estimator::FoundEffect& f : d.effects)
    if (!f.alternatives.empty() &&
        (chosen.empty() || !f.chosen.second || f.chosen.cost != chosen.back()->chosen.cost))
      chosen.push_back(&f);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    out.push_back(step_of_laws(
        o, chosen.size() > 1 ? fmt::format("laws {}", i + 1) : "laws", chosen[i]->alternatives,
        std::isnan(chosen[i]->chosen.fraction) ? nullptr : &chosen[i]->chosen));
  if (d.effects.empty())
    out.push_back(step_of_laws(o, "laws", d.rejected, nullptr));
  else
    out.push_back({"model", {}, {d.ratio_after}});
  std::erase_if(out, [](const Step& s) { return s.tried.empty() && s.kept.empty(); });
  return out;
}

/// Returns "linear 30; places 1.02 to 29; ...".
std::string told(const std::vector<Step>& steps) {
  std::string out;
  for (const Step& s : steps) {
    std::vector<double> all = s.tried;
    all.insert(all.end(), s.kept.begin(), s.kept.end());
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    out += fmt::format("{}{} {:.3g}", out.empty() ? "" : "; ", s.name, *low);
    if (*high > *low) out += fmt::format(" to {:.3g}", *high);
  }
  return out + ".";
}

}  // namespace

std::string search_section(const DiagnoseOutput& o) {
  const std::vector<Step> steps = steps_of(o);
  if (o.diagnosis.map.empty() || steps.size() < 3) return "";
  SvgAxis names{""};
  SvgSeries tried{"tried", kTried, SvgMark::rings, {}, {}},
      kept{"kept", kKept, SvgMark::dots, {}, {}};
  const auto add = [&](const std::vector<double>& left, SvgSeries& to) {
    const auto x = static_cast<double>(names.categories.size());
    to.x.insert(to.x.end(), left.size(), x);
    to.y.insert(to.y.end(), left.begin(), left.end());
  };
  for (const Step& s : steps) {
    names.categories.push_back(s.name);
    add(s.tried, tried);
    add(s.kept, kept);
  }
  SvgAxis left{"left unexplained, times noise"};
  left.logarithmic = true;
  SvgPlot plot("what every candidate leaves", names, left, 640, 340);
  plot.add(tried);
  plot.add(kept);
  plot.add_rule(1);
  plot.describe("Left unexplained, times noise: " + told(steps));
  return "<h2>Search</h2>\n" +
         html_figure(
             {plot.svg()},
             "From left to right: the linear model, an arbitrary force at each place, the "
             "laws that were fitted for each effect, and the model with all effects. At the "
             "line only the sensors' noise is left.");
}

}  // namespace framewatch::daemon
