// SPDX-License-Identifier: MIT
#include "daemon/tools/export/export_command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/config/config.h"
#include "daemon/tools/export/model_matrices.h"
#include "daemon/tools/export/opensees_model.h"
#include "drivers/files/text_output.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

using estimator::Effect;
using estimator::EffectKind;

/// A panel that deforms less than this share of the frames is of a symmetric plan.
constexpr double kSymmetric = 1e-9;
constexpr std::size_t kFrequenciesTold = 6;

/// Returns why `folder` cannot be written into, or an empty text.
std::string why_not(const std::string& folder, bool force) {
  std::error_code error;
  const auto kind = std::filesystem::status(folder, error).type();
  if (kind == std::filesystem::file_type::not_found) return "";
  if (kind != std::filesystem::file_type::directory) return folder + ": is not a folder";
  const bool empty = std::filesystem::is_empty(folder, error);
  if (error) return folder + ": " + error.message();
  if (empty || force) return "";
  return folder + ": is not empty; use --force to write into it, or another folder";
}

std::vector<Effect> wanted_effects(const Config& config, const std::vector<std::string>& without,
                                   std::vector<std::string>& problems,
                                   std::vector<std::string>& notes) {
  std::vector<EffectKind> excluded;
  for (const std::string& name : without) {
    if (const auto kind = estimator::find_effect(name))
      excluded.push_back(*kind);
    else
      problems.push_back(fmt::format("--without {}: no effect has this name", name));
  }
  std::vector<Effect> out;
  for (const Effect& e : config.effects) {
    const bool of_sensor = is_channel_effect(e.kind);
    const bool left_out = std::find(excluded.begin(), excluded.end(), e.kind) != excluded.end();
    if (of_sensor || left_out)
      notes.push_back(
          fmt::format("left out: {} at {}{}", name_of(e.kind),
                      place_text(e.place, config.pipeline.structure, config.pipeline.axes),
                      of_sensor ? ", an effect of a sensor" : ""));
    else
      out.push_back(e);
  }
  return out;
}

/// Returns the natural frequencies of the linear part, Hz.
std::string frequencies_text(const ExportedModel& model) {
  std::vector<std::string> not_linear;
  const ModelMatrices m = model_matrices(model, not_linear);
  const Eigen::VectorXd squares = estimator::generalized_eigenvalues(m.stiffness, m.mass);
  std::string out;
  for (Eigen::Index i = 0;
       i < std::min(squares.size(), static_cast<Eigen::Index>(kFrequenciesTold)); ++i)
    out += fmt::format("{}{:.5g}", out.empty() ? "" : ", ",
                       std::sqrt(std::max(squares[i], 0.0)) / (2 * M_PI));
  return fmt::format("natural frequencies{}: {} Hz{}",
                     not_linear.empty() ? "" : " of the linear part", out,
                     squares.size() > static_cast<Eigen::Index>(kFrequenciesTold) ? ", ..." : "");
}

/// Returns remarks about a model that its user should know.
std::vector<std::string> remarks(const ExportedModel& model) {
  std::vector<std::string> out;
  const estimator::Structure& s = model.structure;
  const estimator::ParameterTable table(s);
  if (s.panels() > 0) {
    const auto shares = panel_excitation(s, table, model.theta);
    if (std::all_of(shares.begin(), shares.end(), [](double v) { return v < kSymmetric; }))
      out.push_back(
          "the plan is symmetric: no record shows the floor panels, their stiffness is the "
          "design's");
  }
  const bool rotates = std::any_of(model.effects.begin(), model.effects.end(), [](const Effect& e) {
    return e.kind == EffectKind::base_rocking || e.kind == EffectKind::frame_bending;
  });
  if (rotates || model.bending_nmprad.any())
    out.push_back(
        "rotations follow the moments of springs and dashpots in OpenSees, those of springs alone "
        "in framewatch: responses differ by about the damping ratio squared");
  return out;
}

std::string make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  return error ? folder + ": " + error.message() : "";
}

std::string write_opensees(const std::vector<OpenSeesCommand>& commands,
                           const std::vector<std::string>& head, const std::string& folder) {
  std::string why = drivers::write_text_file(folder + "/model.tcl", tcl_text(commands, head));
  return why.empty() ? drivers::write_text_file(folder + "/model.py", python_text(commands, head))
                     : why;
}

}  // namespace

int export_command(const ExportArguments& a) {
  if (a.opensees.empty() && a.matrices.empty())
    return refuse("export", "give --opensees DIR, --matrices DIR or both");
  std::vector<std::string> problems, notes;
  for (const std::string& folder : {a.opensees, a.matrices})
    if (const std::string why = folder.empty() ? "" : why_not(folder, a.force); !why.empty())
      problems.push_back(why);
  std::vector<ConfigProblem> config_problems;
  const std::optional<Config> config = load_config(a.config, config_problems);
  print_problems(config_problems);
  if (!config) return kBadInput;
  const estimator::PipelineConfig& pipeline = config->pipeline;
  if (pipeline.design.size() == 0)
    problems.push_back(a.config +
                       ": has no [structure.design] to export; `framewatch diagnose` writes "
                       "identified values into its model.toml");
  ExportedModel model{pipeline.structure, pipeline.design, pipeline.bending_nmprad,
                      wanted_effects(*config, a.without, problems, notes)};
  std::vector<OpenSeesCommand> commands;
  ModelMatrices matrices;
  if (problems.empty() && !a.opensees.empty()) commands = opensees_model(model, problems);
  if (problems.empty() && !a.matrices.empty()) matrices = model_matrices(model, problems);
  for (const std::string& p : problems) fmt::print(stderr, "{}\n", printable_lines(p));
  if (!problems.empty()) return kBadInput;

  const std::string frequencies = frequencies_text(model);
  const std::vector<std::string> remarked = remarks(model);
  std::vector<std::string> head{
      fmt::format("{}, exported by framewatch {} from {}", printable(pipeline.structure.name),
                  FRAMEWATCH_VERSION, printable(a.config)),
      frequencies,
      "ground motion along x, for example: timeSeries Path 1 -dt 0.01 -filePath x.txt; pattern "
      "UniformExcitation 1 1 -accel 1"};
  head.insert(head.end(), remarked.begin(), remarked.end());
  std::string why;
  for (const std::string& folder : {a.opensees, a.matrices})
    if (why.empty() && !folder.empty()) why = make_folder(folder);
  if (why.empty() && !a.opensees.empty()) why = write_opensees(commands, head, a.opensees);
  if (why.empty() && !a.matrices.empty()) why = write_matrices(matrices, a.matrices);
  if (!why.empty()) return refuse("export", why);
  notes.insert(notes.end(), remarked.begin(), remarked.end());
  for (const std::string& note : notes)
    if (!a.quiet) fmt::print(stderr, "{}\n", printable(note));
  if (a.quiet) return 0;
  if (!a.opensees.empty())
    fmt::print("{0}/model.tcl, {0}/model.py: written\n", printable(a.opensees));
  if (!a.matrices.empty())
    fmt::print("{}: M, C and K of {} rows written; rows.csv says what each row is\n",
               printable(a.matrices), matrices.rows.size());
  fmt::print("{}\n", frequencies);
  return 0;
}

}  // namespace framewatch::daemon
