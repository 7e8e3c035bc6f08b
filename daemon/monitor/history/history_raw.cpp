#include "daemon/monitor/history/history_raw.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/monitor/history/raw_export.h"
#include "daemon/monitor/history/raw_history_reader.h"
#include "drivers/files/standard_streams.h"
#include "drivers/lcm/count_block.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kProgressSamples = 1 << 14;

class RawJob {
 public:
  RawJob(const HistoryArguments& arguments, const HistoryRequest& request,
         std::vector<std::string>& problems)
      : a_(arguments), request_(request), problems_(problems) {}

  void run() {
    (*progress_)("looking what there is", 0);
    const std::vector<RawLog> logs =
        raw_logs_between(request_.directory, request_.from_us, request_.to_us);
    // What is in them first: an export has all of its channels from the start.
    std::vector<std::string> names;
    double rate_hz = 0, resolution_mps2 = 0;
    std::int64_t samples = 0;
    std::vector<std::string> notes;
    std::string why;
    const auto fails = [&] {
      problem(why);
      return;
    };
    if (!read_raw_history(logs, request_.from_us, request_.to_us,
                          {[&](const auto& now, double rate) {
                             for (const std::string& name : now)
                               if (std::find(names.begin(), names.end(), name) == names.end())
                                 names.push_back(name);
                             if (rate_hz == 0) rate_hz = rate;
                           },
                           [&](const RawCount& c) {
                             ++samples;
                             if (resolution_mps2 == 0) resolution_mps2 = c.resolution_mps2;
                           }},
                          notes, why))
      return fails();
    check_patterns("--channel", a_.channels, names, problems_);
    if (samples == 0) problem("there are no raw samples in that time");
    if (!problems_.empty()) return;
    std::vector<RawChannel> channels;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (is_chosen(a_.channels, names[i])) channels.push_back(placed(names[i], i));
    std::erase_if(names, [&](const std::string& name) { return !is_chosen(a_.channels, name); });
    const auto out =
        raw_export(a_.raw, channels, rate_hz, resolution_mps2, {a_.network, a_.station}, why);
    if (!out) return fails();
    expected_ = samples;
    progress_->part_begins();
    write_raw(logs, names, *out);
  }

 private:
  void problem(std::string message) { problems_.push_back(std::move(message)); }

  /// Where the channel of a name travels: where the configuration says, else on a node of its own.
  RawChannel placed(const std::string& name, std::size_t index) const {
    if (request_.config) {
      const auto all = addresses(request_.config->sources);
      for (std::size_t i = 0; i < all.size(); ++i)
        if (request_.config->pipeline.axes[i].name == name) return {name, all[i], i};
    }
    return {name, {"ACCEL", static_cast<std::int32_t>(index), 0}, index};
  }

  void write_raw(const std::vector<RawLog>& logs, const std::vector<std::string>& names,
                 RawExport& out) {
    std::vector<std::optional<std::size_t>> place;  // by the log's channel
    std::int64_t seen = 0, samples = 0, beyond = 0;
    bool good = true;
    std::vector<std::string> notes;
    std::string why;
    const RawVisitor visitor{
        [&](const std::vector<std::string>& now, double) {
          place.assign(now.size(), std::nullopt);
          for (std::size_t i = 0; i < now.size(); ++i)
            if (const auto at = std::find(names.begin(), names.end(), now[i]); at != names.end())
              place[i] = static_cast<std::size_t>(at - names.begin());
        },
        [&](const RawCount& c) {
          if (++seen % kProgressSamples == 0)
            (*progress_)("writing " + a_.raw,
                         static_cast<double>(seen) / static_cast<double>(expected_));
          if (!good || !place[c.channel]) return;
          ++samples;
          beyond += c.count == drivers::kMaxCount || c.count == -drivers::kMaxCount;
          const double accel = c.count == drivers::kNoCount
                                   ? std::numeric_limits<double>::quiet_NaN()
                                   : c.count * c.resolution_mps2;
          good = out.put(*place[c.channel], c.time_us, accel);
        },
        [&](const drivers::LogEvent& event) { good = good && out.message(event); }};
    const bool read = read_raw_history(logs, request_.from_us, request_.to_us, visitor, notes, why);
    if (!read || !good || !out.close()) {
      problem(read ? fmt::format("{}: {}", a_.raw, out.error()) : why);
      return;
    }
    progress_.reset();
    std::FILE* const where = a_.raw == drivers::kStandardOutput ? stderr : stdout;
    fmt::print(where, "{}: {} samples of {} channels\n", a_.raw, samples, names.size());
    if (beyond > 0) fmt::print(where, "{} of them are beyond what was stored\n", beyond);
    for (const std::string& note : notes) fmt::print(where, "{}\n", printable_lines(note));
    for (const std::string& note : out.notes()) fmt::print(where, "{}\n", printable_lines(note));
  }

  const HistoryArguments& a_;
  const HistoryRequest& request_;
  std::vector<std::string>& problems_;
  std::int64_t expected_ = 0;  ///< samples of every channel
  std::optional<ProgressLine> progress_{std::in_place, "history", false};
};

}  // namespace

void export_raw_history(const HistoryArguments& arguments, const HistoryRequest& request,
                        std::vector<std::string>& problems) {
  RawJob(arguments, request, problems).run();
}

}  // namespace framewatch::daemon
