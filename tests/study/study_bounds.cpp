// SPDX-License-Identifier: MIT
#include <functional>
#include <utility>

#include <fmt/core.h>

#include "estimator/numeric/quantile.h"
#include "tests/study/study_score.h"

namespace framewatch::study {
namespace {

using Holds = std::function<bool(const Outcome&)>;

class Bounds {
 public:
  explicit Bounds(const std::vector<Outcome>& outcomes) : outcomes_(outcomes) {}

  /// Adds a bound on the share of a group for which something holds, at least or at most.
  void share(const std::string& what, const Holds& of, const Holds& holds, double limit,
             bool at_least = true) {
    int all = 0, good = 0;
    for (const Outcome& o : outcomes_)
      if (of(o)) {
        ++all;
        good += holds(o);
      }
    if (all == 0) return;
    const double measured = static_cast<double>(good) / all;
    add(what, limit, at_least, measured,
        fmt::format("{} of {} ({:.1f} %)", good, all, 100 * measured));
  }

  void median(const std::string& what, std::vector<double> values, double limit, bool at_least) {
    if (values.empty()) return;
    const double measured = estimator::upper_median(values);
    add(what, limit, at_least, measured, fmt::format("{:.1f} %", 100 * measured));
  }

  std::vector<Bound> out() && { return std::move(out_); }

 private:
  void add(const std::string& what, double limit, bool at_least, double measured,
           const std::string& text) {
    out_.push_back({what, fmt::format("{} {:g} %", at_least ? "at least" : "at most", 100 * limit),
                    text, at_least ? measured >= limit : measured <= limit});
  }

  const std::vector<Outcome>& outcomes_;
  std::vector<Bound> out_;
};

Holds of_group(const std::string& group) {
  return [group](const Outcome& o) { return o.group == group; };
}

}  // namespace

std::vector<Bound> bounds_of(const std::vector<Outcome>& outcomes) {
  Bounds out(outcomes);
  const auto right = [](const Outcome& o) { return o.all_right(); };
  const auto placed = [](const Outcome& o) { return o.places_right == o.truths; };
  const auto wrong = [](const Outcome& o) { return o.confidently_wrong; };
  for (const auto& [building, limit] :
       {std::pair("2story_1x1", 0.97), {"2story_3x3", 0.95}, {"5story_1x1", 0.95}})
    out.share(
        fmt::format("one effect, {}: name and place", building),
        [&](const Outcome& o) { return o.group == "catalogue" && o.building == building; }, right,
        limit);
  out.share("a law of another form: name and place", of_group("other_form"), right, 0.9);
  out.share(
      "a law of another form: kind and place", of_group("other_form"),
      [](const Outcome& o) { return o.kind_and_place(); }, 0.9);
  out.share("a law of another form: place", of_group("other_form"), placed, 0.92);
  out.share("a law of another form: confidently wrong", of_group("other_form"), wrong, 0, false);
  for (const char* group : {"catalogue", "two_effects", "practice"})
    out.share(fmt::format("{}: confidently wrong", group), of_group(group), wrong, 0.01, false);
  out.share("practice: name and place", of_group("practice"), right, 0.9);
  out.share("not in the catalogue: confidently wrong", of_group("outside"), wrong, 0.1, false);
  out.share(
      "nothing hidden: `adequate`", of_group("nothing"),
      [](const Outcome& o) { return o.verdict == "adequate"; }, 0.99);
  out.share("effect taken from the catalogue: confidently wrong", of_group(kTakenOut), wrong, 0.1,
            false);
  for (const char* group : {"outside", kTakenOut})
    out.share(
        fmt::format("{}: no wrong name", group), of_group(group),
        [](const Outcome& o) { return o.no_wrong_name(); }, 0.9);
  out.share("two effects: both", of_group("two_effects"), right, 0.85);
  out.share("three effects: all", of_group("three_effects"), right, 0.6);
  std::vector<double> removed, errors;
  for (const Outcome& o : outcomes) {
    if (o.group != "catalogue") continue;
    if (const auto share = o.removed()) removed.push_back(*share);
    errors.insert(errors.end(), o.parameter_errors.begin(), o.parameter_errors.end());
  }
  out.median("one effect: held-out excess removed, median", removed, 0.95, true);
  out.median("one effect: error of its parameters, median", errors, 0.1, false);
  return std::move(out).out();
}

}  // namespace framewatch::study
