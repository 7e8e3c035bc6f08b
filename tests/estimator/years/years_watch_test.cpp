// SPDX-License-Identifier: MIT
// Tests the watch for years in a building of eight stories that follows weather with lags of its
// own: no false alarm, and losses that are found, placed and sized.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"
#include "estimator/numeric/quantile.h"
#include "estimator/years/damping_days.h"
#include "estimator/years/years_watch.h"

namespace framewatch::estimator {
namespace years_test {

constexpr int kStories = 8;
constexpr double kYear_d = 365.25;
constexpr double kStiffness = 5e8;  // N/m
constexpr double kNoise = 0.006;    // of a day's value
constexpr int kLossDay = 400, kThreeYears_d = 1096, kFiveYears_d = 1826, kTwelveYears_d = 4383,
              kThirtyYears_d = 10957;
/// Largest error of a loss's size in some hundred draws, in standard errors.
constexpr double kMostErrors = 5;

/// A quantity that wanders about zero.
struct Wander {
  double deviation, days, now = 0;
  double next(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const double kept = std::exp(-1 / days);
    now = kept * now + deviation * std::sqrt(1 - kept * kept) * normal(random);
    return now;
  }
};

/// Eight stories in a temperate climate: temperature with seasons and fronts, humidity. Every story
/// follows both with its own size and lag, is stiffer when frozen, and wanders, alone and with the
/// others, for no reason that anyone measures. The lags are not those of WeatherLags.
struct World {
  explicit World(unsigned seed) : random(seed) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    for (Story& s : stories) {
      s.lag_d = 0.5 + 5.5 * uniform(random);
      s.per_degc = -0.0012 * (1 + 0.4 * normal(random));
      s.per_percent = -0.0002 * (1 + 0.5 * normal(random));
      s.frozen_per_degc = -0.001 * uniform(random);
    }
  }
  void next() {
    ++day;
    std::normal_distribution<double> normal;
    const double season = std::sin(2 * M_PI * (day - 110) / kYear_d);
    degc = 12 + 9 * season + front.next(random);
    percent = 65 - 8 * season + rain.next(random);
    const double together = all.next(random);
    for (Story& s : stories) {
      s.degc = day == 1 ? degc : degc + (s.degc - degc) * std::exp(-1 / s.lag_d);
      s.percent = day == 1 ? percent : percent + (s.percent - percent) * std::exp(-1 / 8.0);
      s.value = kStiffness * s.left *
                std::exp(s.per_degc * (s.degc - 12) + s.per_percent * (s.percent - 65) +
                         s.frozen_per_degc * std::min(s.degc, 0.0) + s.own.next(random) + together +
                         kNoise * normal(random));
    }
  }
  struct Story {
    double lag_d = 1, per_degc = 0, per_percent = 0, frozen_per_degc = 0;
    double left = 1;  ///< of the stiffness
    Wander own{0.002, 10};
    double degc = 0, percent = 0, value = 0;
  };
  std::mt19937_64 random;
  int day = 0;
  double degc = 0, percent = 0;
  Wander front{3, 3}, rain{5, 2}, all{0.003, 10};
  std::vector<Story> stories = std::vector<Story>(kStories);
};

const std::vector<Covariate> kWeather = {{"outside_degc", true}, {"humidity_pct", false}};

/// Times as many draws when FRAMEWATCH_YEARS_TIMES is set: 5 for the numbers of docs/years.md.
int draws(int usual) {
  const char* times = std::getenv("FRAMEWATCH_YEARS_TIMES");
  return usual * (times != nullptr ? std::max(std::atoi(times), 1) : 1);
}

/// The values and the weather of a day, as the watch gets them. A test may change them.
struct Seen {
  std::vector<DayValue> values;
  std::vector<double> weather;
};

/// Runs a world for so many days. event: changes it before a day. sight: changes what is seen.
/// anew_day: the watch is told before that day that the building was changed on purpose.
std::vector<YearsWatch::Finding> run(unsigned seed, int days,
                                     const std::function<void(World&)>& event = {},
                                     const std::function<void(int, Seen&)>& sight = {},
                                     const std::vector<Covariate>& covariates = kWeather,
                                     int anew_day = 0) {
  World world(seed);
  YearsWatch watch(kStories, covariates, LifeBudget{});
  std::vector<YearsWatch::Finding> out;
  for (int day = 1; day <= days; ++day) {
    if (event) event(world);
    world.next();
    Seen seen;
    for (const World::Story& s : world.stories) seen.values.push_back({s.value, kNoise * s.value});
    if (!covariates.empty()) seen.weather = {world.degc, world.percent};
    if (sight) sight(day, seen);
    if (day == anew_day) watch.begin_anew();
    const auto finding = watch.push(day, seen.values, seen.weather);
    if (finding) out.push_back(*finding);
  }
  return out;
}

int alarms(int runs, const std::function<void(int, Seen&)>& sight = {},
           const std::vector<Covariate>& covariates = kWeather) {
  int out = 0;
  for (int seed = 0; seed < runs; ++seed)
    out += run(static_cast<unsigned>(seed), kThreeYears_d, {}, sight, covariates).empty() ? 0 : 1;
  return out;
}

std::function<void(World&)> loss(const std::vector<int>& stories, double share) {
  return [=](World& w) {
    if (w.day + 1 != kLossDay) return;
    for (const int s : stories) w.stories[static_cast<std::size_t>(s)].left *= 1 - share;
  };
}

struct Found {
  int found = 0, placed = 0;
  std::vector<double> days;
  double worst = 0;  ///< errors of the size
};
Found find(int runs, const std::vector<int>& only, double share, int days) {
  Found out;
  for (int i = 0; i < runs; ++i) {
    const std::vector<int> where = only.empty() ? std::vector<int>{i % kStories} : only;
    const auto findings = run(1000 + static_cast<unsigned>(i), kLossDay + days, loss(where, share));
    if (findings.empty()) continue;
    ++out.found;
    const YearsWatch::Finding& f = findings.front();
    const int right = where.size() == 1 ? where[0] : YearsWatch::kAllAlike;
    if (f.element != right) continue;
    ++out.placed;
    out.days.push_back(f.found_day - kLossDay);
    out.worst = std::max(out.worst, std::abs(f.ratio + share) / f.std_error);
  }
  return out;
}

void show(const char* what, int runs, Found& f) {
  std::printf(
      "%s: %d runs, %d found, %d placed, median %.0f days, sizes off by %.1f errors at most\n",
      what, runs, f.found, f.placed, upper_median(f.days), f.worst);
}

TEST(Years, NoAlarmInThreeYearsOfAHealthyBuilding) {
  EXPECT_EQ(alarms(draws(60)), 0);
}

TEST(Years, FivePercentOfAnyStoryIsFoundWithinDays) {
  const int runs = draws(24);
  Found five = find(runs, {}, 0.05, 60);
  EXPECT_EQ(five.found, runs);
  EXPECT_GE(five.placed, 0.95 * runs);
  EXPECT_LT(upper_median(five.days), 5);
  EXPECT_LT(five.worst, kMostErrors);
  show("5 % of a story", runs, five);
}

TEST(Years, TwoPercentOfAnyStoryIsFoundWithinAYear) {
  const int runs = draws(24);
  Found two = find(runs, {}, 0.02, 365);
  EXPECT_GE(two.placed, 0.9 * runs);
  EXPECT_LT(two.worst, kMostErrors);
  show("2 % of a story", runs, two);
}

TEST(Years, AllStoriesAlikeAreReportedAsThat) {
  const int runs = draws(12);
  Found all = find(runs, {0, 1, 2, 3, 4, 5, 6, 7}, 0.02, 365);
  EXPECT_GE(all.placed, 0.9 * runs);
  show("2 % of all stories", runs, all);
}

TEST(Years, NoAlarmInThirtyYearsAndALossAfterTwelveIsFoundWithinDays) {
  for (int seed = 0; seed < draws(4); ++seed) {
    EXPECT_TRUE(run(static_cast<unsigned>(seed), kThirtyYears_d).empty()) << seed;
    const std::size_t story = static_cast<std::size_t>(seed) % kStories;
    const auto findings = run(static_cast<unsigned>(seed), kTwelveYears_d + 30, [=](World& w) {
      if (w.day + 1 == kTwelveYears_d) w.stories[story].left = 0.95;
    });
    ASSERT_EQ(findings.size(), 1) << seed;
    EXPECT_EQ(findings[0].element, static_cast<int>(story));
    EXPECT_LE(findings[0].found_day - kTwelveYears_d, 10);
  }
}

TEST(Years, WithoutAThermometerTheSeasonStandsForTheWeather) {
  EXPECT_EQ(alarms(draws(12), {}, {}), 0);
}

TEST(Years, AThermometerThatIsAwayOrSticksRaisesNothing) {
  EXPECT_EQ(alarms(draws(8),
                   [](int day, Seen& seen) {
                     if (day > 500 && day < 530) seen.weather[0] = kNaN;
                   }),
            0);
  double stuck = 0;
  EXPECT_EQ(alarms(draws(8),
                   [&](int day, Seen& seen) {
                     if (day == 500) stuck = seen.weather[0];
                     if (day > 500 && day < 530) seen.weather[0] = stuck;
                   }),
            0);
}

/// Runs worlds of five years whose thermometer reads `wrong(day)` too much. Returns the findings.
int alarms_with(int runs, const std::function<double(int day)>& wrong) {
  int out = 0;
  for (int seed = 0; seed < runs; ++seed)
    out += static_cast<int>(
        run(static_cast<unsigned>(seed), kFiveYears_d, {}, [&](int day, Seen& seen) {
          seen.weather[0] += wrong(day);
        }).size());
  return out;
}

TEST(Years, AThermometerThatLiesRaisesNothing) {
  for (const double degc : {-20.0, -10.0, -5.0, 5.0, 10.0})
    for (const int from : {60, 900}) {
      const int found = alarms_with(draws(1), [=](int day) { return day >= from ? degc : 0.0; });
      EXPECT_EQ(found, 0) << degc << " degC from day " << from;
    }
  EXPECT_EQ(alarms_with(draws(1), [](int day) { return day >= 700 && day < 900 ? -10.0 : 0.0; }),
            0);
  for (const double degc_per_year : {-1.0, 1.0})
    EXPECT_EQ(alarms_with(draws(1), [=](int day) { return degc_per_year * day / kYear_d; }), 0);
}

TEST(Years, AThermometerThatLiesIsToldAndALossAfterItIsFound) {
  constexpr int kLie = 800, kLoss = 900;
  constexpr double kOff_d = 10;
  int all_told = 0;
  for (unsigned seed = 0; seed < 4; ++seed)
    for (const double degc : {-10.0, 10.0}) {
      World world(seed);
      YearsWatch watch(kStories, kWeather, LifeBudget{});
      std::vector<YearsWatch::Finding> found;
      bool told = false;
      for (int day = 1; day <= kLoss + 60; ++day) {
        if (day == kLoss) world.stories[2].left = 0.95;
        world.next();
        std::vector<DayValue> values;
        for (const World::Story& s : world.stories) values.push_back({s.value, kNoise * s.value});
        const auto loss =
            watch.push(day, values, {world.degc + (day >= kLie ? degc : 0), world.percent});
        if (loss) found.push_back(*loss);
        const auto wrong = watch.wrong_sensor();
        if (!wrong || day < kLie) continue;
        told = true;
        EXPECT_EQ(wrong->covariate, 0);
        EXPECT_NEAR(wrong->since_day, kLie, kOff_d);
        EXPECT_LT(std::abs(wrong->size - degc), kMostErrors * wrong->std_error);
      }
      ASSERT_EQ(found.size(), 1) << seed << " " << degc;
      EXPECT_EQ(found[0].element, 2);
      EXPECT_LE(found[0].found_day - kLoss, 20);
      all_told += told ? 1 : 0;
    }
  EXPECT_GE(all_told, 5);  // of 8; elements that hardly follow the temperature do not show it
}

TEST(Years, AThermometerThatIsMendedIsNotCalledWrong) {
  constexpr int kLie = 700, kMended = 1000, kLast = 1100;
  int told = 0;
  for (unsigned seed = 0; seed < 4; ++seed)
    for (const double degc : {-12.0, 12.0}) {
      World world(seed);
      YearsWatch watch(kStories, kWeather, LifeBudget{});
      for (int day = 1; day <= kLast; ++day) {
        world.next();
        std::vector<DayValue> values;
        for (const World::Story& s : world.stories) values.push_back({s.value, kNoise * s.value});
        const double lie = day >= kLie && day < kMended ? degc : 0;
        EXPECT_FALSE(watch.push(day, values, {world.degc + lie, world.percent})) << day;
        if (day + 1 == kMended) told += watch.wrong_sensor() ? 1 : 0;
      }
      EXPECT_FALSE(watch.wrong_sensor()) << seed << " " << degc;
    }
  EXPECT_GE(told, 7);  // of 8
}

TEST(Years, DaysAndElementsWithoutValuesRaiseNothing) {
  EXPECT_EQ(alarms(draws(8),
                   [](int day, Seen& seen) {
                     if (day % 3 != 0)
                       for (DayValue& v : seen.values) v = {kNaN, kNaN};
                     if (day > 300 && day < 600) seen.values[2] = {kNaN, kNaN};
                   }),
            0);
}

/// Stiffness of a real six-story building in eleven earthquakes (San Bernardino), of its two groups
/// of stories over that in the weakest motion, with standard errors: means of an hour by `replay`.
constexpr double kEarthquakes[][4] = {
    {0.901, 0.033, 0.946, 0.024}, {0.930, 0.036, 0.967, 0.028}, {0.871, 0.023, 0.919, 0.018},
    {0.874, 0.034, 0.945, 0.025}, {0.890, 0.028, 0.976, 0.021}, {0.924, 0.023, 0.969, 0.020},
    {0.821, 0.027, 0.888, 0.015}, {0.910, 0.031, 0.978, 0.022}, {0.863, 0.019, 0.920, 0.016},
    {1.000, 0.047, 1.000, 0.020}, {0.913, 0.029, 1.000, 0.021}};

TEST(Years, EarthquakesBetweenRaiseNothingAndHideNothing) {
  constexpr int kEvery_d = 90;
  const auto shaken = [](int day, Seen& seen) {
    if (day % kEvery_d != 0) return;
    const double* e = kEarthquakes[static_cast<std::size_t>(day / kEvery_d) % 11];
    for (std::size_t s = 0; s < seen.values.size(); ++s) {
      DayValue& v = seen.values[s];
      const int group = s < 2 ? 0 : 2;  // the lower two stories
      v.value *= e[group];
      v.std_error = v.value * e[group + 1];
    }
  };
  EXPECT_EQ(alarms(draws(4), shaken), 0);
  const auto surer = [&](int day, Seen& seen) {  // as if a day were of the earthquake alone
    shaken(day, seen);
    if (day % kEvery_d == 0)
      for (DayValue& v : seen.values) v.std_error = kNoise * v.value;
  };
  EXPECT_EQ(alarms(draws(4), surer), 0);
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto found = run(seed, kLossDay + 60, loss({5}, 0.05), surer);
    ASSERT_EQ(found.size(), 1) << seed;
    EXPECT_EQ(found[0].element, 5);
    EXPECT_LE(found[0].found_day - kLossDay, 10);
  }
}

TEST(Years, HalfOfTheValuesAndWrongOnesRaiseNothingAndHideNothing) {
  const auto broken = [](unsigned seed) {
    return [random = std::mt19937_64(seed)](int, Seen& seen) mutable {
      const auto one_in = [&](unsigned n) { return random() % n == 0; };
      for (DayValue& v : seen.values) {
        if (one_in(2)) v = {kNaN, kNaN};
        if (one_in(50)) v.value *= 10;
        if (one_in(50)) v.value *= 0.01;
        if (one_in(50)) v.value = -v.value;
        if (one_in(50)) v.std_error *= 1e-3;
      }
      for (double& w : seen.weather)
        if (one_in(2)) w = kNaN;
    };
  };
  int wrong = 0;
  for (unsigned seed = 0; seed < static_cast<unsigned>(draws(8)); ++seed)
    wrong += run(seed, kThreeYears_d, {}, broken(seed)).empty() ? 0 : 1;
  EXPECT_EQ(wrong, 0);
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto found = run(seed, kLossDay + 200, loss({5}, 0.05), broken(seed));
    ASSERT_EQ(found.size(), 1) << seed;
    EXPECT_EQ(found[0].element, 5);
  }
}

TEST(Years, AKnownLossIsNotFoundAgainAndTheNextOneIs) {
  const auto twice = [](World& w) {
    if (w.day + 1 == kLossDay) w.stories[2].left = 0.95;
    if (w.day + 1 == kLossDay + 200) w.stories[5].left = 0.93;
  };
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto findings = run(seed, kLossDay + 400, twice);
    ASSERT_EQ(findings.size(), 2) << seed;
    EXPECT_EQ(findings[0].element, 2);
    EXPECT_EQ(findings[1].element, 5);
  }
}

TEST(Years, AChangeOnPurposeIsNotFoundAndALossAfterItIs) {
  const auto change = [](World& w) {
    if (w.day + 1 == kLossDay)  // a new wall in one story, and books in all of them
      for (std::size_t s = 0; s < w.stories.size(); ++s) w.stories[s].left = s == 1 ? 1.6 : 0.9;
    if (w.day + 1 == kLossDay + 200) w.stories[5].left *= 0.93;
  };
  for (unsigned seed = 0; seed < 8; ++seed) {
    EXPECT_GT(run(seed, kLossDay + 100, change).size(), 0) << seed;
    const auto findings = run(seed, kLossDay + 400, change, {}, kWeather, kLossDay);
    ASSERT_EQ(findings.size(), 1) << seed;
    EXPECT_EQ(findings[0].element, 5);
    EXPECT_GE(findings[0].found_day, kLossDay + 200);
    EXPECT_LT(findings[0].found_day, kLossDay + 260);
    EXPECT_LT(std::abs(findings[0].ratio + 0.07), kMostErrors * findings[0].std_error);
  }
}

/// Damping that moves ten times as much as the stiffness, against it, and scatters by 6 % a day.
std::vector<YearsWatch::Finding> damping_of(unsigned seed, int days, double growth_ratio) {
  World world(seed);
  YearsWatch watch(kStories, kWeather, LifeBudget{});
  std::vector<YearsWatch::Finding> out;
  for (int day = 1; day <= days; ++day) {
    world.next();
    std::vector<DayValue> values;
    for (std::size_t s = 0; s < kStories; ++s) {
      const double grown = s == 3 && day >= kLossDay ? 1 + growth_ratio : 1;
      const double damping =
          1e5 * grown * std::pow(world.stories[s].value / kStiffness, -kDampingPower);
      values.push_back(as_stiffness({damping, kDampingPower * kNoise * damping}));
    }
    const auto finding = watch.push(day, values, {world.degc, world.percent});
    if (finding) out.push_back(as_damping(*finding));
  }
  return out;
}

TEST(Years, DampingThatGrowsIsFoundAndWeatherIsNot) {
  for (unsigned seed = 0; seed < 8; ++seed)
    EXPECT_TRUE(damping_of(seed, kThreeYears_d, 0).empty()) << seed;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto findings = damping_of(seed, kLossDay + 60, 0.6);
    ASSERT_EQ(findings.size(), 1) << seed;
    EXPECT_EQ(findings[0].element, 3);
    EXPECT_LE(findings[0].found_day - kLossDay, 10);
    EXPECT_NEAR(findings[0].ratio, 0.6, kMostErrors * findings[0].std_error);
    EXPECT_LT(findings[0].std_error, 0.3);
  }
}

TEST(Years, TheEffectOfTheWeatherIsLearnedAndALossIsNotTakenForIt) {
  constexpr int kLost = 3;
  constexpr double kShare = 0.05, kLeastSeason = 0.006, kMostLeft = 0.002, kMostOff = 0.01;
  double season_of_all = 0;
  World world(7);
  YearsWatch watch(kStories, kWeather, LifeBudget{});
  EXPECT_EQ(watch.regressors().size(), 0);
  std::vector<Eigen::VectorXd> regressors;
  std::vector<std::vector<double>> logs(kStories);
  const auto event = loss({kLost}, kShare);
  for (int day = 1; day <= kThreeYears_d; ++day) {
    event(world);
    world.next();
    std::vector<DayValue> values;
    for (const World::Story& s : world.stories) values.push_back({s.value, kNoise * s.value});
    (void)watch.push(day, values, {world.degc, world.percent});
    regressors.push_back(watch.regressors());
    for (std::size_t p = 0; p < kStories; ++p) logs[p].push_back(std::log(values[p].value));
  }
  for (std::size_t p = 0; p < kStories; ++p) {
    const Eigen::VectorXd effect = watch.weather_effect(p);
    EXPECT_EQ(effect[0], 0);
    double raw = 0, left = 0, before = 0, after = 0;
    for (int day = 1; day <= kThreeYears_d; ++day) {
      const auto d = static_cast<std::size_t>(day - 1);
      const double season = std::sin(2 * M_PI * (day - 110) / kYear_d);
      const double step = p == kLost && day >= kLossDay ? std::log1p(-kShare) : 0;
      const double corrected = logs[p][d] - effect.dot(regressors[d]);
      raw += 2 * season * (logs[p][d] - step - std::log(kStiffness)) / kThreeYears_d;
      left += 2 * season * (corrected - step - std::log(kStiffness)) / kThreeYears_d;
      (day < kLossDay ? before : after) +=
          corrected / (day < kLossDay ? kLossDay - 1 : kThreeYears_d - kLossDay + 1);
    }
    season_of_all += std::abs(raw) / kStories;
    EXPECT_LT(std::abs(left), kMostLeft) << p;
    EXPECT_NEAR(after - before, p == kLost ? std::log1p(-kShare) : 0, kMostOff) << p;
  }
  EXPECT_GT(season_of_all, kLeastSeason);
}

TEST(Years, OneElementAloneIsWatched) {
  YearsWatch watch(1, {}, LifeBudget{});
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::optional<YearsWatch::Finding> found;
  for (int day = 0; day < 300 && !found; ++day)
    found = watch.push(day, {{(day < 200 ? 1 : 0.9) * (1 + kNoise * normal(random)), kNoise}}, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->element, 0);
  EXPECT_EQ(found->since_day, 200);
}

}  // namespace years_test
}  // namespace framewatch::estimator
