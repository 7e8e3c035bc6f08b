#include "daemon/tools/diagnosis/diagnose_records.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
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
constexpr int kMaxMissing = 3;  ///< successive samples that are interpolated
constexpr double kEverything_s = 1e9;

constexpr double kSameInstant = 1e-6;  ///< of a sample

constexpr double kMoving = 0.1;      ///< rms of the first second over that of all
constexpr double kLead_s = 40;       ///< at most; half of the record at most
constexpr double kTrainShare = 0.6;  ///< of a gap event's samples, the lead included

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
  bool complete = true;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const estimator::SensorAxis& axis = axes[a];
    std::size_t column = 0;
    while (column < record->names.size() && record->names[column] != axis.name) ++column;
    if (column == record->names.size() && component.any() && axis.story == 0) {
      out.samples.accel.col(static_cast<Eigen::Index>(a)).setZero();
      continue;
    }
    if (column == record->names.size()) {
      problems.push_back(fmt::format("{}: no channel '{}'", out.path, axis.name));
      complete = false;
      continue;
    }
    for (Eigen::Index i = 0; i < out.samples.accel.rows(); ++i)
      out.samples.accel(i, static_cast<Eigen::Index>(a)) =
          axis.polarity *
          (axis.scale * record->accel_mps2[column][static_cast<std::size_t>(i)] - axis.offset);
  }
  if (!component.force.empty()) {
    const auto at = std::find(record->names.begin(), record->names.end(), component.force);
    if (at == record->names.end()) {
      problems.push_back(fmt::format("{}: no channel '{}'", out.path, component.force));
      return false;
    }
    const std::vector<double>& force =
        record->accel_mps2[static_cast<std::size_t>(at - record->names.begin())];
    for (Eigen::Index i = 0; i < out.samples.accel.rows(); ++i)
      out.samples.accel(i, out.samples.accel.cols() - 1) = force[static_cast<std::size_t>(i)];
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

/// Interpolates short runs of missing samples linearly; longer ones are a problem.
void interpolate(const Config& config, const estimator::ComponentTest& component,
                 DiagnoseRecord& record, std::vector<std::string>& problems) {
  for (Eigen::Index a = 0; a < record.samples.accel.cols(); ++a) {
    Eigen::Index last = -1;
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
      last = i;
    }
  }
}

/// Takes the whole samples of the channels' delays off the columns, as an acquisition takes them
/// off the stamps of a log. Instants that not every channel has are cut away.
void take_whole_delays(const Config& config, estimator::RecordSamples& samples) {
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

/// Empty when there is a problem.
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
  interpolate(config, component, out, problems);
  if (!log && problems.size() == before) take_whole_delays(config, out.samples);
  if (out.samples.accel.rows() < kMinInstants)
    problems.push_back(fmt::format("{}: {} instants are too short, at least {} are needed", path,
                                   out.samples.accel.rows(), kMinInstants));
  out.sha256 = sha256_of_file(path);
  if (problems.size() > before) return std::nullopt;
  if (!component.prescribed && begins_in_motion(config, out))
    out.samples.lead = lead_of(out.samples.accel.rows(), out.samples.rate_hz);
  return out;
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
    problems.push_back(config.path + ": --event needs [gap] store: nothing is stored");
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

}  // namespace framewatch::daemon
