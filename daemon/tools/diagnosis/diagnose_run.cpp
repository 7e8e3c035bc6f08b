// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_run.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/workers.h"
#include "daemon/config/keys/suggest.h"
#include "drivers/files/number_text.h"
#include "estimator/diagnose/verdict/diagnose.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {
namespace {

constexpr double kComponentMass = 0.1;  ///< tolerance of a component test's mass

std::vector<estimator::EffectKind> excluded_kinds(const std::vector<std::string>& names,
                                                  std::vector<std::string>& problems) {
  std::vector<estimator::EffectKind> out;
  for (const std::string& name : names) {
    if (const auto kind = estimator::find_effect(name))
      out.push_back(*kind);
    else
      problems.push_back(fmt::format("--without {}: no effect has this name", name));
  }
  return out;
}

estimator::SearchSettings settings_of(const std::vector<std::string>& given,
                                      std::vector<std::string>& problems) {
  estimator::SearchSettings out;
  std::vector<std::string> names;
  for (const estimator::SearchSetting& s : estimator::search_settings()) names.emplace_back(s.name);
  for (const std::string& text : given) {
    const std::string name = text.substr(0, text.find('='));
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) {
      problems.push_back(fmt::format("--setting {}: the search has no number of this name{}", text,
                                     did_you_mean(name, names)));
      continue;
    }
    const estimator::SearchSetting& setting =
        estimator::search_settings()[static_cast<std::size_t>(at - names.begin())];
    const auto value = drivers::parse_number(text.substr(std::min(text.size(), name.size() + 1)));
    if (!value || !(*value >= setting.low && *value <= setting.high))
      problems.push_back(fmt::format("--setting {}: must be NAME=VALUE with a value from {} to {}",
                                     text, setting.low, setting.high));
    else
      setting.set(out, *value);
  }
  return out;
}

std::vector<DiagnoseRecord> read_records(const Config& config, const DiagnoseArguments& a,
                                         std::vector<std::string>& problems) {
  const bool both_given = !a.train.empty() && !a.holdout.empty();
  const bool any_given = !a.train.empty() || !a.holdout.empty();
  if (a.event.empty() ? !both_given : any_given)
    problems.push_back("give --train and --holdout, or --event alone");
  if (!a.event.empty() && !any_given) return read_event_records(config, a.event, problems);
  std::vector<std::string> paths = a.train;
  paths.insert(paths.end(), a.holdout.begin(), a.holdout.end());
  return read_diagnose_records(config, paths, a.component, problems);
}

/// Runs the diagnosis with the requested number of threads. Every piece of its parallel work
/// counts as progress.
estimator::Diagnosis diagnose_in_threads(const DiagnoseArguments& a,
                                         const estimator::DiagnosisInput& input,
                                         estimator::DiagnosisOptions options,
                                         const DiagnosisHooks& hooks) {
  if (a.component.any()) options.tolerances.mass = kComponentMass;
  const auto tell = [&](const std::string& what, double share) {
    if (hooks.progress) hooks.progress(what, share);
  };
  const auto checked = [&](const std::function<void(int)>& work) {
    return [&hooks, &work](int piece) {
      if (hooks.check) hooks.check();
      work(piece);
    };
  };
  struct {
    std::string what;
    double done, then;
  } step{"", 0, 0};  // set between the calls of Workers::run()
  const Workers workers(
      a.threads > 0 ? a.threads : static_cast<int>(std::thread::hardware_concurrency()),
      [&](const std::string&, int pieces, int of) {
        tell(step.what, step.done + (step.then - step.done) * pieces / of);
      });
  options.parallel = [&](int count, const std::function<void(int)>& work) {
    workers.run("", count, checked(work));
  };
  options.within = [&](int count, const std::function<void(int)>& work) {
    workers.run_within(count, checked(work));
  };
  options.progress = [&](const std::string& what, double done, double then) {
    step = {what, done, then};
    tell(what, done);
  };
  if (a.limit_s > 0)
    options.is_over = [start = std::chrono::steady_clock::now(),
                       limit_s = a.limit_s](double share) {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() >
             share * limit_s;
    };
  return diagnose(input.plant, input.segments, options);
}

}  // namespace

std::unique_ptr<DiagnosisRun> run_diagnosis(const Config& config, const DiagnoseArguments& a,
                                            const DiagnosisHooks& hooks,
                                            std::vector<std::string>& problems) {
  const estimator::PipelineConfig& pipeline = config.pipeline;
  if (a.component.any() && (pipeline.structure.stories != 1 || pipeline.structure.frames() != 1))
    problems.push_back(config.path + ": a component test has one story and one frame");
  estimator::DiagnosisOptions options;
  options.holdout_from = a.event.empty() ? a.train.size() : 1;
  options.without = excluded_kinds(a.without, problems);
  options.settings = settings_of(a.settings, problems);
  if (!(a.limit_s >= 0))
    problems.push_back(fmt::format("limit of the search: must be 0 or more, not {}", a.limit_s));
  std::vector<DiagnoseRecord> records = read_records(config, a, problems);
  if (!problems.empty()) return nullptr;

  const ComparedChannels compared = compared_channels(config, records);
  options.known = compared.known;
  std::vector<estimator::RecordSamples> samples;
  for (DiagnoseRecord& record : records) samples.push_back(std::move(record.samples));
  auto input = estimator::diagnosis_input(pipeline.structure, compared.axes, pipeline.design,
                                          a.component, samples, pipeline.bending_nmprad);
  if (!input) {
    problems.push_back(config.path +
                       ": its channels do not measure every motion that diagnose needs; see "
                       "docs/diagnosis.md");
    return nullptr;
  }
  for (std::size_t r = 0; r < records.size(); ++r)
    add_segment_problems(records[r].path, *input, r, a.component, problems);
  if (!problems.empty()) return nullptr;

  estimator::Diagnosis diagnosis = diagnose_in_threads(a, *input, options, hooks);
  return std::unique_ptr<DiagnosisRun>(new DiagnosisRun{
      config, std::move(records), std::move(*input), options.holdout_from, std::move(diagnosis)});
}

}  // namespace framewatch::daemon
