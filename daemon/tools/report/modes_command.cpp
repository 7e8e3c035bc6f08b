// SPDX-License-Identifier: MIT
#include "daemon/tools/report/modes_command.h"

#include <cmath>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/base/json.h"
#include "daemon/base/numbers.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/tools/replay/replayed_estimates.h"
#include "daemon/tools/report/modes_output.h"

namespace framewatch::daemon {
namespace {

/// Returns the median of every parameter over the windows within a stretch; NaN without a value.
std::vector<double> medians(const EstimateArrays& estimates, int parameters, std::int64_t from_us,
                            std::int64_t to_us) {
  std::vector<double> out;
  for (int p = 0; p < parameters; ++p) {
    std::vector<double> values;
    for (std::size_t w = 0; w < estimates.end_us.size(); ++w) {
      const double value =
          estimates.value[w * static_cast<std::size_t>(parameters) + static_cast<std::size_t>(p)];
      if (estimates.start_us[w] >= from_us && estimates.end_us[w] <= to_us) values.push_back(value);
    }
    out.push_back(median(values));
  }
  return out;
}

}  // namespace

int modes(const ModesArguments& a) {
  std::vector<ConfigProblem> config_problems;
  const std::optional<Config> config = load_config(a.config, config_problems);
  print_problems(config_problems);
  if (!config) return kBadInput;
  if (a.to_s >= 0 && !(a.to_s > a.from_s)) return refuse("modes", "--to must be later than --from");
  ProgressLine progress("modes", a.json);
  progress.follow_reading("reading the record", a.inputs, 1);
  std::vector<std::string> problems;
  const std::optional<SessionMotion> motion =
      read_session_motion(*config, a.inputs, problems, a.record);
  for (const std::string& problem : problems) fmt::print(stderr, "{}\n", printable_lines(problem));
  if (!motion) return kBadInput;
  for (const std::string& note : motion->notes) fmt::print(stderr, "{}\n", printable_lines(note));
  const auto row_at = [&](double seconds) {
    return motion->row_at(motion->first_us + std::llround(1e6 * seconds));
  };
  const Eigen::Index from = row_at(a.from_s),
                     to = a.to_s < 0 ? motion->accel.rows() : row_at(a.to_s);
  if (to - from < 2)
    return refuse("modes",
                  fmt::format("--from {:g} is after the record's end at {:.2f} s", a.from_s,
                              static_cast<double>(motion->accel.rows() - 1) / motion->rate_hz));
  progress.part_begins();
  const TuningInput input{a.inputs, a.record, true};
  const ReplayedEstimates replayed = replay_estimates(
      *config, input, false, [&](const char* what, double share) { progress(what, share); });
  progress.part_begins();
  progress("refining the model", 0);
  const RecordModes found =
      record_modes(*config, *motion,
                   medians(replayed.arrays, config->pipeline.parameters().size(),
                           motion->time_us(from), motion->time_us(to)),
                   from, to);
  for (const auto& [path, write] :
       {std::pair{a.csv, &write_modes_csv}, std::pair{a.mat, &write_modes_mat}}) {
    const std::string problem = path.empty() ? "" : write(found, path);
    if (!problem.empty()) return refuse("modes", problem);
  }
  if (a.json) {
    Json out{{"schema", "framewatch.modes/1"},
             {"config", a.config},
             {"config_sha256", config->sha256},
             {"inputs", a.inputs},
             {"version", FRAMEWATCH_VERSION}};
    out.update(modes_json(found));
    fmt::print("{}\n", out.dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    fmt::print("{}", modes_text(found));
  }
  return found.identified.modes.empty() && found.measured.empty() ? kFailed : 0;
}

}  // namespace framewatch::daemon
