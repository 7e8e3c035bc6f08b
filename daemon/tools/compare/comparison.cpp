// SPDX-License-Identifier: MIT
#include "daemon/tools/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/words.h"
#include "estimator/modes/mode_shapes.h"
#include "estimator/numeric/nan.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {
namespace {

constexpr double kSameLength = 1e-6;  // relative
constexpr std::size_t kMaxNamedElements = 3;
constexpr double kKnownFrequency = 0.05;  // relative standard error of a difference
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

Difference difference(const estimator::WindowMean& first, const estimator::WindowMean& later) {
  if (!std::isfinite(first.value) || !std::isfinite(later.value) || first.value == 0)
    return {estimator::kNaN, estimator::kNaN};
  return {later.value / first.value - 1, estimator::ratio_error(first, later)};
}

/// Judges a difference by its least relative size, and by that in standard errors.
Difference judged(Difference d, double least, double errors) {
  d.judged = errors * d.std_error < 2 * least;
  d.different = std::abs(d.ratio) >= least && d.errors() >= errors;
  return d;
}

std::vector<Difference> parameter_differences(const ComparedRun& first, const ComparedRun& later,
                                              const DifferenceLimits& limits) {
  std::vector<Difference> out;
  for (std::size_t p = 0; p < first.values.size(); ++p) {
    const int kind = first.table().kind[p];
    const Difference d = difference(first.values[p], later.values[p]);
    out.push_back(is_stiffness_kind(kind) ? judged(d, limits.least(kind), limits.errors) : d);
  }
  return out;
}

std::vector<ModeDifference> mode_differences(const RunModes& first, const RunModes& later,
                                             const DifferenceLimits& limits) {
  const auto as = compared_modes(first.modes), bs = compared_modes(later.modes);
  const std::vector<int> pairs = paired_modes(as, bs);
  const Difference none{estimator::kNaN, estimator::kNaN};
  std::vector<ModeDifference> out;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ModeDifference d{pairs[i], none, none, estimator::kNaN};
    if (d.later >= 0) {
      const estimator::NaturalMode &a = first.modes[i].natural,
                                   &b = later.modes[static_cast<std::size_t>(d.later)].natural;
      d.frequency = judged(difference({a.frequency_hz, a.frequency_error_hz, 1},
                                      {b.frequency_hz, b.frequency_error_hz, 1}),
                           limits.least_frequency(), limits.errors);
      d.damping =
          difference({a.damping_ratio, a.damping_error, 1}, {b.damping_ratio, b.damping_error, 1});
      d.mac = estimator::mac(as, static_cast<int>(i), bs, d.later);
    }
    out.push_back(d);
  }
  return out;
}

std::vector<Difference> drift_differences(const ComparedRun& first, const ComparedRun& later) {
  std::vector<Difference> out;
  if (first.report.drifts)
    for (const estimator::StoryDrift& d : first.report.drifts->drifts)
      out.push_back(difference(drift_mm(first, d.story), drift_mm(later, d.story)));
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
  for (std::size_t i = 0; i < first.transfer().size(); ++i)
    for (std::size_t j = 0; j < later.transfer().size(); ++j) {
      const TransferFunction &a = first.transfer()[i], &b = later.transfer()[j];
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
  for (const ComparedRun& run : runs) {
    if (!run.report.motion)
      out.push_back(
          fmt::format("{} is a {}: it has no samples, so no drifts and no transfer "
                      "functions.",
                      run.name, run.what));
    else if (run.transfer().empty())
      out.push_back(
          fmt::format("{} has no transfer function: it needs 8 s of forced vibration without "
                      "missing samples, and channels at base and top.",
                      run.name));
    if (!run.modes.none.empty())
      out.push_back(fmt::format("{} has no modes: {}.", run.name, run.modes.none));
  }
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
  const bool other_modes =
      std::any_of(c.modes[later].begin(), c.modes[later].end(),
                  [](const ModeDifference& d) { return d.frequency.different; });
  if (found.empty() && judged == 0)
    return fmt::format("{}: no stiffness is known well enough in both.",
                       other_modes
                           ? fmt::format("{} differs from {} in frequency", name, first)
                           : fmt::format("It is unknown whether {} differs from {}", name, first));
  if (found.empty())
    return fmt::format(
        "{} {} from {}: {} of {} frames and floor panels could be "
        "judged and have the same stiffness{}.",
        name, other_modes ? "differs in frequency" : "does not differ", first, judged, stiffnesses,
        shows > 0 ? fmt::format("; {:.1f} % of a frame would have shown", 100 * shows) : "");
  std::string out = fmt::format("{} differs from {}: ", name, first);
  for (std::size_t i = 0; i < std::min(found.size(), kMaxNamedElements); ++i)
    out += (i == 0 ? "" : "; ") + difference_words(c, later, found[i]);
  if (found.size() > kMaxNamedElements)
    out += fmt::format("; and {} more", found.size() - kMaxNamedElements);
  return out + ".";
}

/// Returns "mode 1 (x, 2.100 Hz) is 2.1 % (+-0.1 %) lower, 20 standard errors".
std::string mode_words(const Comparison& c, std::size_t later, std::size_t mode) {
  const Difference& d = c.modes[later][mode].frequency;
  const estimator::NaturalMode& natural = c.runs.front().modes.modes[mode].natural;
  const double errors = d.errors();
  return fmt::format("mode {} ({}, {:.4g} Hz) is {:.1f} % (+-{:.1f} %) {}{}", mode + 1,
                     motion_words(natural), natural.frequency_hz, 100 * std::abs(d.ratio),
                     std::ceil(1000 * d.std_error) / 10, d.ratio < 0 ? "lower" : "higher",
                     std::isfinite(errors) ? fmt::format(", {:.0f} standard errors", errors) : "");
}

/// Returns the sentence about natural frequencies.
std::string frequency_verdict(const Comparison& c, std::size_t later) {
  const std::string &first = c.runs.front().name, &name = c.runs[later + 1].name;
  std::vector<std::string> found;
  std::size_t judged = 0;
  double shows = 0;
  for (std::size_t mode = 0; mode < c.modes[later].size(); ++mode) {
    const Difference& d = c.modes[later][mode].frequency;
    if (d.different) found.push_back(mode_words(c, later, mode));
    if (!d.judged) continue;
    ++judged;
    shows = std::max({shows, c.limits.least_frequency(), c.limits.errors * d.std_error});
  }
  if (!found.empty())
    return fmt::format("Natural frequencies of {} against {}: {}.", name, first,
                       listed(found, kMaxNamedElements));
  if (judged == 0)
    return fmt::format("No natural frequency is known well enough in both {} and {}.", first, name);
  return fmt::format(
      "{} natural frequencies of {} could be judged and are those of {}; {:.1f} % would have "
      "shown.",
      judged, name, first, 100 * shows);
}

}  // namespace

double DifferenceLimits::least_frequency() const {
  return least(static_cast<int>(estimator::ParameterKind::frame_stiffness)) / 2;
}

double DifferenceLimits::least(int kind) const {
  const estimator::WatchOptions usual;
  return ratio > 0 ? ratio : is_panel(kind) ? usual.least_change_g : usual.least_change_k;
}

double Difference::errors() const {
  if (!std::isfinite(ratio)) return estimator::kNaN;
  return ratio == 0 ? 0 : std::abs(ratio) / std_error;
}

bool Comparison::different() const {
  for (std::size_t r = 0; r < differences.size(); ++r)
    if (std::any_of(differences[r].begin(), differences[r].end(),
                    [](const Difference& d) { return d.different; }) ||
        std::any_of(modes[r].begin(), modes[r].end(),
                    [](const ModeDifference& d) { return d.frequency.different; }))
      return true;
  return false;
}

std::vector<std::size_t> Comparison::known_modes() const {
  std::vector<std::size_t> out;
  const std::vector<RunMode>& first = runs.front().modes.modes;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (std::isfinite(first[i].measured_hz) ||
        std::any_of(modes.begin(), modes.end(), [&](const auto& of_run) {
          return of_run[i].frequency.std_error <= kKnownFrequency;
        }))
      out.push_back(i);
  return out;
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

estimator::WindowMean drift_mm(const ComparedRun& run, int story) {
  if (run.report.drifts)
    for (const estimator::StoryDrift& d : run.report.drifts->drifts)
      if (d.story == story && d.known()) {
        const double mm =
            1e3 *
            run.report.config->pipeline.structure.story_height[static_cast<std::size_t>(story - 1)];
        return {mm * d.ratio, mm * d.std_error, 1};
      }
  return {estimator::kNaN, estimator::kNaN, 0};
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
    out.differences.push_back(parameter_differences(first, later, limits));
    out.modes.push_back(mode_differences(first.modes, later.modes, limits));
    out.drifts.push_back(drift_differences(first, later));
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
  for (std::size_t later = 0; later < c.differences.size(); ++later) {
    out.push_back(verdict_of(c, later));
    if (!c.modes[later].empty() && !c.runs[later + 1].modes.modes.empty())
      out.push_back(frequency_verdict(c, later));
  }
  return out;
}

}  // namespace framewatch::daemon
