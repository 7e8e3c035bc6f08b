#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "daemon/tools/lab/reproduction_report.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kKinds[] = {"k", "G", "c"};
using Rows = std::vector<const AccuracyRow*>;

constexpr const char kIntroduction[] = R"(# Accuracy

Made by `framewatch reproduce --seeds {} --out DIR`, but for [In the earthquake itself](accuracy.md#in-the-earthquake-itself);
do not edit. What the estimator reaches, what nobody can reach, and how to measure it again. Buildings: the
paper's Table 1 (5 stories, 1x1 bay, 50 parameters) and Table 2 (2 stories, 3x3 bays, 68 parameters) with
flexible (2b), basic (2c) and stiff (2d) floors. Seed i is one artificial ground motion (Kanai-Tajimi, 15 s,
45 degrees), one draw of noise and one design, off by up to 10 % in k and 30 % in G and c. Motion is the
exact response (first-order hold at 1 ms, band-limited, decimated to 100 Hz), not the estimator's own
scheme. Noise is white on every accelerometer, in per cent of that channel's rms. Windows are 5 s long and
end at 10, 11, .. 15 s.

)";

constexpr const char kWithNoise[] = R"(## With noise

Median of |relative error| over parameters, windows and {} motions. *Least*: what the Cramer-Rao bound leaves
to any unbiased estimator, 0.6745 times its standard deviation. *Must*: the limit that is held to. *Unaware*:
framewatch when the sensors' noise is not configured. *Refined*: `framewatch refine` on the first window of
each motion. *Paper*: the paper's equations on the same accelerations, integrated behind a 0.1-Hz high-pass.
*Example*: as the paper does it, 10 s with independent noise on accelerations, velocities and displacements;
*denoised*: behind its singular value decomposition (p = 200, q = 5, s(r) >= 0.98).

)";

constexpr const char* kBelowTheBound = R"(
Below 1 times the least is not magic: where the window says little, prior and design say the rest, and the
published error counts how far they can pull. *Random buildings*: one to six stories, one to four frames each
way, all drawn by seed.

)";

constexpr const char* kIntervals = R"(## Published errors

Share of parameters that are published, and of these the share whose nominal 95 % interval (value plus and
minus 2.093 standard errors: Student's t, 19 degrees of freedom) holds the truth. 90 to 98 % is demanded.

)";

constexpr const char* kBatchMeans = R"(
Standard errors are batch means over 20 blocks of a quarter of a second, corrected for the few blocks, plus
the pull of prior and noise toward a design off by up to its tolerance ([equations](equations.md), 21).

)";

constexpr const char* kExact = R"(## Without noise

95th percentile of the relative error over parameters and windows, four motions.
`tests/identify/accuracy_test.cpp` holds El Centro and Hachinohe to 2e-5, 2e-4, 2e-4 and 2e-3.

)";

constexpr const char* kAliased = R"(
A record sampled without an anti-alias filter is another matter: content above half the sampling rate folds
into the band, and no estimator sees that.

)";

constexpr const char* kExcitation = R"(## When little moves

The sensors' noise stays and the motion fades: noise from 0.3 % to 3000 % of the motion's rms, design off by
up to 20 % in k and 40 % in G and c. Share of all k that is published at each level, and, of all that are
published, how many are off by more than 5 % (k) or 25 % (G, c).

)";

constexpr const char kFewSensors[] = R"(## Few sensors

A plane building of 20 stories (f1 0.5 Hz, stiffness falling to a third at the top), true stiffness of groups of
stories off the design by up to 20 %, damping by 30 %; windows of 5 s, {} motions. *Must*: what is asked of four
sensors. Bending is identified where the design has it. `framewatch reproduce --case few-sensors`.

)";

constexpr const char* kWrongModels = R"(
## When the model is wrong

The same and a building of 5 stories with a sensor on every floor, whose true masses, stories, bending or damping
are not the model's. Share of published stiffnesses whose 95 % interval holds the truth: by the window's standard
error alone, which is an error of changes, and by that and the model's error together ([equations](equations.md), errors
of the model). 85 % is demanded of the second.

)";

constexpr const char* kLimits = R"(## What no estimator can do

*Least* is the limit: from 5 s at 1 % noise the stiff floors of a 3x3-bay plan cannot be known better than the
table says, whatever is done; their damping hardly at all. Such parameters are reported as not observable.
Masses are taken as known: a wrong mass is a wrong stiffness. Clocks of the nodes that differ and gains that
are wrong go straight into the result, and no estimator repairs either
([a real table with both faults](shaking-table.md)). Forces other than the ground's bias the result while they
act.
)";

std::string row(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += " " + cell + " |";
  return out + "\n";
}

std::string table(const std::vector<std::string>& head) {
  return row(head) + row(std::vector<std::string>(head.size(), "---"));
}

std::string limit_text(const std::string& name, int kind) {
  for (const AccuracyCase& c : accuracy_cases())
    if (c.name == name) return percent(c.limit[static_cast<std::size_t>(kind)]);
  return "-";
}

std::string with_noise(const Rows& rows) {
  std::string out = table({"case", "", "least", "framewatch", "must", "times least", "unaware",
                           "refined", "paper", "example", "denoised"});
  for (const AccuracyRow* r : rows)
    for (int kind = 0; kind < 3; ++kind) {
      const double ours = r->of(Method::matched, kind).quantile(0.5);
      std::vector<std::string> cells{
          kind == 0 ? r->name : "",       kKinds[kind],
          percent(r->least_median(kind)), "**" + percent(ours) + "**",
          limit_text(r->name, kind),      fmt::format("{:.2f}", ours / r->least_median(kind))};
      for (const Method method : {Method::matched_unaware, Method::refined, Method::paper_accel,
                                  Method::paper_example, Method::paper_denoised})
        cells.push_back(percent(r->of(method, kind).quantile(0.5)));
      out += row(cells);
    }
  return out;
}

std::string intervals(const Rows& rows) {
  std::string out = table({"case", "k published", "holds", "G published", "holds", "c published",
                           "holds", "unaware: k", "G", "c hold"});
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
  return out;
}

std::string exact_motion(const Reproduction& all) {
  std::string out = table({"case", "k", "G", "c", "G_c"});
  for (const BuildingReproduction& b : all.buildings) {
    std::vector<std::string> cells{"Table " + b.group.substr(5)};
    for (const ErrorStatistics& kind : b.exact)
      cells.push_back(fmt::format("{:.1e}", kind.quantile(0.95)));
    out += row(cells);
  }
  return out;
}

std::string excitation(const Robustness& r) {
  std::vector<std::string> head{"building"};
  for (const ExcitationLevel& level : r.sweeps.front().levels)
    head.push_back(fmt::format("{:g} %", 100 * level.noise_ratio));
  for (const char* kind : {"k off", "G off", "c off"}) head.push_back(kind);
  std::string out = table(head);
  for (const ExcitationSweep& sweep : r.sweeps) {
    std::vector<std::string> cells{sweep.name};
    for (const ExcitationLevel& level : sweep.levels)
      cells.push_back(percent(static_cast<double>(level.published[0]) / level.all[0]));
    for (int kind = 0; kind < 3; ++kind) cells.push_back(percent_1(sweep.wrong_ratio(kind)));
    out += row(cells);
  }
  out += "\nNothing but sensor noise:\n\n" +
         table({"building", "hours", "windows", "windows with a value"});
  for (const Silence& s : r.silences)
    out += row({s.name + (s.noise_configured ? "" : ", noise not configured"),
                fmt::format("{:g}", s.hours), fmt::format("{}", s.windows),
                fmt::format("{}", s.published)});
  return out + fmt::format(
                   "\nA bias of 0.05 m/s^2 on every channel with a thermal ramp of 0.001 m/s^2 per "
                   "s changes k by at most {:.1e}.\n\n",
                   r.change_by_bias);
}

std::string few_sensors(const std::vector<FewSensorsRow>& rows) {
  std::string out = table({"sensors", "k", "95 % of k", "c", "95 % of c", "must (k, c)"});
  for (const FewSensorsRow& r : rows)
    out += row({r.name, percent(r.errors.stiffness.quantile(0.5)),
                percent(r.errors.stiffness.quantile(0.95)), percent(r.errors.damping.quantile(0.5)),
                percent(r.errors.damping.quantile(0.95)), r.must()});
  return out;
}

std::string wrong_models(const std::vector<FewSensorsRow>& rows) {
  std::string out = table(
      {"building", "error of k", "published", "window's error holds", "with the model's error"});
  for (const FewSensorsRow& r : rows)
    out += row({r.name, percent(r.errors.stiffness.quantile(0.5)),
                percent(r.errors.stiffness.published_ratio()),
                percent(r.errors.stiffness.coverage_ratio()), percent(r.errors.held_ratio())});
  return out + "\n";
}

std::string promise_list(const Reproduction& all) {
  const std::vector<Promise> list = promises(all);
  std::string out = "## Promises\n\n", broken;
  if (list.empty())
    return out + fmt::format("Fewer than {} seeds: nothing is judged.\n\n", kSeedsToJudge);
  int kept = 0;
  for (const Promise& promise : list) {
    kept += promise.kept ? 1 : 0;
    if (!promise.kept) broken += "- not kept: " + promise.what + ": " + promise.measured + "\n";
  }
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
  std::string out = fmt::format(kIntroduction, all.seeds);
  if (!rows.empty()) {
    out += fmt::format(kWithNoise, all.seeds) + with_noise(rows) + kBelowTheBound;
    out += kIntervals + intervals(rows) + kBatchMeans;
    out += kExact + exact_motion(all) + kAliased;
  }
  if (all.robustness) out += kExcitation + excitation(*all.robustness);
  if (!all.few_sensors.empty())
    out += fmt::format(kFewSensors, all.seeds) + few_sensors(all.few_sensors) + kWrongModels +
           wrong_models(all.wrong_models);
  return out + promise_list(all) + kLimits;
}

}  // namespace framewatch::daemon
