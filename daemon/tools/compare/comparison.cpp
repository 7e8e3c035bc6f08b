// SPDX-License-Identifier: MIT
#include "daemon/tools/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "estimator/numeric/nan.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {
namespace {

constexpr double kSameLength = 1e-6;  // relative
constexpr std::size_t kMaxNamedElements = 3;
/// Segments of a Hann window that overlap by half count as so many times fewer independent ones.
constexpr double kOverlap = 1.056;

bool is_panel(int kind) {
  return kind == static_cast<int>(estimator::ParameterKind::panel_stiffness);
}

std::string unlike_lengths(const char* what, const std::vector<double>& a,
                           const std::vector<double>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::abs(a[i] - b[i]) > kSameLength * a[i])
      return fmt::format("{} {} is {:g} m in the first and {:g} m in the second", what, i + 1, a[i],
                         b[i]);
  return "";
}

Difference difference(const estimator::WindowMean& first, const estimator::WindowMean& later,
                      int kind, const DifferenceLimits& limits) {
  Difference out{estimator::kNaN, estimator::kNaN};
  if (!std::isfinite(first.value) || !std::isfinite(later.value) || first.value == 0) return out;
  out.ratio = later.value / first.value - 1;
  out.std_error = estimator::ratio_error(first, later);
  if (!is_stiffness_kind(kind)) return out;
  const double least = limits.least(kind);
  out.judged = limits.errors * out.std_error < 2 * least;
  out.different = std::abs(out.ratio) >= least && out.errors() >= limits.errors;
  return out;
}

/// Returns the values at `x`, between the two neighbors among ascending `xs`; NaN outside.
double between(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const auto after = std::lower_bound(xs.begin(), xs.end(), x - 1e-9);
  if (after == xs.end()) return estimator::kNaN;
  const auto i = static_cast<std::size_t>(after - xs.begin());
  if (i == 0) return std::abs(xs[0] - x) < 1e-9 ? ys[0] : estimator::kNaN;
  const double share = (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
  return ys[i - 1] + share * (ys[i] - ys[i - 1]);
}

std::vector<TransferDifference> transfer_differences(const ComparedRun& first,
                                                     const ComparedRun& later) {
  std::vector<TransferDifference> out;
  for (std::size_t i = 0; i < first.report.transfer.size(); ++i)
    for (std::size_t j = 0; j < later.report.transfer.size(); ++j) {
      const TransferFunction &a = first.report.transfer[i], &b = later.report.transfer[j];
      if (a.direction != b.direction) continue;
      TransferDifference one{i, j, a.frequency_hz, {}};
      for (std::size_t k = 0; k < a.frequency_hz.size(); ++k) {
        const double f = a.frequency_hz[k], h = between(b.frequency_hz, b.measured, f);
        one.errors.push_back(
            (h - a.measured[k]) /
            std::hypot(a.measured[k] * transfer_error(a.coherence[k], a.segments),
                       h * transfer_error(between(b.frequency_hz, b.coherence, f), b.segments)));
      }
      out.push_back(std::move(one));
    }
  return out;
}

std::vector<std::string> missing_notes(const std::vector<ComparedRun>& runs) {
  std::vector<std::string> out;
  for (const ComparedRun& run : runs)
    if (!run.report.motion)
      out.push_back(
          fmt::format("{} is a {}: it has no samples, so no drifts and no transfer "
                      "functions.",
                      run.name, run.what));
  return out;
}

/// Returns a sentence about masses that differ; "" if they are the same or not known.
std::string mass_note(const ComparedRun& a, const ComparedRun& b) {
  if (!a.report.config || !b.report.config) return "";
  const auto &m = a.report.config->pipeline.structure.node_mass,
             &n = b.report.config->pipeline.structure.node_mass;
  for (std::size_t i = 0; i < std::min(m.size(), n.size()); ++i)
    if (std::abs(m[i] - n[i]) > kSameLength * m[i])
      return fmt::format(
          "The masses of {} differ from those of {}: a wrong mass is a wrong stiffness.", b.name,
          a.name);
  return "";
}

/// Returns "north wall (y2) of story 1 has 15.0 % (+-0.2 %) less stiffness, 61 standard errors".
std::string difference_words(const Comparison& c, std::size_t later, std::size_t p) {
  const Difference& d = c.differences[later][p];
  const double errors = d.errors();
  return fmt::format("{} has {:.1f} % (+-{:.1f} %) {} stiffness{}",
                     element_of(c.runs.front().report, p), 100 * std::abs(d.ratio),
                     std::ceil(1000 * d.std_error) / 10, d.ratio < 0 ? "less" : "more",
                     std::isfinite(errors) ? fmt::format(", {:.0f} standard errors", errors) : "");
}

std::string verdict_of(const Comparison& c, std::size_t later) {
  const std::string &first = c.runs.front().name, &name = c.runs[later + 1].name;
  std::vector<std::size_t> found;
  std::size_t judged = 0, stiffnesses = 0;
  double shows = 0;
  for (std::size_t p = 0; p < c.differences[later].size(); ++p) {
    const Difference& d = c.differences[later][p];
    const int kind = c.runs.front().table().kind[p];
    if (!is_stiffness_kind(kind)) continue;
    ++stiffnesses;
    judged += d.judged ? 1 : 0;
    if (d.judged && !is_panel(kind))
      shows = std::max({shows, c.limits.least(kind), c.limits.errors * d.std_error});
    if (d.different) found.push_back(p);
  }
  std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(c.differences[later][a].ratio) > std::abs(c.differences[later][b].ratio);
  });
  if (found.empty() && judged == 0)
    return fmt::format(
        "It is unknown whether {} differs from {}: no stiffness is known well enough in both.",
        name, first);
  if (found.empty())
    return fmt::format(
        "{} does not differ from {}: {} of {} frames and floor panels could be "
        "judged and have the same stiffness{}.",
        name, first, judged, stiffnesses,
        shows > 0 ? fmt::format("; {:.1f} % of a frame would have shown", 100 * shows) : "");
  std::string out = fmt::format("{} differs from {}: ", name, first);
  for (std::size_t i = 0; i < std::min(found.size(), kMaxNamedElements); ++i)
    out += (i == 0 ? "" : "; ") + difference_words(c, later, found[i]);
  if (found.size() > kMaxNamedElements)
    out += fmt::format("; and {} more", found.size() - kMaxNamedElements);
  return out + ".";
}

}  // namespace

double DifferenceLimits::least(int kind) const {
  const estimator::WatchOptions usual;
  return ratio > 0 ? ratio : is_panel(kind) ? usual.least_change_g : usual.least_change_k;
}

double Difference::errors() const {
  if (!std::isfinite(ratio)) return estimator::kNaN;
  return ratio == 0 ? 0 : std::abs(ratio) / std_error;
}

bool Comparison::different() const {
  return std::any_of(differences.begin(), differences.end(), [](const auto& of_run) {
    return std::any_of(of_run.begin(), of_run.end(),
                       [](const Difference& d) { return d.different; });
  });
}

bool Comparison::judged() const {
  return std::all_of(differences.begin(), differences.end(), [](const auto& of_run) {
    return std::any_of(of_run.begin(), of_run.end(), [](const Difference& d) { return d.judged; });
  });
}

std::string why_unlike(const ComparedRun& a, const ComparedRun& b) {
  const parameter_table_t &s = a.table(), &t = b.table();
  if (a.report.config && b.report.config) {
    const estimator::Structure &x = a.report.config->pipeline.structure,
                               &y = b.report.config->pipeline.structure;
    if (x.stories != y.stories)
      return fmt::format("the first has {} stories, the second {}", x.stories, y.stories);
    std::string why = unlike_lengths("the height of story", x.story_height, y.story_height);
    if (why.empty()) why = unlike_lengths("span_x_m", x.span_x, y.span_x);
    if (why.empty()) why = unlike_lengths("span_y_m", x.span_y, y.span_y);
    if (!why.empty()) return why;
  }
  if (s.name == t.name) return "";
  const std::set<std::string> of_a(s.name.begin(), s.name.end()),
      of_b(t.name.begin(), t.name.end());
  const auto lacking = [&](const std::vector<std::string>& names,
                           const std::set<std::string>& others, const char* which,
                           const char* other) -> std::string {
    for (const std::string& name : names)
      if (!others.contains(name))
        return fmt::format("the {} has {} ({}), the {} has not", which, place_words(name), name,
                           other);
    return "";
  };
  std::string why = lacking(s.name, of_b, "first", "second");
  if (why.empty()) why = lacking(t.name, of_a, "second", "first");
  if (!why.empty()) return why;
  return "the parameters have another order";
}

double transfer_error(double coherence, int segments) {
  const double independent = segments / kOverlap;
  if (segments < 2 || !(coherence > 0)) return estimator::kNaN;
  return std::sqrt(std::max(0.0, 1 - coherence) / (2 * coherence * (independent - 1)));
}

Comparison compare_runs(std::vector<ComparedRun> runs, const DifferenceLimits& limits) {
  Comparison out;
  out.runs = std::move(runs);
  out.limits = limits;
  for (const ComparedRun& run : out.runs)
    if (out.runs.front().report.labels.empty()) out.runs.front().report.labels = run.report.labels;
  const ComparedRun& first = out.runs.front();
  for (std::size_t r = 1; r < out.runs.size(); ++r) {
    const ComparedRun& later = out.runs[r];
    std::vector<Difference> differences;
    for (std::size_t p = 0; p < first.values.size(); ++p)
      differences.push_back(
          difference(first.values[p], later.values[p], first.table().kind[p], limits));
    out.differences.push_back(std::move(differences));
    out.transfer.push_back(transfer_differences(first, later));
    if (const std::string note = mass_note(first, later); !note.empty()) out.notes.push_back(note);
  }
  for (const ComparedRun& run : out.runs)
    out.notes.insert(out.notes.end(), run.notes.begin(), run.notes.end());
  for (std::string& note : missing_notes(out.runs)) out.notes.push_back(std::move(note));
  return out;
}

std::vector<std::string> verdict_sentences(const Comparison& c) {
  std::vector<std::string> out;
  for (std::size_t later = 0; later < c.differences.size(); ++later)
    out.push_back(verdict_of(c, later));
  return out;
}

}  // namespace framewatch::daemon
