#include "fleet/archive/reidentify.h"

#include <algorithm>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/first_passes.h"
#include "daemon/tools/replay/history_output.h"
#include "daemon/tools/replay/replay_survey.h"

namespace framewatch::fleet {
namespace {

constexpr double kAfter_s = 10;  // until the last window of the task is out
constexpr std::size_t kMaxNotes = 20;

daemon::ReplaySpan span_of(const ArchiveTask& task) {
  const auto length_us = static_cast<double>(task.to_us - task.warm_up_us);
  return {0, length_us * 1e-6 + kAfter_s, task.warm_up_us};
}

}  // namespace

Reidentified reidentify(const daemon::Config& config, const ArchiveTask& task,
                        const std::string& path) {
  Reidentified out;
  daemon::HistoryOutput history(config);
  const std::int64_t longest_us = history.longest_s() * daemon::kSecond_us;
  if (task.from_us % longest_us != 0 || task.to_us % longest_us != 0) {
    out.problem = fmt::format("begin and end are no multiples of the longest summary, {} s",
                              history.longest_s());
    return out;
  }
  history.keep(task.from_us, task.to_us);
  if (!history.open(path)) {
    out.problem = path + ": " + history.error();
    return out;
  }
  bool taken = true;
  daemon::Estimation estimation(config, [&](std::int64_t time_us, const std::string& channel,
                                            const std::vector<std::uint8_t>& bytes) {
    taken = taken && history.put(time_us, channel, bytes);
  });
  const daemon::FirstPasses first(config, {task.logs, {}, true, span_of(task)});
  if (first.tuning()) estimation.start_tuned(*first.tuning());
  out.passes = first.passes() + 1;
  fmt::print(stderr, "task {}: {}\n", task.number, first.note());
  daemon::ReplaySurvey survey(config, true, span_of(task));
  survey.feed(estimation);
  for (const std::string& log : task.logs)
    if (survey.problems().empty() && taken) survey.add(log);
  estimation.finish();
  out.notes = survey.notes();
  if (out.notes.size() > kMaxNotes) {
    out.notes.resize(kMaxNotes);
    out.notes.push_back("what else is to be said is left out");
  }
  out.windows = estimation.windows();
  out.instants = estimation.pipeline().counters().sample_sets;
  out.damaged_bytes = survey.damaged_bytes();
  out.measured_s = survey.any_sample() ? survey.measured_seconds() : 0;
  if (!survey.problems().empty())
    out.problem = survey.problems().front();
  else if (!history.close())
    out.problem = path + ": " + history.error();
  return out;
}

}  // namespace framewatch::fleet
