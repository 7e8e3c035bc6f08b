#pragma once

#include <optional>
#include <vector>

#include "daemon/config.h"
#include "daemon/toml_document.h"

namespace framewatch::daemon {

/// [structure] and [structure.design] as far as they could be read.
struct StructureReading {
  Structure structure;
  Eigen::VectorXd design;  ///< theta order; empty when the file has none
  bool stories_known = false;
  bool frames_known = false;
};

/// The configuration in a document that was parsed already, its path and digest apart. False when
/// there was a problem.
bool read_config(const TomlValue& document, Config& config, std::vector<TextProblem>& problems);

StructureReading read_structure(const TomlValue& document, std::vector<TextProblem>& problems);

/// Design parameters in theta order, of a structure without problems; empty when the file has none.
Eigen::VectorXd read_design(const TomlValue* design, const Structure& structure, bool shape_known,
                            std::vector<TextProblem>& problems);

/// Rule that a frame or channel name breaks; empty when it is good.
std::string problem_of_name(const std::string& name);

/// Every [[channel]] into config.pipeline.axes and config.sources.
void read_channels(const TomlValue& document, const StructureReading& structure, Config& config,
                   std::vector<TextProblem>& problems);

EstimatorOptions read_estimator(const TomlValue& document, std::vector<TextProblem>& problems);
LcmSettings read_lcm(const TomlValue& document, std::vector<TextProblem>& problems);
std::optional<WatchSettings> read_watch(const TomlValue& document,
                                        std::vector<TextProblem>& problems);
/// Resolves the baseline's path beside the configuration file and reads it if it exists.
void load_watch_baseline(Config& config, std::vector<ConfigProblem>& problems);

std::optional<GapSettings> read_gap(const TomlValue& document, std::vector<TextProblem>& problems);
/// Resolves model and store beside the configuration file and reads the model if it exists.
void load_gap_model(Config& config, std::vector<ConfigProblem>& problems);

std::optional<HistorySettings> read_history(const TomlValue& document,
                                            std::vector<TextProblem>& problems);
/// Resolves the directory beside the configuration file.
void place_history(Config& config);

std::optional<ActionSettings> read_actions(const TomlValue& document,
                                           std::vector<TextProblem>& problems);
/// Resolves the webhook's files beside the configuration file.
void place_actions(Config& config);

}  // namespace framewatch::daemon
