#include "daemon/diagnose_command.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>

#include <fmt/core.h>

#include "daemon/config_problems.h"
#include "daemon/diagnose_output.h"
#include "daemon/diagnose_records.h"
#include "daemon/exit_code.h"
#include "daemon/median.h"
#include "daemon/workers.h"
#include "drivers/text_output.h"
#include "estimator/identify/design.h"

namespace framewatch::daemon {
namespace {

constexpr int kGapRemains = 1;
constexpr double kBandLow = 0.4, kBandHigh = 1.6;  ///< of the lowest and highest natural frequency
constexpr double kComponentBandLow = 0.1;          ///< displacement is known far below too
constexpr double kHighest = 0.4;                   ///< of the sampling rate
constexpr Eigen::Index kLeastBins = 30;
constexpr double kComponentMass = 0.1;  ///< tolerance
constexpr int kLooks = 2;               ///< at a building that has no design
constexpr double kLeastOfGuess = 0.01;
constexpr double kLeastSignal = 5;  ///< rms of a floor's motion in the band over its noise

bool write_file(const std::string& path, const std::string& text) {
  drivers::TextOutput out;
  if (out.open(path) && out.write(text) && out.close()) return true;
  fmt::print(stderr, "{}: {}\n", path, out.error());
  return false;
}

/// Motion in the band against noise, the median over the axes above the base.
double signal_ratio(const Plant& plant, const Stretch& s) {
  std::vector<double> ratios;
  for (Eigen::Index a = 0; a < plant.axis_count(); ++a)
    if (plant.axes[static_cast<std::size_t>(a)].story > 0)
      ratios.push_back(std::sqrt(s.spectrum.row(a).squaredNorm() /
                                 (static_cast<double>(s.bins() * s.intervals()) * s.variance[a])));
  return median(std::move(ratios));
}

/// The records in the band of the design's natural frequencies.
std::vector<Stretch> stretches_of(const Config& config, const DiagnoseArguments& a,
                                  const Plant& plant, const Eigen::VectorXd& design,
                                  const std::vector<char>& displaced,
                                  const std::vector<DiagnoseRecord>& records) {
  const PipelineConfig& pc = config.pipeline;
  const std::vector<double> hz =
      natural_frequencies_hz(pc.structure, ParameterTable(pc.structure), design);
  std::vector<Stretch> out;
  for (const DiagnoseRecord& record : records) {
    Eigen::VectorXd noise = Eigen::VectorXd::Zero(plant.axis_count());
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(pc.axes.size()); ++i)
      noise[i] = pc.axes[static_cast<std::size_t>(i)].noise_density * std::sqrt(record.rate_hz / 2);
    const Band band{(a.component.any() ? kComponentBandLow : kBandLow) * hz.front(),
                    std::min(kHighest * record.rate_hz, kBandHigh * hz.back())};
    out.push_back(make_stretch(record.accel, record.rate_hz, noise, band, displaced, record.lead));
  }
  return out;
}

void check_stretches(const std::vector<DiagnoseRecord>& records,
                     const std::vector<Stretch>& stretches, const Plant& plant, bool component,
                     std::vector<std::string>& problems) {
  for (std::size_t r = 0; r < stretches.size(); ++r) {
    const Stretch& s = stretches[r];
    if (s.bins() < kLeastBins)
      problems.push_back(
          fmt::format("{}: too short: {} frequencies lie in the building's band, at least {} are "
                      "needed",
                      records[r].path, s.bins(), kLeastBins));
    else if (!component && !(signal_ratio(plant, s) > kLeastSignal))
      problems.push_back(records[r].path +
                         ": no excitation: the floors' motion does not stand out of "
                         "the sensors' noise");
  }
}

/// Matrices of megabytes come and go by the thousand: from the heap, not each time from the kernel.
void keep_freed_memory() {
  constexpr int kLargest = 1 << 30;
  ::mallopt(M_ARENA_MAX, 1);
  ::mallopt(M_MMAP_THRESHOLD, kLargest);
  ::mallopt(M_TRIM_THRESHOLD, kLargest);
}

}  // namespace

int diagnose_command(const DiagnoseArguments& a) {
  keep_freed_memory();
  std::vector<ConfigProblem> config_problems;
  const std::optional<Config> config = load_config(a.config, config_problems);
  print_problems(config_problems);
  if (!config) return kBadInput;

  std::vector<std::string> problems;
  const Structure& s = config->pipeline.structure;
  if (a.component.any() && (s.stories != 1 || s.frames() != 1))
    problems.push_back(a.config + ": a component test has one story and one frame");
  std::vector<EffectKind> without;
  for (const std::string& name : a.without) {
    if (const auto kind = find_effect(name))
      without.push_back(*kind);
    else
      problems.push_back(fmt::format("--without {}: no effect has this name", name));
  }
  const bool records_given = !a.train.empty() && !a.holdout.empty();
  const bool any_given = !a.train.empty() || !a.holdout.empty();
  if (a.event.empty() ? !records_given : any_given)
    problems.push_back("needs --train and --holdout, or --event alone");
  std::vector<DiagnoseRecord> records;
  if (!a.event.empty() && !any_given) records = read_event_records(*config, a.event, problems);
  const std::size_t train = a.event.empty() ? a.train.size() : 1;
  for (const auto* list : {&a.train, &a.holdout})
    for (const std::string& path : *list)
      if (auto record = read_diagnose_record(*config, path, a.component, problems))
        records.push_back(std::move(*record));
  for (std::size_t i = 0; i < records.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (a.event.empty() && records[i].sha256 == records[j].sha256)
        problems.push_back(records[i].path + ": is the same file as " + records[j].path);
  for (const std::string& p : problems) fmt::print(stderr, "{}\n", p);
  if (!problems.empty()) return kBadInput;

  const PipelineConfig& pc = config->pipeline;
  const ParameterTable table(pc.structure);
  Eigen::VectorXd design = pc.design.size() > 0 ? pc.design : guessed_design(pc.structure, table);
  auto plant = make_plant(pc.structure, pc.axes, design, records.front().rate_hz);
  if (!plant) {
    fmt::print(stderr, "{}: the channels do not measure every motion that diagnose needs\n",
               a.config);
    return kBadInput;
  }
  if (!a.component.force.empty()) {
    SensorAxis force;
    force.name = a.component.force;
    force.story = 1;
    force.frame = 0;
    plant = with_force_axis(*plant, force);
    plant->prescribed = a.component.prescribed;
  }
  std::vector<char> displaced(plant->axes.size(), 0);
  for (std::size_t i = 0; i < plant->axes.size(); ++i)
    displaced[i] = a.component.displacement && plant->axes[i].story == 1 &&
                   !plant->is_force(static_cast<Eigen::Index>(i));
  std::vector<Stretch> stretches = stretches_of(*config, a, *plant, design, displaced, records);
  if (pc.design.size() == 0 && !a.component.any()) {
    const Tolerances tolerances;
    for (int look = 0; look < kLooks; ++look) {
      const Eigen::VectorXd theta = fitted_linear(*plant, stretches, tolerances);
      if (theta.size() == 0) break;
      for (int p = 0; p < table.size(); ++p)
        if (const auto at = plant->table.find(table[p].name))
          design[p] = std::max(theta[*at], kLeastOfGuess * design[p]);
      plant = make_plant(pc.structure, pc.axes, design, records.front().rate_hz);
      stretches = stretches_of(*config, a, *plant, design, displaced, records);
    }
  }
  check_stretches(records, stretches, *plant, a.component.any(), problems);
  for (const std::string& p : problems) fmt::print(stderr, "{}\n", p);
  if (!problems.empty()) return kBadInput;

  DiagnosisOptions options;
  if (a.component.any()) options.tolerances.mass = kComponentMass;
  options.holdout_from = train;
  options.known = config->effects;
  options.without = without;
  const Workers workers(a.threads > 0 ? a.threads
                                      : static_cast<int>(std::thread::hardware_concurrency()));
  options.parallel = [&](int count, const std::function<void(int)>& work) {
    workers.run("", count, work);
  };
  const bool terminal = !a.quiet && isatty(STDERR_FILENO);
  if (terminal)
    options.progress = [](const std::string& what, double share) {
      fmt::print(stderr, "\r\033[K{:3.0f} %  {}", 100 * share, what);
      std::fflush(stderr);
    };
  const Diagnosis diagnosis = diagnose(*plant, stretches, options);
  if (terminal) fmt::print(stderr, "\r\033[K");

  const DiagnoseOutput output{*config, *plant, records, stretches, train, diagnosis};
  std::error_code failure;
  std::filesystem::create_directories(a.out, failure);
  if (failure) {
    fmt::print(stderr, "{}: {}\n", a.out, failure.message());
    return kBadInput;
  }
  const bool written = write_file(a.out + "/diagnosis.json", diagnosis_json(output)) &&
                       write_file(a.out + "/model.toml", diagnosis_model_toml(output)) &&
                       write_file(a.out + "/report.html", diagnosis_report(output));
  if (!written) return kBadInput;
  if (!a.quiet) fmt::print("{}{}/report.html\n", diagnosis_text(output), a.out);
  const bool holds =
      diagnosis.verdict == Verdict::adequate || diagnosis.verdict == Verdict::explained;
  return holds ? 0 : kGapRemains;
}

}  // namespace framewatch::daemon
