#include "daemon/tools/diagnosis/kind_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"

namespace framewatch::daemon {
namespace {

constexpr Eigen::Index kLoopPoints = 4000;

/// In the order of estimator::LawKind.
constexpr std::array kKindWords = {
    "a linear element's",
    "elastic: it follows the deformation, and what was stored comes back",
    "an impact's: it follows the deformation from a clearance on",
    "dissipative: it follows the rate of the deformation",
    "hysteretic: it follows the deformation and its past",
    "that of a stiffness which changes with time",
    "of no kind that follows the motion there",
};
static_assert(kKindWords.size() == static_cast<std::size_t>(estimator::LawKind::external) + 1);

/// The place whose kind was looked at; null: none, or nothing beyond a linear element.
const estimator::WhereEntry* of_kind(const DiagnoseOutput& o) {
  for (const estimator::WhereEntry& w : o.diagnosis.where)
    if (w.kind) return w.kind->kind == estimator::LawKind::linear ? nullptr : &w;
  return nullptr;
}

std::string loop(const estimator::KindOfLaw& kind) {
  std::vector<double> d, force;
  const Eigen::Index stride = std::max<Eigen::Index>(1, kind.d_m.size() / kLoopPoints);
  for (Eigen::Index i = 0; i < kind.d_m.size(); i += stride) {
    d.push_back(kind.d_m[i]);
    force.push_back(kind.force_n[i]);
  }
  SvgPlot plot("force beyond a linear element, strongest record", {"deformation, m"}, {"force, N"});
  plot.add({"", 0, SvgMark::thin_line, d, force});
  return plot.svg();
}

/// Means of the surface along one of its sides: of all samples, and of those in the middle third of
/// the other side.
std::string means(const estimator::RestoringSurface& surface, bool over_deformation) {
  const Eigen::VectorXd& at = over_deformation ? surface.d_m : surface.v_mps;
  const Eigen::Index others = over_deformation ? surface.v_mps.size() : surface.d_m.size();
  SvgSeries all{"all samples", 1, SvgMark::dots, {}, {}};
  SvgSeries middle{
      over_deformation ? "at a low rate" : "at a small deformation", 0, SvgMark::line, {}, {}};
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    double sum = 0, count = 0, inner_sum = 0, inner_count = 0;
    for (Eigen::Index j = 0; j < others; ++j) {
      const double force = over_deformation ? surface.force_n(i, j) : surface.force_n(j, i);
      const double n = over_deformation ? surface.count(i, j) : surface.count(j, i);
      if (!std::isfinite(force)) continue;
      sum += n * force;
      count += n;
      if (j < others / 3 || j >= others - others / 3) continue;
      inner_sum += n * force;
      inner_count += n;
    }
    if (count > 0) {
      all.x.push_back(at[i]);
      all.y.push_back(sum / count);
    }
    if (inner_count > 0) {
      middle.x.push_back(at[i]);
      middle.y.push_back(inner_sum / inner_count);
    }
  }
  SvgPlot plot(over_deformation ? "mean force over deformation" : "mean force over rate",
               {over_deformation ? "deformation, m" : "rate, m/s"}, {"force, N"});
  plot.add(all);
  plot.add(middle);
  return plot.svg();
}

}  // namespace

std::string kind_sentence(const DiagnoseOutput& o) {
  const estimator::WhereEntry* where = of_kind(o);
  if (!where) return "";
  const auto index = static_cast<std::size_t>(where->kind->kind);
  std::string out =
      fmt::format("What {} needs beyond a spring and a dashpot is {}",
                  place_text(where->place, o.plant.structure, o.plant.axes), kKindWords[index]);
  if (where->kind->kind != estimator::LawKind::external)
    out += fmt::format(" (that explains {:.0f} % of it)", 100 * where->kind->share[index]);
  return out + ".";
}

std::string kind_section(const DiagnoseOutput& o) {
  const estimator::WhereEntry* where = of_kind(o);
  if (!where) return "";
  std::vector<std::vector<std::string>> rows;
  for (const estimator::LawKind kind :
       {estimator::LawKind::elastic, estimator::LawKind::impact, estimator::LawKind::dissipative,
        estimator::LawKind::hysteretic, estimator::LawKind::time_varying}) {
    std::string word = law_kind_word(kind);
    std::replace(word.begin(), word.end(), '_', ' ');
    rows.push_back(
        {word, fmt::format("{:.0f} %", 100 * where->kind->share[static_cast<std::size_t>(kind)])});
  }
  const estimator::KindOfLaw& kind = *where->kind;
  return "<h2>What sort of force</h2>\n<p>" + html_text(kind_sentence(o)) +
         " General functions of each kind, fitted to the force that this place alone would need, "
         "explain of it beyond noise:</p>\n" +
         html_table({"kind", "explains"}, rows) +
         html_figure({loop(kind), means(kind.surface, true), means(kind.surface, false)},
                     "The force that the place needs beyond a spring and a dashpot, whatever its "
                     "law: closed loops dissipate, a single curve is elastic, a step at rate zero "
                     "is friction.");
}

}  // namespace framewatch::daemon
