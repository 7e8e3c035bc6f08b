#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/action_options.h"
#include "daemon/history_options.h"
#include "daemon/toml_document.h"
#include "drivers/can/can_map.h"
#include "estimator/pipeline.h"
#include "estimator/structure/effect.h"
#include "estimator/watch/gap.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {

/// Where a sensor axis' samples come from. On LCM; node < 0: file only, matched by channel name. Or
/// on CAN, when `can` names an interface.
struct AxisSource {
  std::string lcm_channel;
  int node = -1;
  int axis = 0;  ///< 0 x, 1 y, 2 z
  std::string can = {};
  std::string dbc_signal = {};  ///< Message.Signal
  std::string can_node = {};
};

struct LcmSettings {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "FRAMEWATCH_";  ///< of the channels the daemon publishes on
  int queue_capacity = 10000;          ///< messages waiting for the estimator
  int receive_buffer_bytes = 4194304;
  int boxplot_every = 1;  ///< publish boxplot statistics with every n-th window
};

struct WatchSettings {
  WatchOptions options;
  std::string baseline_path;         ///< empty: none
  std::string temperature_channel;   ///< LCM channel of temperature_t; empty: none
  std::optional<Baseline> baseline;  ///< of that file, if there is one yet
};

struct GapSettings {
  GapOptions options;
  std::string model_path;         ///< empty: the model is learned
  std::optional<GapModel> model;  ///< of that file, if there is one yet
  std::string store;              ///< directory of the segments; empty: none are stored
  double before_s = 30, after_s = 60;
};

/// One configuration file, defaults filled in.
struct Config {
  std::string path;
  std::string sha256;
  PipelineConfig pipeline;
  std::vector<AxisSource> sources;  ///< parallel to pipeline.axes
  LcmSettings lcm;
  drivers::CanMap can;                     ///< axes as in pipeline.axes
  std::optional<WatchSettings> watch;      ///< none: nothing is watched
  std::optional<GapSettings> gap;          ///< none: nothing is simulated beside the measurement
  std::optional<HistorySettings> history;  ///< none: nothing is kept
  std::optional<ActionSettings> actions;   ///< none: nobody is told
  std::vector<Effect> effects;             ///< that the building has beyond the linear model
};

struct ConfigProblem {
  std::string where;  ///< file:line:column, or file
  std::string message;
};

/// Problems of a text as problems of its file, in order of place.
std::vector<ConfigProblem> with_file(const std::string& path, std::vector<TextProblem> problems);

/// Reads and validates. Empty optional and every problem at once when it is not valid.
std::optional<Config> load_config(const std::string& path, std::vector<ConfigProblem>& problems);
/// The same from a text; `path` is what messages call it.
std::optional<Config> parse_config(const std::string& path, const std::string& text,
                                   std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
