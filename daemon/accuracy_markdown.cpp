#include <fmt/core.h>

#include "daemon/percent.h"
#include "daemon/reproduction_report.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kKinds[] = {"k", "G", "c"};
using Rows = std::vector<const AccuracyRow*>;

std::string row(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += " " + cell + " |";
  return out + "\n";
}

std::string table(const std::vector<std::string>& head) {
  return row(head) + row(std::vector<std::string>(head.size(), "---"));
}

std::string introduction(int seeds) {
  return fmt::format(
      "# Accuracy\n\n"
      "Made by `framewatch reproduce --seeds {} --out DIR`; do not edit. What the estimator "
      "reaches, "
      "what\nnobody can reach, and how to measure it again. Buildings: the paper's Table 1 (5 "
      "stories, 1x1 bay, 50\nparameters) and Table 2 (2 stories, 3x3 bays, 68 parameters) with "
      "flexible (2b), basic (2c) and stiff (2d)\nfloors. Seed i is one artificial ground motion "
      "(Kanai-Tajimi, 15 s, 45 degrees), one draw of noise and one\ndesign, off by up to 10 % in k "
      "and 30 % in G and c. Motion is the exact response (first-order hold at\n1 ms, band-limited, "
      "decimated to 100 Hz), not the estimator's own scheme. Noise is white on every\n"
      "accelerometer, in per cent of that channel's rms. Windows are 5 s long and end at 10, 11, "
      ".. "
      "15 s.\n\n",
      seeds);
}

std::string with_noise(const Rows& rows, int seeds) {
  std::string out = fmt::format(
      "## With noise\n\n"
      "Median of |relative error| over parameters, windows and {} motions. *Least*: what the "
      "Cramer-Rao bound\nleaves to any unbiased estimator, 0.6745 times its standard deviation. "
      "*Must*: the limit that is held to.\n*Unaware*: framewatch when the sensors' noise is not "
      "configured. *Paper*: the paper's equations on the same\naccelerations, integrated behind a "
      "0.1-Hz high-pass. *Example*: as the paper does it, 10 s with\nindependent noise on "
      "accelerations, velocities and displacements; *denoised*: behind its singular value\n"
      "decomposition (p = 200, q = 5, s(r) >= 0.98).\n\n",
      seeds);
  out += table({"case", "", "least", "framewatch", "must", "times least", "unaware", "paper",
                "example", "denoised"});
  const std::vector<AccuracyCase> cases = accuracy_cases();
  for (const AccuracyRow* r : rows)
    for (int kind = 0; kind < 3; ++kind) {
      std::string must = "-";
      for (const AccuracyCase& c : cases)
        if (c.name == r->name) must = percent(c.limit[static_cast<std::size_t>(kind)]);
      const double ours = r->of(Method::matched, kind).quantile(0.5);
      out += row({kind == 0 ? r->name : "", kKinds[kind], percent(r->least_median(kind)),
                  "**" + percent(ours) + "**", must,
                  fmt::format("{:.2f}", ours / r->least_median(kind)),
                  percent(r->of(Method::matched_unaware, kind).quantile(0.5)),
                  percent(r->of(Method::paper_accel, kind).quantile(0.5)),
                  percent(r->of(Method::paper_example, kind).quantile(0.5)),
                  percent(r->of(Method::paper_denoised, kind).quantile(0.5))});
    }
  return out +
         "\nBelow 1 times the least is not magic: where the window says little, prior and design "
         "say the rest, and the\npublished error counts how far they can pull. *Random buildings*: "
         "one to six stories, one to four frames\neach way, all drawn by seed.\n\n";
}

std::string intervals(const Rows& rows) {
  std::string out =
      "## Published errors\n\n"
      "Share of parameters that are published, and of these the share whose nominal 95 % interval "
      "(value plus and\nminus 2.093 standard errors: Student's t, 19 degrees of freedom) holds the "
      "truth. 90 to 98 % is demanded.\n\n";
  out += table({"case", "k published", "holds", "G published", "holds", "c published", "holds",
                "unaware: k", "G", "c hold"});
  for (const AccuracyRow* r : rows) {
    std::vector<std::string> cells{r->name};
    for (int kind = 0; kind < 3; ++kind) {
      cells.push_back(percent(r->of(Method::matched, kind).published_ratio()));
      cells.push_back(percent_1(r->of(Method::matched, kind).coverage_ratio()));
    }
    for (int kind = 0; kind < 3; ++kind)
      cells.push_back(percent_1(r->of(Method::matched_unaware, kind).coverage_ratio()));
    out += row(cells);
  }
  return out +
         "\nStandard errors are batch means over 20 blocks of a quarter of a second, times 1.1, "
         "plus the pull of prior\nand noise toward a design off by up to its tolerance "
         "([equations](equations.md), 21).\n\n";
}

std::string exact_motion(const Reproduction& all) {
  std::string out =
      "## Without noise\n\n95th percentile of the relative error over parameters and windows, four "
      "motions. "
      "`tests/identify/accuracy_test.cpp`\nholds El Centro and Hachinohe to 2e-5, 2e-4, 2e-4 and "
      "2e-3.\n\n";
  out += table({"case", "k", "G", "c", "G_c"});
  for (const BuildingReproduction& b : all.buildings) {
    std::vector<std::string> cells{"Table " + b.group.substr(5)};
    for (const ErrorStatistics& kind : b.exact)
      cells.push_back(fmt::format("{:.1e}", kind.quantile(0.95)));
    out += row(cells);
  }
  return out +
         "\nA record sampled without an anti-alias filter is another matter: content above half "
         "the sampling rate folds\ninto the band, and k is then off by up to 1e-3 with the same "
         "motions. No estimator sees that.\n\n";
}

std::string excitation(const Robustness& r) {
  std::string out =
      "## When little moves\n\nThe sensors' noise stays and the motion fades: noise from 0.3 % to "
      "3000 % of the motion's rms, design off\nby up to 20 % in k and 40 % in G and c. Share of "
      "all "
      "k that is published at each level, and, of all that are\npublished, how many are off by "
      "more "
      "than 5 % (k) or 25 % (G, c).\n\n";
  std::vector<std::string> head{"building"};
  for (const ExcitationLevel& level : r.sweeps.front().levels)
    head.push_back(percent(level.noise_ratio));
  for (const char* kind : {"k off", "G off", "c off"}) head.push_back(kind);
  out += table(head);
  for (const ExcitationSweep& sweep : r.sweeps) {
    std::vector<std::string> cells{sweep.name};
    for (const ExcitationLevel& level : sweep.levels)
      cells.push_back(percent(static_cast<double>(level.published[0]) / level.all[0]));
    for (int kind = 0; kind < 3; ++kind) cells.push_back(percent(sweep.wrong_ratio(kind)));
    out += row(cells);
  }
  out += "\nNothing but sensor noise:\n\n" +
         table({"building", "hours", "windows", "windows with a value"});
  for (const Silence& s : r.silences)
    out += row({s.name + (s.noise_configured ? "" : ", noise not configured"),
                fmt::format("{:g}", s.hours), fmt::format("{}", s.windows),
                fmt::format("{}", s.published)});
  return out + fmt::format(
                   "\nA bias of 0.05 m/s^2 on every channel with a thermal ramp of 0.001 "
                   "m/s^2 per s changes k by at most {:.1e}.\n\n",
                   r.change_by_bias);
}

constexpr const char* kLimits =
    "## What no estimator can do\n\n"
    "*Least* is the limit: from 5 s at 1 % noise the stiff floors of a 3x3-bay plan cannot be "
    "known "
    "better than\nthe table says, whatever is done; their damping hardly at all. Such parameters "
    "are "
    "reported as not observable.\nMasses are taken as known. Clocks that differ by 1 ms cost 1 % "
    "in "
    "k, gains wrong by 1 % cost 0.5 %, and no\nestimator repairs either ([a real table with both "
    "faults](shaking-table.md)). Forces other than the\nground's bias the result while they "
    "act.\n\n"
    "The maximum-likelihood refinement of a stored stretch (`framewatch refine`) reaches the "
    "bound: "
    "Table 1 at 1 %,\nk 0.041 % against 0.043 %.\n";

std::string promise_list(const Reproduction& all) {
  const std::vector<Promise> list = promises(all);
  std::string out = "## Promises\n\n";
  int kept = 0;
  std::string broken;
  for (const Promise& promise : list) {
    kept += promise.kept ? 1 : 0;
    if (!promise.kept) broken += "- not kept: " + promise.what + ": " + promise.measured + "\n";
  }
  if (list.empty())
    return out + fmt::format("Fewer than {} seeds: nothing is judged.\n\n", kSeedsToJudge);
  return out + fmt::format("{} of {} kept.\n\n", kept, list.size()) +
         (broken.empty() ? "" : broken + "\n");
}

}  // namespace

std::string accuracy_markdown(const Reproduction& all) {
  Rows rows;
  for (const BuildingReproduction& b : all.buildings)
    for (const AccuracyRow& r : b.rows) rows.push_back(&r);
  if (all.robustness && all.robustness->random_buildings)
    rows.push_back(&*all.robustness->random_buildings);
  std::string out =
      introduction(all.seeds) + with_noise(rows, all.seeds) + intervals(rows) + exact_motion(all);
  if (all.robustness) out += excitation(*all.robustness);
  return out + promise_list(all) + kLimits;
}

}  // namespace framewatch::daemon
