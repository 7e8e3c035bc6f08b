// SPDX-License-Identifier: MIT
// Absurd samples of any bit pattern on one channel, single ones or a second of them, move no
// published value by more than its standard error for longer than its window, and silence none for
// longer than kMaxSilence_s. Every impossible sample is counted.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "estimator/motion/acquisition.h"
#include "estimator/pipeline/pipeline.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

namespace framewatch::estimator {
namespace absurd_samples_test {

constexpr double kMaxSilence_s = 10;
constexpr double kAfterWindow_s = 1;  // memory of the filters before a window
/// Standard errors, at any time: caused by 25 repaired samples in every window, or by a second
/// without a channel.
constexpr double kMaxMovedByLosses = 2;
/// Standard errors of windows of other lengths, whose errors come from the main window's blocks.
constexpr double kMaxMovedOfOthers = 4;
constexpr double kRate_hz = 100;
constexpr int kFirst = 20 * static_cast<int>(kRate_hz);  // instant: everything is published
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Samples that replace others.
struct Attack {
  int instant, axis;
  std::vector<double> values;  ///< of successive instants
};

struct Said {
  std::map<std::pair<int, std::int64_t>, WindowEstimate> estimates;  ///< by window and end
  PipelineCounters counters;
};

class AbsurdSamples : public testing::TestWithParam<bool> {
 protected:
  /// Seconds of motion after kFirst.
  void shake(double seconds) {
    config_ = test::pipeline_config(test::table1(), kRate_hz);
    config_.options.other_windows_s = {1, 2.5, 10};
    config_.options.hop_s = 0.1;
    accel_ = test::shaken(test::table1(), test::table1_theta(), kRate_hz,
                          kFirst / kRate_hz + seconds, 0.01);
    for (Eigen::Index a = 0; a < accel_.cols() && GetParam(); ++a)
      config_.axes[static_cast<std::size_t>(a)].noise_density =
          0.01 * accel_.col(a).norm() / std::sqrt(static_cast<double>(accel_.rows())) /
          std::sqrt(kRate_hz / 2);
    clean_ = run({});
  }

  Said run(const std::vector<Attack>& attacks) const {
    Said out;
    Eigen::MatrixXd accel = accel_;
    for (const Attack& attack : attacks)
      for (std::size_t i = 0; i < attack.values.size(); ++i)
        accel(attack.instant + static_cast<int>(i), attack.axis) = attack.values[i];
    const auto keep = [&](const WindowEstimate& e) {
      out.estimates[{e.window, to_microseconds(e.end)}] = e;
    };
    Pipeline pipeline(config_);
    for (int t = 0; t < accel.rows(); ++t)
      for (int axis = 0; axis < accel.cols(); ++axis)
        each_window(pipeline.push(test::sample_at(accel, kRate_hz, t, axis)), keep);
    each_window(pipeline.finish(), keep);
    out.counters = pipeline.counters();
    return out;
  }

  /// Returns true if the window holds a sample of an attack.
  static bool holds(const WindowEstimate& e, const std::vector<Attack>& attacks) {
    const double end_s = 1e-6 * static_cast<double>(to_microseconds(e.end));
    return std::any_of(attacks.begin(), attacks.end(), [&](const Attack& a) {
      const double begin = a.instant / kRate_hz - kAfterWindow_s;
      const double last = (a.instant + static_cast<int>(a.values.size())) / kRate_hz;
      return end_s >= begin && end_s <= last + e.rows / kRate_hz + kAfterWindow_s;
    });
  }

  /// In windows that hold an absurd sample, values may be wrong if `spared`. In others they may
  /// differ by more than their standard error for at most a window's length, and never by more
  /// than `most_moved` of them.
  void expect_unmoved(const Said& said, const std::vector<Attack>& attacks, bool spared,
                      double most_moved) const {
    std::map<std::pair<int, std::size_t>, double> shown_s, first_moved_s;
    double worst = 0, silence = 0, longest = 0;
    for (const auto& [key, clean] : clean_.estimates) {
      const auto found = said.estimates.find(key);
      const double end_s = 1e-6 * static_cast<double>(key.second);
      for (std::size_t p = 0; p < clean.value.size(); ++p) {
        double& shown = shown_s[{key.first, p}];
        const bool is_shown =
            found != said.estimates.end() && std::isfinite(found->second.value[p]);
        if (is_shown || !std::isfinite(clean.value[p])) shown = end_s;
        silence = std::max(silence, end_s - shown);
        const bool compared =
            is_shown && std::isfinite(clean.value[p]) && !(spared && holds(found->second, attacks));
        const double errors = compared ? std::abs(found->second.value[p] - clean.value[p]) /
                                             found->second.std_error[p]
                                       : 0;
        if (errors <= 1) {
          first_moved_s.erase({key.first, p});
          continue;
        }
        const double moved_s = first_moved_s.try_emplace({key.first, p}, end_s).first->second;
        const WindowEstimate& now = found->second;
        longest = std::max(longest, (end_s - moved_s) / (now.rows / kRate_hz));
        const double moved = errors / (key.first == 0 ? most_moved : kMaxMovedOfOthers);
        if (moved > 1 && moved > worst)
          ADD_FAILURE() << "window " << key.first << " that ends at " << end_s << " s, parameter "
                        << p << ": " << clean.value[p] << " became " << now.value[p] << " +- "
                        << now.std_error[p];
        worst = std::max(worst, moved);
      }
    }
    EXPECT_LE(silence, kMaxSilence_s);
    EXPECT_LE(longest, 1 + 1e-6) << "lengths of its window";
    RecordProperty("longest", std::to_string(longest));
    RecordProperty("worst", std::to_string(worst));
    RecordProperty("silence_s", std::to_string(silence));
  }

  std::int64_t absurd(const Said& said) const {
    std::int64_t sum = 0;
    for (const AxisCounters& c : said.counters.axes) sum += c.absurd;
    return sum;
  }

  PipelineConfig config_;
  Eigen::MatrixXd accel_;
  Said clean_;
};

/// Every exponent of a double, including all zeros and all ones, with either sign.
std::vector<double> every_exponent(bool odd_negative) {
  std::vector<double> out;
  std::mt19937_64 random(22);
  for (std::uint64_t exponent = 0; exponent < 2048; ++exponent)
    out.push_back(std::bit_cast<double>((exponent % 2 ^ (odd_negative ? 0 : 1)) << 63 |
                                        exponent << 52 | (random() & 0xFFFFFFFFFFFFF)));
  return out;
}

TEST_P(AbsurdSamples, BeyondTheBoundChangeNothing) {
  std::vector<double> values;
  const SampleBound bound = sample_bound({});
  for (const double value : every_exponent(GetParam()))
    if (!bound.holds(value) && !std::isnan(value)) values.push_back(value);
  for (const double value :
       {static_cast<double>(std::numeric_limits<std::int32_t>::max()),
        static_cast<double>(std::numeric_limits<std::int32_t>::min()),
        static_cast<double>(std::numeric_limits<float>::max()),
        std::numeric_limits<double>::infinity(), std::nextafter(kMaxAccel, 1e3)})
    values.push_back(value);
  constexpr int kApart = 20;  // instants
  shake(static_cast<double>(values.size()) * kApart / kRate_hz + 1);
  std::vector<Attack> attacks;
  for (std::size_t i = 0; i < values.size(); ++i)
    attacks.push_back({kFirst + kApart * static_cast<int>(i),
                       static_cast<int>(i % static_cast<std::size_t>(accel_.cols())),
                       {values[i]}});
  const Said said = run(attacks);
  expect_unmoved(said, attacks, false, kMaxMovedByLosses);
  EXPECT_EQ(absurd(said), static_cast<std::int64_t>(values.size()));
  EXPECT_EQ(said.counters.interruptions, 0);
}

TEST_P(AbsurdSamples, WithinTheBoundLeaveNoTrace) {
  std::vector<double> values{0.0,    -0.0,   kNan, std::numeric_limits<double>::denorm_min(),
                             1e-300, -1e-30, -200, 150};
  for (int exponent = -12; exponent <= 7; ++exponent)
    values.push_back((exponent % 2 == 0 ? 1.5 : -1.5) * std::ldexp(1.0, exponent));
  constexpr int kApart_s = 14;
  shake(static_cast<double>(values.size()) * kApart_s);
  std::vector<Attack> attacks;
  for (std::size_t i = 0; i < values.size(); ++i)
    attacks.push_back({kFirst + kApart_s * static_cast<int>(kRate_hz) * static_cast<int>(i),
                       static_cast<int>(i % static_cast<std::size_t>(accel_.cols())),
                       {values[i]}});
  expect_unmoved(run(attacks), attacks, true, 1);
}

TEST_P(AbsurdSamples, ASecondOfThemLeavesNoTrace) {
  constexpr int kRow = 100;
  constexpr int kApart_s = 16;
  std::mt19937_64 random(7);
  std::vector<std::vector<double>> rows;
  for (const double value : {kNan, std::numeric_limits<double>::infinity(), 1e300, -3.4e38, 1e9,
                             1e4, 150.0, -40.0, 5e-324, 0.0, 2147483647.0, 8.0, -3.0, 0.7})
    rows.emplace_back(kRow, value);
  for (int any = 0; any < 6; ++any) {
    rows.emplace_back();
    for (int i = 0; i < kRow; ++i) rows.back().push_back(std::bit_cast<double>(random()));
  }
  rows.emplace_back();
  for (int i = 0; i < kRow; ++i) rows.back().push_back(i % 2 == 0 ? 1e300 : -0.01);
  shake(static_cast<double>(rows.size()) * kApart_s);
  std::vector<Attack> attacks;
  for (std::size_t i = 0; i < rows.size(); ++i)
    attacks.push_back({kFirst + kApart_s * static_cast<int>(kRate_hz) * static_cast<int>(i),
                       static_cast<int>(i % static_cast<std::size_t>(accel_.cols())), rows[i]});
  expect_unmoved(run(attacks), attacks, true, kMaxMovedByLosses);
}

/// Wrong stamps of one channel, once or for a second, silence nothing for long.
TEST_P(AbsurdSamples, StampsOfOneChannelSilenceOthersOnlyBriefly) {
  constexpr int kApart_s = 16, kAxis = 3;
  std::vector<std::pair<double, int>> attacks;  // seconds ahead, samples
  for (const double ahead_s : {0.3, 0.55, 0.8, 1.05, 10.0, 1e9, -0.3, -0.8, -1e9})
    for (const int samples : {1, 100}) attacks.emplace_back(ahead_s, samples);
  shake(static_cast<double>(attacks.size()) * kApart_s);
  std::vector<double> shown_s(clean_.estimates.begin()->second.value.size(), kFirst / kRate_hz);
  double silence = 0;
  const auto take = [&](const WindowEstimate& e) {
    const double end_s = 1e-6 * static_cast<double>(to_microseconds(e.end));
    const auto clean = clean_.estimates.lower_bound({0, to_microseconds(e.end) - 6000});
    for (std::size_t p = 0; p < shown_s.size(); ++p) {
      if (std::isfinite(e.value[p]) || !std::isfinite(clean->second.value[p])) shown_s[p] = end_s;
      silence = std::max(silence, end_s - shown_s[p]);
    }
  };
  Pipeline pipeline(config_);
  for (int t = 0; t < accel_.rows(); ++t)
    for (int axis = 0; axis < accel_.cols(); ++axis) {
      AccelSample sample = test::sample_at(accel_, kRate_hz, t, axis);
      const int since = t - kFirst, place = since / (kApart_s * static_cast<int>(kRate_hz));
      if (axis == kAxis && since >= 0 && place < static_cast<int>(attacks.size())) {
        const auto [ahead_s, samples] = attacks[static_cast<std::size_t>(place)];
        if (since % (kApart_s * static_cast<int>(kRate_hz)) < samples)
          sample.time += SensorClock::duration(std::llround(1e6 * ahead_s));
      }
      each_main_window(pipeline.push(sample), take);
    }
  each_main_window(pipeline.finish(), take);
  EXPECT_LE(silence, kMaxSilence_s);
  const AxisCounters c = pipeline.counters().axes[kAxis];
  EXPECT_GT(c.rejected + c.late, 500);
}

INSTANTIATE_TEST_SUITE_P(NoiseDensity, AbsurdSamples, testing::Bool(),
                         [](const auto& given) { return given.param ? "configured" : "measured"; });

}  // namespace absurd_samples_test
}  // namespace framewatch::estimator
