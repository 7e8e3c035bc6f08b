// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_records.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/words.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/estimation/segment_collector.h"
#include "drivers/files/input_file.h"
#include "drivers/formats/record_file.h"
#include "drivers/lcm/accel_intake.h"
#include "drivers/lcm/lcm_log.h"
#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {
namespace {

constexpr Eigen::Index kMinInstants = 400;
constexpr int kMaxMissing = 3;           ///< successive samples that are interpolated
constexpr double kMostMissing = 0.05;    ///< share of a channel's samples that are interpolated
constexpr double kRateTolerance = 0.02;  ///< relative difference from the configured rate
/// Two floors never move more alike. Least 1 - correlation^2 of channels that are not copies.
constexpr double kLeastUnlike = 1e-9;
constexpr double kEverything_s = 1e9;

constexpr double kSameInstant = 1e-6;  ///< of a sample

constexpr double kMoving = 0.1;      ///< rms of the first second over that of all
constexpr double kLead_s = 40;       ///< longest lead, and at most half of the record
constexpr double kTrainShare = 0.6;  ///< share of a gap event's samples, lead included

Eigen::Index lead_of(Eigen::Index instants, double rate_hz) {
  return std::min(static_cast<Eigen::Index>(kLead_s * rate_hz), instants / 2);
}

bool begins_in_motion(const Config& config, const DiagnoseRecord& record) {
  const auto second =
      std::min(static_cast<Eigen::Index>(record.samples.rate_hz), record.samples.accel.rows());
  double first = 0, all = 0;
  for (std::size_t a = 0; a < config.pipeline.axes.size(); ++a) {
    if (config.pipeline.axes[a].story == 0) continue;
    const auto column = record.samples.accel.col(static_cast<Eigen::Index>(a)).array();
    const double mean = column.mean();
    first += (column.head(second) - mean).square().mean();
    all += (column - mean).square().mean();
  }
  return first > kMoving * kMoving * all;
}

/// Reads a record file: the configuration's channels, then the force of a component test.
bool from_record(const Config& config, const estimator::ComponentTest& component,
                 DiagnoseRecord& out, std::vector<std::string>& problems) {
  std::vector<drivers::Problem> found;
  const auto record = drivers::read_record(out.path, {}, found);
  for (const drivers::Problem& p : found)
    problems.push_back(fmt::format("{}: {}", p.where, p.message));
  if (!record) return false;
  const auto& axes = config.pipeline.axes;
  out.samples.rate_hz = record->rate_hz;
  out.samples.accel.resize(
      static_cast<Eigen::Index>(record->time_s.size()),
      static_cast<Eigen::Index>(axes.size() + (component.force.empty() ? 0 : 1)));
  const auto values = [&](auto name) {
    const auto& column = record->accel_mps2[static_cast<std::size_t>(name - record->names.begin())];
    return Eigen::Map<const Eigen::ArrayXd>(column.data(), std::ssize(column));
  };
  bool complete = true;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const estimator::SensorAxis& axis = axes[a];
    const auto at = std::find(record->names.begin(), record->names.end(), axis.name);
    auto column = out.samples.accel.col(static_cast<Eigen::Index>(a));
    if (at == record->names.end() && component.any() && axis.story == 0) {
      column.setZero();
    } else if (at == record->names.end()) {
      problems.push_back(fmt::format("{}: no channel '{}'", out.path, axis.name));
      complete = false;
    } else {
      column = axis.polarity * (axis.scale * values(at) - axis.offset);
    }
  }
  if (!component.force.empty()) {
    const auto at = std::find(record->names.begin(), record->names.end(), component.force);
    if (at == record->names.end()) {
      problems.push_back(fmt::format("{}: no channel '{}'", out.path, component.force));
      return false;
    }
    out.samples.accel.rightCols(1) = values(at);
  }
  return complete;
}

bool from_log(const Config& config, DiagnoseRecord& out, std::vector<std::string>& problems) {
  SegmentCollector collector(config.pipeline, 0, kEverything_s);
  drivers::AccelIntake intake(
      wanted_axes(config), [&](const estimator::AccelSample& sample) { collector.push(sample); },
      intake_settings(config));
  drivers::LcmLogReader reader;
  drivers::LogEvent event;
  auto read = reader.open(out.path) ? reader.next(event) : drivers::LogRead::error;
  for (; read != drivers::LogRead::end && read != drivers::LogRead::error;
       read = reader.next(event))
    if (read == drivers::LogRead::event)
      intake.message(event.channel, event.data.data(), event.data.size(), {}, event.timestamp_us);
  if (read == drivers::LogRead::error) {
    problems.push_back(fmt::format("{}: {}", out.path, reader.error()));
    return false;
  }
  collector.finish();
  out.samples.rate_hz = config.pipeline.options.rate_hz;
  out.samples.accel = collector.accel();
  if (collector.started()) return true;
  problems.push_back(fmt::format("{}: holds no sample of the configuration's channels", out.path));
  return false;
}

std::string name_of_column(const Config& config, const estimator::ComponentTest& component,
                           Eigen::Index a) {
  const auto at = static_cast<std::size_t>(a);
  return at < config.pipeline.axes.size() ? config.pipeline.axes[at].name : component.force;
}

/// Adds a problem if a record of a building has another rate than the configuration.
void check_rate(const Config& config, const DiagnoseRecord& record,
                std::vector<std::string>& problems) {
  const double configured = config.pipeline.options.rate_hz, rate_hz = record.samples.rate_hz;
  if (std::abs(rate_hz / configured - 1) > kRateTolerance)
    problems.push_back(fmt::format("{}: sampled at {:.4g} Hz, but {} says rate_hz = {:g}",
                                   record.path, rate_hz, config.path, configured));
}

/// Adds a problem for each channel that repeats a channel of another floor.
void check_copies(const Config& config, const DiagnoseRecord& record,
                  std::vector<std::string>& problems) {
  const auto& axes = config.pipeline.axes;
  const auto count = static_cast<Eigen::Index>(axes.size());
  Eigen::MatrixXd motion = record.samples.accel.leftCols(count);
  motion.rowwise() -= motion.colwise().mean().eval();
  const auto repeats = [&](std::size_t a, std::size_t b) {
    const auto one = motion.col(static_cast<Eigen::Index>(a)),
               other = motion.col(static_cast<Eigen::Index>(b));
    const double powers = one.squaredNorm() * other.squaredNorm(), product = one.dot(other);
    return axes[a].horizontal() && axes[b].horizontal() && axes[a].story != axes[b].story &&
           axes[a].direction == axes[b].direction && powers > 0 &&
           product * product > (1 - kLeastUnlike) * powers;
  };
  for (std::size_t a = 0; a < axes.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      if (!repeats(a, b)) continue;
      problems.push_back(fmt::format(
          "{}: channel '{}' repeats channel '{}' of another floor: give each its own samples",
          record.path, axes[a].name, axes[b].name));
      break;
    }
}

/// Interpolates short runs of missing samples linearly. Adds a problem for a longer run, and for a
/// channel with too many missing samples.
void interpolate(const Config& config, const estimator::ComponentTest& component,
                 DiagnoseRecord& record, std::vector<std::string>& problems) {
  for (Eigen::Index a = 0; a < record.samples.accel.cols(); ++a) {
    Eigen::Index last = -1, filled = 0;
    for (Eigen::Index i = 0; i <= record.samples.accel.rows(); ++i) {
      const bool end = i == record.samples.accel.rows();
      if (!end && !std::isfinite(record.samples.accel(i, a))) continue;
      const Eigen::Index missing = i - last - 1;
      if (missing > kMaxMissing) {
        problems.push_back(fmt::format("{}: channel '{}': {} samples missing after {:.3f} s",
                                       record.path, name_of_column(config, component, a), missing,
                                       static_cast<double>(last + 1) / record.samples.rate_hz));
        break;
      }
      for (Eigen::Index k = last + 1; k < i; ++k) {
        const double from =
            last >= 0 ? record.samples.accel(last, a) : (end ? 0 : record.samples.accel(i, a));
        const double to = end ? from : record.samples.accel(i, a);
        record.samples.accel(k, a) =
            from + (to - from) * static_cast<double>(k - last) / static_cast<double>(missing + 1);
      }
      filled += missing;
      last = i;
    }
    const Eigen::Index rows = record.samples.accel.rows();
    if (static_cast<double>(filled) > kMostMissing * static_cast<double>(rows))
      problems.push_back(fmt::format(
          "{}: channel '{}': {} of {} samples are missing, {:.0f} % may be", record.path,
          name_of_column(config, component, a), filled, rows, 100 * kMostMissing));
  }
}

/// Shifts the columns by the whole samples of the channels' delays, as an acquisition shifts the
/// stamps of a log. Cuts away instants that a channel does not have.
void remove_whole_delays(const Config& config, estimator::RecordSamples& samples) {
  const auto& axes = config.pipeline.axes;
  Eigen::Index later = 0, earlier = 0;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    double instants =
        estimator::whole_delay_s(axes[a].delay, config.pipeline.options.rate_hz) * samples.rate_hz;
    if (std::abs(instants - std::round(instants)) < kSameInstant) instants = std::round(instants);
    if (instants == 0) continue;
    const auto column = samples.accel.col(static_cast<Eigen::Index>(a));
    samples.accel.col(static_cast<Eigen::Index>(a)) =
        estimator::upsampled(Eigen::VectorXd(column), 1, -instants);
    later = std::max(later, static_cast<Eigen::Index>(std::ceil(instants)));
    earlier = std::max(earlier, static_cast<Eigen::Index>(std::ceil(-instants)));
  }
  const Eigen::Index rows = std::max<Eigen::Index>(0, samples.accel.rows() - later - earlier);
  samples.accel = Eigen::MatrixXd(samples.accel.middleRows(rows > 0 ? earlier : 0, rows));
}

/// Reads one record. Returns nullopt and adds to `problems` when it cannot be used.
std::optional<DiagnoseRecord> read_one(const Config& config, const std::string& path,
                                       const estimator::ComponentTest& component,
                                       std::vector<std::string>& problems) {
  DiagnoseRecord out;
  out.path = path;
  const std::size_t before = problems.size();
  if (const std::string why = drivers::why_no_file(path); !why.empty()) {
    problems.push_back(path + ": cannot be opened: " + why);
    return std::nullopt;
  }
  const bool log = drivers::is_event_log(path);
  const bool read =
      log ? from_log(config, out, problems) : from_record(config, component, out, problems);
  if (!read) return std::nullopt;
  if (!component.any()) check_rate(config, out, problems);
  interpolate(config, component, out, problems);
  if (!component.any() && problems.size() == before) check_copies(config, out, problems);
  if (!log && problems.size() == before) remove_whole_delays(config, out.samples);
  if (out.samples.accel.rows() < kMinInstants)
    problems.push_back(fmt::format("{}: too short: {} instants, at least {} are needed", path,
                                   out.samples.accel.rows(), kMinInstants));
  out.sha256 = sha256_of_file(path);
  if (problems.size() > before) return std::nullopt;
  if (!component.prescribed && begins_in_motion(config, out))
    out.samples.lead = lead_of(out.samples.accel.rows(), out.samples.rate_hz);
  return out;
}

using estimator::ClockOffset;

constexpr std::size_t kMaxNames = 4;

std::string names_of(const estimator::Plant& plant, const std::vector<ClockOffset>& offsets) {
  std::vector<std::string> names;
  for (const ClockOffset& o : offsets)
    names.push_back(plant.axes[static_cast<std::size_t>(o.axis)].name);
  return listed(names, kMaxNames);
}

/// Returns the seconds that a segment needs for the fewest frequencies in its band.
double least_seconds(const estimator::RecordSegment& s) {
  return s.seconds() * static_cast<double>(estimator::kFewestBins) /
         static_cast<double>(std::max<Eigen::Index>(1, s.bins()));
}

void add_clock_problems(const std::string& path, const estimator::Plant& plant,
                        const estimator::RecordSegment& segment,
                        std::vector<std::string>& problems) {
  constexpr double kTogether = 0.1;  ///< s, of channels that one sentence names
  std::map<std::pair<Eigen::Index, long>, std::vector<ClockOffset>> groups;
  for (const ClockOffset& o : clocks_apart(plant, segment))
    groups[{o.base, std::lround(o.seconds / kTogether)}].push_back(o);
  for (const auto& [key, offsets] : groups) {
    double mean = 0;
    for (const ClockOffset& o : offsets) mean += o.seconds / static_cast<double>(offsets.size());
    problems.push_back(fmt::format(
        "{}: clocks apart: {} read {:.2f} s {} than {} in motion so slow that a building follows "
        "its base; measure again with one clock, or set delay_s of the later ones",
        path, names_of(plant, offsets), std::abs(mean), mean > 0 ? "later" : "earlier",
        plant.axes[static_cast<std::size_t>(key.first)].name));
  }
}

}  // namespace

std::vector<DiagnoseRecord> read_diagnose_records(const Config& config,
                                                  const std::vector<std::string>& paths,
                                                  const estimator::ComponentTest& component,
                                                  std::vector<std::string>& problems) {
  std::vector<DiagnoseRecord> out;
  for (const std::string& path : paths)
    if (auto record = read_one(config, path, component, problems))
      out.push_back(std::move(*record));
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (out[i].sha256 == out[j].sha256)
        problems.push_back(out[i].path + ": is the same file as " + out[j].path);
  return out;
}

std::vector<DiagnoseRecord> read_event_records(const Config& config, const std::string& event,
                                               std::vector<std::string>& problems) {
  if (!config.gap || config.gap->store.empty()) {
    problems.push_back(config.path + ": --event needs [gap] store, which is not set");
    return {};
  }
  const std::string path = config.gap->store + "/gap-" + event + ".lcmlog";
  const auto whole = read_one(config, path, {}, problems);
  if (!whole) return {};
  const Eigen::Index rows = whole->samples.accel.rows();
  const auto train = static_cast<Eigen::Index>(kTrainShare * static_cast<double>(rows));
  std::vector<DiagnoseRecord> out(2, *whole);
  out[0].samples.accel = whole->samples.accel.topRows(train);
  out[0].samples.lead = std::min(whole->samples.lead, train / 2);
  out[1].samples.lead = lead_of(2 * train, whole->samples.rate_hz);
  out[1].samples.accel = whole->samples.accel.bottomRows(rows - train + out[1].samples.lead);
  out[0].path += ", first part";
  out[1].path += ", second part";
  return out;
}

ComparedChannels compared_channels(const Config& config, std::vector<DiagnoseRecord>& records) {
  ComparedChannels out;
  std::vector<int> new_place;
  std::vector<Eigen::Index> columns;
  for (const estimator::SensorAxis& axis : config.pipeline.axes) {
    new_place.push_back(axis.check ? -1 : static_cast<int>(out.axes.size()));
    if (axis.check) continue;
    columns.push_back(static_cast<Eigen::Index>(new_place.size()) - 1);
    out.axes.push_back(axis);
    out.axes.back().delay -= estimator::whole_delay_s(axis.delay, config.pipeline.options.rate_hz);
  }
  const auto moved = [&](int& channel) {
    if (channel >= 0) channel = new_place[static_cast<std::size_t>(channel)];
    return channel >= 0;
  };
  for (estimator::SensorAxis& axis : out.axes) moved(axis.cross);
  for (const estimator::Effect& effect : config.effects) {
    estimator::Effect known = effect;
    const bool own = effect.place.channel < 0 || moved(known.place.channel);
    const bool other = effect.place.with_channel < 0 || moved(known.place.with_channel);
    if (own && other) out.known.push_back(known);
  }
  const auto given = static_cast<Eigen::Index>(new_place.size());
  for (DiagnoseRecord& record : records) {
    std::vector<Eigen::Index> kept = columns;
    for (Eigen::Index c = given; c < record.samples.accel.cols(); ++c) kept.push_back(c);
    record.samples.accel = Eigen::MatrixXd(record.samples.accel(Eigen::all, kept));
  }
  return out;
}

void add_segment_problems(const std::string& path, const estimator::DiagnosisInput& input,
                          std::size_t record, const estimator::ComponentTest& component,
                          std::vector<std::string>& problems) {
  const estimator::RecordSegment& s = input.segments[record];
  const estimator::SegmentFault fault = fault_of(input.plant, s, component);
  if (fault == estimator::SegmentFault::too_short)
    problems.push_back(
        fmt::format("{}: too short: {} frequencies lie in the building's band, at least {} are "
                    "needed; measure {:.0f} s or more",
                    path, s.bins(), estimator::kFewestBins, std::ceil(least_seconds(s))));
  else if (fault == estimator::SegmentFault::no_excitation)
    problems.push_back(path +
                       ": no excitation: the floors' motion does not exceed the sensors' noise; "
                       "measure stronger motion, or with quieter sensors");
  else if (!component.any())
    add_clock_problems(path, input.plant, s, problems);
}

}  // namespace framewatch::daemon
