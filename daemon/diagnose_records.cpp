#include "daemon/diagnose_records.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/core.h>

#include "daemon/estimation.h"
#include "daemon/file_digest.h"
#include "daemon/stretch_collector.h"
#include "drivers/accel_intake.h"
#include "drivers/lcm_log.h"
#include "drivers/record_file.h"

namespace framewatch::daemon {
namespace {

constexpr Eigen::Index kLeastInstants = 400;
constexpr int kLongestGap = 3;  ///< samples that are bridged
constexpr double kEverything_s = 1e9;

constexpr double kMoving = 0.1;      ///< rms of the first second over that of all
constexpr double kLead_s = 40;       ///< at most; half of the record at most
constexpr double kTrainShare = 0.6;  ///< of a gap event's samples, its lead among them

Eigen::Index lead_of(Eigen::Index instants, double rate_hz) {
  return std::min(static_cast<Eigen::Index>(kLead_s * rate_hz), instants / 2);
}

bool begins_in_motion(const Config& config, const DiagnoseRecord& record) {
  const auto second = std::min(static_cast<Eigen::Index>(record.rate_hz), record.accel.rows());
  double first = 0, all = 0;
  for (std::size_t a = 0; a < config.pipeline.axes.size(); ++a) {
    if (config.pipeline.axes[a].story == 0) continue;
    const auto column = record.accel.col(static_cast<Eigen::Index>(a)).array();
    const double mean = column.mean();
    first += (column.head(second) - mean).square().mean();
    all += (column - mean).square().mean();
  }
  return first > kMoving * kMoving * all;
}

std::string digest(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return sha256({std::istreambuf_iterator<char>(in), {}});
}

/// As wide as the channels, and the force of a component test.
bool from_record(const Config& config, const ComponentTest& component, DiagnoseRecord& out,
                 std::vector<std::string>& problems) {
  std::vector<drivers::Problem> found;
  const auto record = drivers::read_record(out.path, {}, found);
  for (const drivers::Problem& p : found)
    problems.push_back(fmt::format("{}: {}", p.where, p.message));
  if (!record) return false;
  const auto& axes = config.pipeline.axes;
  out.rate_hz = record->rate_hz;
  out.accel.resize(static_cast<Eigen::Index>(record->time_s.size()),
                   static_cast<Eigen::Index>(axes.size() + (component.force.empty() ? 0 : 1)));
  bool complete = true;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const SensorAxis& axis = axes[a];
    std::size_t column = 0;
    while (column < record->names.size() && record->names[column] != axis.name) ++column;
    if (column == record->names.size() && component.any() && axis.story == 0) {
      out.accel.col(static_cast<Eigen::Index>(a)).setZero();
      continue;
    }
    if (column == record->names.size()) {
      problems.push_back(fmt::format("{}: no channel '{}'", out.path, axis.name));
      complete = false;
      continue;
    }
    for (Eigen::Index i = 0; i < out.accel.rows(); ++i)
      out.accel(i, static_cast<Eigen::Index>(a)) =
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
    for (Eigen::Index i = 0; i < out.accel.rows(); ++i)
      out.accel(i, out.accel.cols() - 1) = force[static_cast<std::size_t>(i)];
  }
  return complete;
}

bool from_log(const Config& config, DiagnoseRecord& out, std::vector<std::string>& problems) {
  StretchCollector collector(config.pipeline, 0, kEverything_s);
  drivers::AccelIntake intake(wanted_axes(config),
                              [&](const AccelSample& sample) { collector.push(sample); });
  drivers::LcmLogReader reader;
  drivers::LogEvent event;
  auto read = reader.open(out.path) ? reader.next(event) : drivers::LogRead::error;
  for (; read != drivers::LogRead::end && read != drivers::LogRead::error;
       read = reader.next(event))
    if (read == drivers::LogRead::event)
      intake.message(event.channel, event.data.data(), event.data.size());
  if (read == drivers::LogRead::error) {
    problems.push_back(fmt::format("{}: {}", out.path, reader.error()));
    return false;
  }
  collector.finish();
  out.rate_hz = config.pipeline.options.rate_hz;
  out.accel = collector.accel();
  if (collector.started()) return true;
  problems.push_back(fmt::format("{}: holds no sample of the configuration's channels", out.path));
  return false;
}

std::string name_of_column(const Config& config, const ComponentTest& component, Eigen::Index a) {
  const auto at = static_cast<std::size_t>(a);
  return at < config.pipeline.axes.size() ? config.pipeline.axes[at].name : component.force;
}

/// Bridges short gaps by straight lines; longer ones are a problem.
void bridge(const Config& config, const ComponentTest& component, DiagnoseRecord& record,
            std::vector<std::string>& problems) {
  for (Eigen::Index a = 0; a < record.accel.cols(); ++a) {
    Eigen::Index last = -1;
    for (Eigen::Index i = 0; i <= record.accel.rows(); ++i) {
      const bool end = i == record.accel.rows();
      if (!end && !std::isfinite(record.accel(i, a))) continue;
      const Eigen::Index missing = i - last - 1;
      if (missing > kLongestGap) {
        problems.push_back(fmt::format("{}: channel '{}': {} samples missing after {:.3f} s",
                                       record.path, name_of_column(config, component, a), missing,
                                       static_cast<double>(last + 1) / record.rate_hz));
        break;
      }
      for (Eigen::Index k = last + 1; k < i; ++k) {
        const double from = last >= 0 ? record.accel(last, a) : (end ? 0 : record.accel(i, a));
        const double to = end ? from : record.accel(i, a);
        record.accel(k, a) =
            from + (to - from) * static_cast<double>(k - last) / static_cast<double>(missing + 1);
      }
      last = i;
    }
  }
}

}  // namespace

std::optional<DiagnoseRecord> read_diagnose_record(const Config& config, const std::string& path,
                                                   const ComponentTest& component,
                                                   std::vector<std::string>& problems) {
  DiagnoseRecord out;
  out.path = path;
  const std::size_t before = problems.size();
  if (!std::ifstream(path)) {
    problems.push_back(path + ": cannot be opened");
    return std::nullopt;
  }
  const bool read = drivers::is_event_log(path) ? from_log(config, out, problems)
                                                : from_record(config, component, out, problems);
  if (!read) return std::nullopt;
  if (out.accel.rows() < kLeastInstants)
    problems.push_back(fmt::format("{}: {} instants are too short, at least {} are needed", path,
                                   out.accel.rows(), kLeastInstants));
  bridge(config, component, out, problems);
  out.sha256 = digest(path);
  if (problems.size() > before) return std::nullopt;
  if (!component.any() && begins_in_motion(config, out))
    out.lead = lead_of(out.accel.rows(), out.rate_hz);
  return out;
}

std::vector<DiagnoseRecord> read_event_records(const Config& config, const std::string& event,
                                               std::vector<std::string>& problems) {
  if (!config.gap || config.gap->store.empty()) {
    problems.push_back(config.path + ": --event needs [gap] store: nothing is stored");
    return {};
  }
  const std::string path = config.gap->store + "/gap-" + event + ".lcmlog";
  const auto whole = read_diagnose_record(config, path, {}, problems);
  if (!whole) return {};
  const Eigen::Index rows = whole->accel.rows();
  const auto train = static_cast<Eigen::Index>(kTrainShare * static_cast<double>(rows));
  std::vector<DiagnoseRecord> out(2, *whole);
  out[0].accel = whole->accel.topRows(train);
  out[0].lead = std::min(whole->lead, train / 2);
  out[1].lead = lead_of(2 * train, whole->rate_hz);
  out[1].accel = whole->accel.bottomRows(rows - train + out[1].lead);
  out[0].path += ", first part";
  out[1].path += ", second part";
  return out;
}

}  // namespace framewatch::daemon
