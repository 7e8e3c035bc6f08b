// SPDX-License-Identifier: MIT
#include "tests/earthquake/change_tables.h"

#include <cmath>
#include <functional>
#include <utility>

#include <fmt/core.h>

#include "estimator/numeric/quantile.h"
#include "tests/earthquake/coverage.h"

namespace framewatch::earthquake {
namespace {

constexpr double kMinCoverage = 0.92, kMaxCoverage = 0.99, kMaxNeighbours = 0.01;
constexpr double kMaxMoved =
    0.05;  // share of elements whose size differs by more than two earlier errors

struct Line {
  std::string title;
  std::function<bool(const ChangeCase&, const ElementScore&)> chosen;
};

bool apart(const ChangeCase& c) {
  return c.losses.size() == 2 && c.losses[0].at_s < c.losses[1].at_s;
}

std::vector<Line> lines() {
  std::vector<Line> out;
  const auto of_case = [&](const std::string& title, bool (*chosen)(const ChangeCase&)) {
    out.push_back({title, [=](const ChangeCase& c, const ElementScore&) { return chosen(c); }});
  };
  of_case("**all**", [](const ChangeCase&) { return true; });
  of_case("in strong motion", [](const ChangeCase& c) { return !c.between; });
  of_case("between two motions", [](const ChangeCase& c) { return c.between; });
  of_case("every story measured", [](const ChangeCase& c) { return !c.grouped(); });
  of_case("groups of stories", [](const ChangeCase& c) { return c.grouped(); });
  of_case("masses and profiles right", [](const ChangeCase& c) { return !c.model_error; });
  of_case("masses and profiles off", [](const ChangeCase& c) { return c.model_error; });
  of_case("linear", [](const ChangeCase& c) { return !c.softens(); });
  of_case("softens slowly", [](const ChangeCase& c) { return c.softening == Softening::slow; });
  of_case("slips", [](const ChangeCase& c) { return c.softening == Softening::slipping; });
  of_case("as strong as learned", [](const ChangeCase& c) { return !c.loud; });
  of_case("2.5 times as strong", [](const ChangeCase& c) { return c.loud; });
  of_case("one element", [](const ChangeCase& c) { return c.losses.size() == 1; });
  of_case("two at once", [](const ChangeCase& c) { return c.losses.size() == 2 && !apart(c); });
  of_case("two, 2 to 8 s apart", [](const ChangeCase& c) { return apart(c); });
  for (const auto& [least, most] : {std::pair{0.0, 0.05}, {0.05, 0.1}, {0.1, 0.2}, {0.2, 1.0}})
    out.push_back({most < 1 ? fmt::format("element lost {:g} to {:g} %", 100 * least, 100 * most)
                            : fmt::format("element lost more than {:g} %", 100 * least),
                   [l = least, m = most](const ChangeCase&, const ElementScore& e) {
                     return -e.truth >= l && -e.truth < m;
                   }});
  return out;
}

std::string percent(double ratio, int digits = 1) {
  return std::isnan(ratio) ? "-" : fmt::format("{:.{}f} %", 100 * ratio, digits);
}

std::string with_error(const Coverage& c) {
  if (c.count() == 0) return "-";
  return fmt::format("{:.1f} ± {:.1f} %", 100 * c.ratio(), 100 * c.std_error());
}

std::string seconds(double s) {
  return std::isfinite(s) ? fmt::format("{:.2f}", s) : "never";
}

struct Scores {
  const std::vector<ScoredCase>& cases;

  /// Calls function(index of the case, case, element) for every changed element of a line.
  template <typename Function>
  void each(ChangeKind kind, const Line& line, const Function& function) const {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (cases[i].of.kind != kind) continue;
      for (const ElementScore& e : cases[i].score.changed)
        if (line.chosen(cases[i].of, e)) function(static_cast<int>(i), cases[i], e);
    }
  }
  Coverage coverage(const Line& line, std::size_t at) const {
    Coverage out;
    each(ChangeKind::loss, line, [&](int i, const ScoredCase&, const ElementScore& e) {
      const Shown& s = e.shown[at];
      if (s.there && s.sized) out.add(i, s.error, s.std_error, 0);
    });
    return out;
  }
};

std::string found_table(const Scores& scores) {
  std::string out =
      "| | elements | announced | median s | 90 % s | times | withdrawn at the end | false "
      "neighbours |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Line& line : lines()) {
    std::vector<double> delays;
    int found = 0, said = 0, withdrawn = 0, unchanged = 0, neighbours = 0, last = -1;
    scores.each(ChangeKind::loss, line, [&](int i, const ScoredCase& c, const ElementScore& e) {
      delays.push_back(e.delay_s);
      found += e.said > 0 ? 1 : 0;
      said += e.said;
      withdrawn += e.shown.back().withdrawn ? 1 : 0;
      if (std::exchange(last, i) == i) return;
      unchanged += c.score.unchanged, neighbours += c.score.neighbours;
    });
    if (delays.empty()) continue;
    out += fmt::format(
        "| {} | {} | {} | {} | {} | {:.1f} | {} | {} of {}, {} |\n", line.title, delays.size(),
        percent(found / static_cast<double>(delays.size()), 0),
        seconds(estimator::quantile(delays, 0.5)), seconds(estimator::quantile(delays, 0.9)),
        found > 0 ? said / static_cast<double>(found) : 0.0, withdrawn, neighbours, unchanged,
        percent(unchanged > 0 ? neighbours / static_cast<double>(unchanged) : NAN));
  }
  return out;
}

std::string time_name(double s) {
  return std::isinf(s) ? "end" : fmt::format("{:g} s", s);
}

std::string sizes_table(const Scores& scores) {
  std::string out =
      "| after | sized | withdrawn | without a size | holds | median of \\|error\\| | median "
      "stated "
      "| rms of error / stated |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  const Line all = lines().front();
  for (std::size_t t = 0; t < kAfter_s.size(); ++t) {
    int withdrawn = 0, unsized = 0;
    std::vector<double> errors, stated;
    scores.each(ChangeKind::loss, all, [&](int, const ScoredCase&, const ElementScore& e) {
      const Shown& s = e.shown[t];
      if (!s.there) return;
      withdrawn += s.withdrawn ? 1 : 0;
      unsized += !s.withdrawn && !s.sized ? 1 : 0;
      if (!s.sized) return;
      errors.push_back(std::abs(s.error)), stated.push_back(s.std_error);
    });
    const Coverage c = scores.coverage(all, t);
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.2f} |\n", time_name(kAfter_s[t]),
                       errors.size(), withdrawn, unsized, with_error(c),
                       percent(estimator::quantile(errors, 0.5), 2),
                       percent(estimator::quantile(stated, 0.5), 2), c.rms_of_errors());
  }
  return out;
}

std::string coverage_table(const Scores& scores) {
  std::string out = "| |";
  for (const double s : kAfter_s) out += " " + time_name(s) + " |";
  out += "\n| --- |";
  for (std::size_t i = 0; i < kAfter_s.size(); ++i) out += " --- |";
  out += "\n";
  for (const Line& line : lines()) {
    out += "| " + line.title + " |";
    for (std::size_t t = 0; t < kAfter_s.size(); ++t)
      out += " " + percent(scores.coverage(line, t).ratio(), 0) + " |";
    out += "\n";
  }
  return out;
}

struct Steadiness {
  int elements = 0, steady = 0, grew = 0, several = 0;
  double pairs = 0, within = 0;
  Coverage said;
};

Steadiness steadiness(const Scores& scores, const Line& line) {
  Steadiness out;
  scores.each(ChangeKind::loss, line, [&](int i, const ScoredCase&, const ElementScore& e) {
    for (const Shown& s : e.sizes) out.said.add(i, s.error, s.std_error, 0);
    if (e.sizes.empty()) return;
    ++out.elements;
    out.steady += e.pairs == e.pairs_within ? 1 : 0;
    out.grew += e.error_grew ? 1 : 0;
    out.several += e.sizes.size() > 1 ? 1 : 0;
    out.pairs += e.pairs, out.within += e.pairs_within;
  });
  return out;
}

std::string steadiness_text(const Scores& scores) {
  const Steadiness s = steadiness(scores, lines().front());
  const auto share = [&](int count) {
    return percent(s.elements > 0 ? count / static_cast<double>(s.elements) : NAN);
  };
  return fmt::format(
      "Of {} elements with an announced size, {} were announced with several. All later sizes stay "
      "within two of every earlier error for {}; of pairs of an earlier and a later size {} do. A "
      "later stated error is larger than an earlier one for {}. Of all sizes that were ever "
      "announced the stated 95 % interval holds the truth for {} ({:.0f} sizes).\n",
      s.elements, s.several, share(s.steady), percent(s.pairs > 0 ? s.within / s.pairs : NAN),
      share(s.grew), with_error(s.said), s.said.count());
}

std::string cases_table(const std::vector<ScoredCase>& cases) {
  std::string out =
      "| | cases | announcements a case | elements named before a change | false neighbours | "
      "still "
      "named at the end | elements with a gain | about the whole building | without a baseline |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  const char* titles[] = {"a loss", "nothing changes", "all lose 5 %"};
  for (const ChangeKind kind : {ChangeKind::loss, ChangeKind::none, ChangeKind::uniform}) {
    int count = 0, said = 0, early = 0, neighbours = 0, standing = 0, gains = 0, whole = 0,
        unlearned = 0;
    for (const ScoredCase& c : cases) {
      if (c.of.kind != kind) continue;
      ++count;
      said += c.score.said, early += c.score.early, neighbours += c.score.neighbours;
      standing += c.score.standing, gains += c.score.gains, whole += c.score.whole;
      unlearned += c.score.unlearned;
    }
    if (count == 0) continue;
    out += fmt::format("| {} | {} | {:.2f} | {} | {} | {} | {} | {} | {} |\n",
                       titles[static_cast<int>(kind)], count, said / static_cast<double>(count),
                       early, neighbours, standing, gains, whole, unlearned);
  }
  return out;
}

}  // namespace

std::string change_tables(const std::vector<ScoredCase>& cases) {
  const Scores scores{cases};
  return "Changed elements and when they are announced; seconds since the change can be seen, "
         "which "
         "is when motion begins again for a change between two motions.\n\n" +
         found_table(scores) +
         "\nThe size that is shown at a time after the first announcement of its element, in % of "
         "the stiffness; *holds*: share of stated 95 % intervals that hold the truth.\n\n" +
         sizes_table(scores) + "\n" + steadiness_text(scores) +
         "\nShare of stated 95 % intervals that hold the truth, by kind of case.\n\n" +
         coverage_table(scores) + "\nBy case.\n\n" + cases_table(cases);
}

std::vector<Demand> change_demands(const std::vector<ScoredCase>& cases, double most_delay_s) {
  const Scores scores{cases};
  const Line all = lines().front();
  std::vector<Demand> out;
  for (std::size_t t = 0; t < kAfter_s.size(); ++t) {
    const Coverage c = scores.coverage(all, t);
    if (c.count() > 0)
      out.push_back(
          {fmt::format("{} after: {} hold the truth", time_name(kAfter_s[t]), with_error(c)),
           c.ratio() >= kMinCoverage && c.ratio() <= kMaxCoverage});
  }
  int unchanged = 0, neighbours = 0;
  std::vector<double> delays;
  for (const ScoredCase& c : cases) {
    if (c.of.kind != ChangeKind::loss) continue;
    unchanged += c.score.unchanged, neighbours += c.score.neighbours;
    for (const ElementScore& e : c.score.changed) delays.push_back(e.delay_s);
  }
  out.push_back({fmt::format("false neighbours: {} of {}", neighbours, unchanged),
                 neighbours < kMaxNeighbours * unchanged});
  const Steadiness s = steadiness(scores, all);
  out.push_back({fmt::format("sizes that stay within two earlier errors: {} of {} elements",
                             s.steady, s.elements),
                 s.elements > 0 && s.elements - s.steady <= kMaxMoved * s.elements});
  const double median_s = estimator::quantile(delays, 0.5);
  if (std::isfinite(most_delay_s))
    out.push_back({fmt::format("median time to the first announcement {} s, {:.2f} s at most",
                               seconds(median_s), most_delay_s),
                   median_s <= most_delay_s});
  return out;
}

}  // namespace framewatch::earthquake
