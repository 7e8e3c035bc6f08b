// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/adopt_command.h"

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/config/config.h"
#include "daemon/config/learned_files.h"
#include "daemon/config/sections/config_problems.h"
#include "drivers/files/text_output.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

int adopt(const AdoptArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  std::string error;
  const std::optional<std::string> text = read_text_file(a.model, error);
  std::optional<estimator::GapModel> model;
  if (config && (!config->gap || config->gap->model_path.empty()))
    problems.push_back({a.config, "has no [gap] model: set the path to copy the model to"});
  else if (!text)
    problems.push_back({a.model, error});
  else if (config)
    model = parse_gap_model(*config, a.model, *text, problems);
  if (problems.empty()) {
    error = drivers::write_text_file(config->gap->model_path, *text);
    if (!error.empty()) fmt::print(stderr, "{}\n", error);
  }
  print_problems(problems);
  if (!problems.empty() || !error.empty()) return kBadInput;
  if (a.quiet) return 0;
  fmt::print("{} is now {}\n", config->gap->model_path, a.model);
  for (const estimator::Effect& e : model->effects)
    fmt::print("  {}: {}\n", name_of(e.kind),
               place_text(e.place, config->pipeline.structure, config->pipeline.axes));
  return 0;
}

}  // namespace framewatch::daemon
