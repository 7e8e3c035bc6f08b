// SPDX-License-Identifier: MIT
// Records of changes over synthetic windows.
#include "estimator/watch/change_book.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "estimator/state/archive.h"
#include "estimator/watch/watch.h"
#include "estimator/watch/window_history.h"

namespace framewatch::estimator {
namespace change_book_test {

constexpr double kChange_s = 60, kEnd_s = 120;
constexpr double kSecondError = 0.01;  // of a window of 1 s, relative
constexpr double kSoon_s = 6, kNumber_s = 12;
const std::vector<double> kLengths_s = {5, 1, 2.5, 10};

/// Six stories with two frames: twelve stiffnesses.
ParameterTable table() {
  Structure s;
  s.stories = 6;
  s.frames_x = {"y1", "y2"};
  s.span_y = {4};
  s.story_height.assign(6, 3);
  s.node_mass.assign(12, 1e4);
  return ParameterTable(s);
}

/// Returns an element's stiffness at a time, relative to the baseline.
using Stiffness = std::function<double(int element, double time_s)>;

/// A building of synthetic windows: each shows the mean over its time, plus noise.
class Building {
 public:
  explicit Building(Stiffness stiffness, std::uint64_t seed = 1)
      : table_(table()), stiffness_(std::move(stiffness)), random_(seed) {}

  Watch watch() const {
    Baseline baseline(static_cast<std::size_t>(table_.size()));
    baseline.value.assign(baseline.value.size(), 1.0);
    baseline.std_error.assign(baseline.std_error.size(), 0.001);
    WatchOptions options;
    options.quiet_window_s = 0;
    options.amplitude = false;
    return {table_, options, kLengths_s, baseline};
  }

  WindowEstimate window(int index, double end_s) {
    const double length_s = kLengths_s[static_cast<std::size_t>(index)];
    WindowEstimate e(static_cast<std::size_t>(table_.size()));
    e.window = index;
    e.end = from_microseconds(std::llround(1e6 * end_s));
    e.start = from_microseconds(std::llround(1e6 * (end_s - length_s)));
    e.status = WindowStatus::valid;
    const double error = kSecondError / std::sqrt(length_s);
    for (int p = 0; p < table_.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      double mean = 0;
      constexpr int kPieces = 50;
      for (int k = 0; k < kPieces; ++k)
        mean += stiffness_(p, end_s - length_s * (k + 0.5) / kPieces) / kPieces;
      e.value[i] = p < table_.elements() ? mean + error * random_.normal() : 1;
      e.std_error[i] = error;
      e.prior_share[i] = e.noise_share[i] = 0;
      e.reason[i] = Observability::observable;
    }
    return e;
  }

  /// Returns every window of a stretch, in order of their ends.
  void run(Watch& watch, double from_s, double to_s,
           const std::function<void(const Alarm&, double)>& take) {
    for (int tick = static_cast<int>(std::lround(10 * from_s)) + 1; tick <= std::lround(10 * to_s);
         ++tick)
      for (int w = 0; w < static_cast<int>(kLengths_s.size()); ++w)
        if (tick % static_cast<int>(std::lround(2 * kLengths_s[static_cast<std::size_t>(w)])) == 0)
          for (const Alarm& a : watch.push(window(w, 0.1 * tick))) take(a, 0.1 * tick);
  }

 private:
  ParameterTable table_;
  Stiffness stiffness_;
  Random random_;
};

Stiffness loses(std::map<int, std::pair<double, double>> losses) {
  return [losses](int element, double time_s) {
    const auto at = losses.find(element);
    return at == losses.end() || time_s < at->second.first ? 1 : 1 - at->second.second;
  };
}

TEST(ChangeBook, SaysChangingBeforeItHasANumber) {
  Building building(loses({{3, {kChange_s, 0.15}}}));
  Watch watch = building.watch();
  std::vector<Alarm> news;
  std::vector<double> at_s;
  building.run(watch, 10, kEnd_s, [&](const Alarm& a, double now_s) {
    news.push_back(a);
    at_s.push_back(now_s - kChange_s);
  });
  ASSERT_GE(news.size(), 3u);
  EXPECT_EQ(news.front().state, AlarmState::raised);
  EXPECT_LT(at_s.front(), kSoon_s);
  double last = 1;
  for (const Alarm& a : news) {
    EXPECT_EQ(a.parameter, 3);
    EXPECT_EQ(a.id, news.front().id);
    if (!a.measured) continue;
    EXPECT_EQ(a.reason, ChangeReason::none);
    EXPECT_LT(a.change.std_error, last);
    last = a.change.std_error;
    EXPECT_NEAR(a.change.ratio, -0.15, 4 * a.change.std_error);
  }
  const auto first =
      std::find_if(news.begin(), news.end(), [](const Alarm& a) { return a.measured; });
  ASSERT_NE(first, news.end());
  EXPECT_LT(at_s[static_cast<std::size_t>(first - news.begin())], kNumber_s);
  const ChangeRecord* record = watch.record(3);
  ASSERT_NE(record, nullptr);
  EXPECT_EQ(record->change.ratio, news.back().change.ratio);  // the published number
  EXPECT_EQ(record->change.std_error, news.back().change.std_error);
  constexpr double kInstant_s = 1;
  EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(record->change.since)), kChange_s,
              kInstant_s);
  EXPECT_LE(record->change.earliest, record->change.since);
  EXPECT_GE(record->change.latest, record->change.since);
}

TEST(ChangeBook, ReportsACommonChangeAsOneFinding) {
  for (const double shift : {-0.05, 0.05}) {
    Building building([shift](int, double time_s) { return time_s < kChange_s ? 1 : 1 + shift; });
    Watch watch = building.watch();
    std::set<int> open;
    building.run(watch, 10, kEnd_s, [&](const Alarm& a, double) {
      a.state == AlarmState::cleared ? (void)open.erase(a.parameter)
                                     : (void)open.insert(a.parameter);
    });
    EXPECT_EQ(open, std::set<int>{ChangeRecord::kEverything}) << shift;
    const ChangeRecord* record = watch.record(ChangeRecord::kEverything);
    ASSERT_NE(record, nullptr);
    EXPECT_TRUE(record->measured());
    EXPECT_NEAR(record->change.ratio, shift, 4 * record->change.std_error);
  }
}

/// A baseline of another season, and then a frame that loses stiffness.
TEST(ChangeBook, FindsALossBesideACommonChange) {
  Building building([](int element, double time_s) {
    return 0.95 * (element == 5 && time_s >= kChange_s ? 0.85 : 1);
  });
  Watch watch = building.watch();
  std::set<int> open;
  building.run(watch, 10, kEnd_s, [&](const Alarm& a, double) {
    a.state == AlarmState::cleared ? (void)open.erase(a.parameter) : (void)open.insert(a.parameter);
  });
  EXPECT_EQ(open, (std::set<int>{ChangeRecord::kEverything, 5}));
  ASSERT_NE(watch.record(5), nullptr);
  EXPECT_NEAR(watch.record(5)->change.ratio, -0.15, 4 * watch.record(5)->change.std_error);
}

TEST(ChangeBook, SeparatesTwoLossesTwoSecondsApart) {
  Building building(loses({{3, {kChange_s, 0.2}}, {8, {kChange_s + 2, 0.1}}}));
  Watch watch = building.watch();
  std::set<int> named;
  building.run(watch, 10, kEnd_s, [&](const Alarm& a, double) { named.insert(a.parameter); });
  EXPECT_EQ(named, (std::set<int>{3, 8}));
  for (const auto& [element, loss] : {std::pair{3, 0.2}, std::pair{8, 0.1}}) {
    ASSERT_NE(watch.record(element), nullptr);
    EXPECT_NEAR(watch.record(element)->change.ratio, -loss,
                4 * watch.record(element)->change.std_error);
  }
}

TEST(ChangeBook, ReportsNoGainBesideAnOpenLoss) {
  Building building([](int element, double time_s) {
    return time_s < kChange_s ? 1 : element == 3 ? 0.8 : element == 4 ? 1.06 : 1;
  });
  Watch watch = building.watch();
  std::set<int> named;
  building.run(watch, 10, kEnd_s, [&](const Alarm& a, double) { named.insert(a.parameter); });
  EXPECT_EQ(named, std::set<int>{3});
}

/// A deviation of a few seconds that the windows behind it do not confirm.
TEST(ChangeBook, WithdrawsAChangeThatDisappears) {
  Building building([](int element, double time_s) {
    return element == 3 && time_s >= kChange_s && time_s < kChange_s + 8 ? 0.8 : 1;
  });
  Watch watch = building.watch();
  building.run(watch, 10, kEnd_s, [](const Alarm&, double) {});
  EXPECT_EQ(watch.record(3), nullptr);
}

/// Delayed windows arrive after newer ones.
TEST(ChangeBook, CountsLateWindows) {
  constexpr double kLate_s = 20;
  Building building(loses({{3, {kChange_s, 0.15}}}));
  Watch watch = building.watch();
  std::set<int> named;
  const auto take = [&](const Alarm& a, double) { named.insert(a.parameter); };
  building.run(watch, 10, kChange_s - 10, take);
  (void)watch.push(building.window(1, kChange_s + kLate_s));
  building.run(watch, kChange_s - 10, kChange_s + kLate_s - 1, take);
  EXPECT_EQ(named, std::set<int>{3});
}

TEST(ChangeBook, ContinuesFromAStateBitByBit) {
  for (const double cut_s : {30.0, kChange_s + 3, kChange_s + 7, kChange_s + 50}) {
    Building one(loses({{3, {kChange_s, 0.15}}})), other(loses({{3, {kChange_s, 0.15}}}));
    Watch whole = one.watch(), first = other.watch(), second = other.watch();
    one.run(whole, 10, kEnd_s, [](const Alarm&, double) {});
    other.run(first, 10, cut_s, [](const Alarm&, double) {});
    StateWriter writer;
    writer(first);
    StateReader reader(writer.bytes());
    reader(second);
    ASSERT_TRUE(reader.whole());
    other.run(second, cut_s, kEnd_s, [](const Alarm&, double) {});
    StateWriter a, b;
    a(whole);
    b(second);
    EXPECT_EQ(a.bytes(), b.bytes()) << cut_s;
  }
}

TEST(ChangeTime, LiesBetweenTheWindowsThatShowIt) {
  constexpr double kError = 0.01, kStep_s = 0.2, kAt_s = 10;
  WindowHistory history(1);
  Random random(3);
  for (double end_s = 4; end_s < 16; end_s += kStep_s) {
    const double behind = std::clamp(end_s - kAt_s, 0.0, 1.0);
    const std::size_t place = history.add(from_microseconds(std::llround(1e6 * (end_s - 1))),
                                          from_microseconds(std::llround(1e6 * end_s)));
    history.put(place, 0, {-0.2 * behind + kError * random.normal(), kError, 0});
  }
  const WindowHistory* const all[] = {&history};
  const auto time = time_of_change(all, 0, kError, from_microseconds(4'000'000),
                                   from_microseconds(16'000'000), SensorClock::duration(200'000));
  ASSERT_TRUE(time);
  EXPECT_LE(time->earliest, from_microseconds(10'000'000));
  EXPECT_GE(time->latest, from_microseconds(10'000'000));
  EXPECT_LT(time->latest - time->earliest, SensorClock::duration(2'000'000));
}

}  // namespace change_book_test
}  // namespace framewatch::estimator
