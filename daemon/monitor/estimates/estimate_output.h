#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// Takes the messages of a replay.
class EstimateOutput {
 public:
  virtual ~EstimateOutput() = default;
  /// False when it cannot be stored or sent; error() says why, here and below.
  [[nodiscard]] virtual bool put(std::int64_t time_us, const std::string& channel,
                                 const std::vector<std::uint8_t>& bytes) = 0;
  /// A file gets its final name only here; without close() no file is left.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
  /// Number of the next event, where events have one.
  virtual std::int64_t events() const { return 0; }
};

/// The rule that the name of an output breaks; empty when it is valid.
std::string problem_of_output_name(const std::string& path);

struct EstimateFile {
  std::string path;
  bool boxplot = false;    ///< statistics too, in .csv and .mat
  bool goes_on = false;    ///< after another part: a .csv has no header of its own
  std::int64_t event = 0;  ///< number of the first event
};

/// By the name's end: .lcmlog holds every message, .csv, .csv.gz and .mat the main window's
/// estimates. Null, and the reason, when it cannot be made.
std::unique_ptr<EstimateOutput> estimate_output(const Config& config, const EstimateFile& file,
                                                std::string& error);

/// Publishes the messages on LCM. Null, with the reason, when LCM cannot start with that URL.
std::unique_ptr<EstimateOutput> lcm_estimate_output(const Config& config, const std::string& url,
                                                    std::string& error);

}  // namespace framewatch::daemon
