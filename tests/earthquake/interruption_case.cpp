// SPDX-License-Identifier: MIT
#include "tests/earthquake/interruption_case.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <fmt/core.h>

#include "estimator/pipeline/pipeline.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/group_design.h"

namespace framewatch::earthquake {
namespace {

constexpr double kRate_hz = 100;
constexpr double kDesignOff = 0.3;
constexpr double kBuildUp_s = 0.2;               // the motion is strong at once
constexpr double kEarliest_s = 8, kOver_s = 10;  // strong motion before the instant
constexpr double kMinRest_s = 3, kMaxRest_s = 5;
constexpr double kWatched_s = 10.05;     // after the instant
constexpr int kAway = 5;                 // seconds of each absence when a channel comes and goes
constexpr int kEvery = 10;               // hops between values that are counted
constexpr double kErrorWithin_s = 0.26;  // 1-s windows are a quarter of a second apart
constexpr double kRounding_s = 1e-6;     // of instants
constexpr std::array<double, 5> kLengths_s{0.05, 0.5, 2, 10, 60};

/// The channels' measurements, and which samples the pipeline gets.
struct Record {
  Eigen::MatrixXd accel;                       ///< instants x axes, m/s^2
  double from_s = 0, zero_s = 0;               ///< of the interruption; times count from its end
  std::function<bool(double, int)> delivered;  ///< (time, axis)
};

estimator::PlanMotion ground(double rest_s, double duration_s, std::uint64_t seed) {
  estimator::KanaiTajimi k;
  k.duration_s = duration_s - rest_s + 1;
  k.build_up_s = kBuildUp_s;
  k.strong_s = k.duration_s;
  k.step_s = 1e-3;
  k.seed = seed;
  estimator::GroundMotion motion = kanai_tajimi(k);
  motion.accel.insert(motion.accel.begin(), static_cast<std::size_t>(rest_s / k.step_s), 0.0);
  return directed(motion, std::numbers::pi / 4);
}

Record make_record(const InterruptionCase& of, estimator::PipelineConfig& config) {
  Record out;
  estimator::Random random(of.seed, 11);
  const double start_s = kEarliest_s + kOver_s * random.uniform();
  const double rest = kMinRest_s + (kMaxRest_s - kMinRest_s) * random.uniform();
  const int axis = static_cast<int>(random.uniform() * static_cast<double>(config.axes.size()));
  const bool at_rest = of.kind == Interruption::starts_at_rest;
  const double rest_s = at_rest ? std::round(rest * kRate_hz) / kRate_hz : 0;
  const double from_s = at_rest ? rest_s : std::round(start_s * kRate_hz) / kRate_hz;
  const double length_s = of.kind == Interruption::comes_and_goes ? 2 * kAway - 1 : of.length_s;
  out.from_s = from_s, out.zero_s = from_s + length_s;
  const double half_s = 0.5 / kRate_hz;  // instants are compared between samples
  const auto inside = [=](double t) { return t > from_s - half_s && t < out.zero_s - half_s; };
  switch (of.kind) {
    case Interruption::none:
    case Interruption::starts_at_rest:
      out.delivered = [](double, int) { return true; };
      break;
    case Interruption::starts_in_motion:
      out.delivered = [=](double t, int) { return t > from_s - half_s; };
      break;
    case Interruption::all_missing:
      out.delivered = [=](double t, int) { return !inside(t); };
      break;
    case Interruption::one_missing:
      out.delivered = [=](double t, int a) { return a != axis || !inside(t); };
      break;
    case Interruption::comes_and_goes:
      out.delivered = [=](double t, int a) {
        return a != axis || !inside(t) || std::fmod(t - from_s + half_s, 2) >= 1;
      };
  }
  const double duration_s = out.zero_s + kWatched_s;
  const estimator::Structure& s = config.structure;
  estimator::ResponseOptions options;
  options.rate_hz = kRate_hz;
  estimator::ResponseStream response(s, estimator::ParameterTable(s), config.design,
                                     ground(rest_s, duration_s, of.seed), options, {},
                                     response_channels(s, config.axes));
  const auto axes = static_cast<Eigen::Index>(config.axes.size());
  out.accel.resize(std::lround(duration_s * kRate_hz) + 1, axes);
  for (Eigen::Index i = 0; i < out.accel.rows(); ++i)
    out.accel.row(i) = response.next().head(axes).transpose();
  std::vector<double> sigma;
  const Eigen::Index strong = out.accel.rows() - std::lround(rest_s * kRate_hz);
  for (Eigen::Index a = 0; a < axes; ++a) {
    const double rms = std::sqrt(out.accel.col(a).tail(strong).array().square().mean());
    sigma.push_back(of.noise_ratio * rms);
    estimator::Random noise(of.seed, 100 + static_cast<std::uint64_t>(a));
    for (double& value : out.accel.col(a)) value += sigma.back() * noise.normal();
  }
  for (double& v : sigma) v = std::max(v, 1e-9);  // rows need weights even without noise
  set_noise(sigma, config);
  return out;
}

ParameterGroup group_of(estimator::ParameterKind kind) {
  if (kind == estimator::ParameterKind::frame_stiffness) return stiffnesses;
  return kind == estimator::ParameterKind::panel_stiffness ? panels : dampings;
}

/// Collects the published values.
class Collector {
 public:
  Collector(const estimator::ParameterTable& table, Eigen::VectorXd truth, const Record& record)
      : table_(table), truth_(std::move(truth)), from_s_(record.from_s), zero_s_(record.zero_s) {
    for (int p = 0; p < table_.size(); ++p) ++out_.wanted[group(p)];
  }

  void newest(double time_s) { now_s_ = time_s; }
  void take(const estimator::WindowEstimate& e);
  const InterruptionResult& result() const { return out_; }

 private:
  std::size_t group(int p) const { return static_cast<std::size_t>(group_of(table_[p].kind)); }
  static bool shown(const estimator::WindowEstimate& e, int p) {
    return e.reason[static_cast<std::size_t>(p)] == estimator::Observability::observable;
  }
  void count(const estimator::WindowEstimate& e, double at_s);
  void measure(const estimator::WindowEstimate& e, double at_s);

  const estimator::ParameterTable& table_;
  Eigen::VectorXd truth_;
  double from_s_, zero_s_, now_s_ = 0;
  InterruptionResult out_;
  std::array<std::array<bool, kErrorAt_s.size()>, 2> measured_{};
};

void Collector::take(const estimator::WindowEstimate& e) {
  if (e.status != estimator::WindowStatus::valid) return;
  const double at_s = 1e-6 * static_cast<double>(to_microseconds(e.end)) - zero_s_;
  if (at_s > kUntil_s.back() || at_s + zero_s_ < from_s_ - kRounding_s) return;
  const int stiffness_count = out_.wanted[stiffnesses];
  int seen = 0;
  for (int p = 0; p < table_.size(); ++p) seen += group(p) == stiffnesses && shown(e, p) ? 1 : 0;
  if (at_s > -kRounding_s) {
    FirstWindow& first = out_.first[static_cast<std::size_t>(e.window)];
    const double end_s = std::max(0.0, at_s);
    if (seen > 0 && end_s < first.any_s) first.any_s = end_s, first.published_s = now_s_ - zero_s_;
    if (seen == stiffness_count) first.all_s = std::min(first.all_s, end_s);
    const auto slot = static_cast<long>(std::floor((at_s - kSlotsFrom_s) / kSlot_s));
    if (seen > 0 && slot >= 0 && slot < kSlots)
      out_.shown[static_cast<std::size_t>(e.window)][static_cast<std::size_t>(slot)] = true;
    measure(e, at_s);
  }
  if (e.window != kMain || std::lround(at_s * kRate_hz) % kEvery == 0) count(e, at_s);
}

void Collector::count(const estimator::WindowEstimate& e, double at_s) {
  const auto bin =
      std::lower_bound(kUntil_s.begin(), kUntil_s.end() - 1, at_s - kRounding_s) - kUntil_s.begin();
  auto& tallies = out_.tally[static_cast<std::size_t>(e.window)][static_cast<std::size_t>(bin)];
  for (int p = 0; p < table_.size(); ++p) {
    if (!shown(e, p)) continue;
    const auto i = static_cast<std::size_t>(p);
    const double z = (e.value[i] - truth_[p]) / e.std_error[i];
    Tally& tally = tallies[group(p)];
    tally.count += 1, tally.square_sum += z * z;
    tally.held += std::abs(z) <= 1.96 ? 1 : 0;
  }
}

void Collector::measure(const estimator::WindowEstimate& e, double at_s) {
  if (e.window != kMain && e.window != kShort) return;
  const std::size_t of = e.window == kMain ? 0 : 1;
  for (std::size_t t = 0; t < kErrorAt_s.size(); ++t) {
    const double since = at_s - kErrorAt_s[t];
    if (measured_[of][t] || since < -kRounding_s || since > kErrorWithin_s) continue;
    measured_[of][t] = true;
    for (int p = 0; p < table_.size(); ++p)
      if (shown(e, p))
        out_.error[of][t][group(p)].push_back(
            std::abs(e.value[static_cast<std::size_t>(p)] / truth_[p] - 1));
  }
}

}  // namespace

const std::vector<StudyBuilding>& interruption_buildings() {
  static const std::vector<StudyBuilding> all{three_stories(), two_stories_in_space(),
                                              stories_with_channels(20, {5, 10, 15, 20})};
  return all;
}

std::vector<InterruptionCase> interruption_cases(int seeds, std::uint64_t first) {
  std::vector<InterruptionCase> out;
  for (int building = 0; building < static_cast<int>(interruption_buildings().size()); ++building)
    for (const bool off : {false, true})
      for (int i = 0; i < seeds; ++i) {
        const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
        const auto add = [&](Interruption kind, double length_s) {
          out.push_back({building, off, kind, length_s, seed});
        };
        add(Interruption::none, 0);
        add(Interruption::starts_at_rest, 0);
        add(Interruption::starts_in_motion, 0);
        for (const double length_s : kLengths_s) {
          add(Interruption::all_missing, length_s);
          add(Interruption::one_missing, length_s);
        }
        add(Interruption::comes_and_goes, 0);
      }
  return out;
}

std::string text_of(Interruption kind, double length_s) {
  switch (kind) {
    case Interruption::none:
      return "no interruption";
    case Interruption::starts_at_rest:
      return "record begins at rest";
    case Interruption::starts_in_motion:
      return "record begins in motion";
    case Interruption::all_missing:
      return fmt::format("all channels missing for {:g} s", length_s);
    case Interruption::one_missing:
      return fmt::format("one channel missing for {:g} s", length_s);
    case Interruption::comes_and_goes:
      return "one channel comes and goes";
  }
  return "";
}

InterruptionResult run_interruption(const InterruptionCase& of) {
  estimator::PipelineConfig config =
      interruption_buildings()[static_cast<std::size_t>(of.building)].config;
  const estimator::ParameterTable table = config.parameters();
  const Record record = make_record(of, config);
  const Eigen::VectorXd truth = table.grouped()
                                    ? group_parameters(config.structure, table, {config.design, {}})
                                    : config.design;
  if (of.design_off) config.design = design_off(config, kDesignOff, of.seed);
  Collector collector(table, truth, record);
  const auto take = [&](const estimator::WindowEstimate& e) { collector.take(e); };
  estimator::Pipeline pipeline(config);
  for (Eigen::Index i = 0; i < record.accel.rows(); ++i) {
    const double time_s = static_cast<double>(i) / kRate_hz;
    collector.newest(time_s);
    for (int a = 0; a < record.accel.cols(); ++a)
      if (record.delivered(time_s, a))
        estimator::each_window(
            pipeline.push(
                {estimator::from_microseconds(std::llround(1e6 * time_s)), a, record.accel(i, a)}),
            take);
  }
  estimator::each_window(pipeline.finish(), take);
  return collector.result();
}

}  // namespace framewatch::earthquake
