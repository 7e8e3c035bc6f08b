#include "daemon/monitor/estimates/estimate_output.h"

#include <utility>

#include <framewatch/window_estimate_t.hpp>

#include <fmt/core.h>

#include "daemon/monitor/estimates/estimates_csv.h"
#include "daemon/monitor/estimates/estimates_mat.h"
#include "drivers/files/standard_streams.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/lcm_provider.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

class LogOutput : public EstimateOutput {
 public:
  bool open(const EstimateFile& file) {
    const bool opened = writer_.open(file.path);
    writer_.number_from(file.event);
    return opened;
  }
  std::int64_t events() const override { return writer_.events(); }
  bool put(std::int64_t time_us, const std::string& channel,
           const std::vector<std::uint8_t>& bytes) override {
    return writer_.write(time_us, channel, bytes.data(), bytes.size());
  }
  bool close() override { return writer_.close(); }
  std::string error() const override { return writer_.error(); }

 private:
  drivers::LcmLogWriter writer_;
};

/// The main window's estimates as rows of a table.
template <typename Writer>
class TableOutput : public EstimateOutput {
 public:
  explicit TableOutput(const Config& config)
      : channel_(config.lcm.prefix + "ESTIMATE"), table_(config.pipeline.parameters()) {}
  bool open(const EstimateFile& file) {
    std::vector<std::string> names, units;
    for (int i = 0; i < table_.size(); ++i) {
      names.push_back(table_[i].name);
      units.push_back(table_[i].unit);
    }
    if constexpr (requires { writer_.continue_table(); })
      if (file.goes_on) writer_.continue_table();
    return writer_.open(file.path, names, units, file.boxplot);
  }
  bool put(std::int64_t, const std::string& channel,
           const std::vector<std::uint8_t>& bytes) override {
    if (channel != channel_) return true;
    const auto estimate = drivers::decoded<window_estimate_t>(bytes);
    return estimate && writer_.write(*estimate);
  }
  bool close() override { return writer_.close(); }
  std::string error() const override { return writer_.error(); }

 private:
  std::string channel_;
  estimator::ParameterTable table_;
  Writer writer_;
};

class LcmOutput : public EstimateOutput {
 public:
  explicit LcmOutput(std::unique_ptr<drivers::LcmProvider> lcm) : lcm_(std::move(lcm)) {}
  bool put(std::int64_t, const std::string& channel,
           const std::vector<std::uint8_t>& bytes) override {
    return lcm_->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) == 0;
  }
  bool close() override { return true; }
  std::string error() const override { return "LCM refuses to publish"; }

 private:
  std::unique_ptr<drivers::LcmProvider> lcm_;
};

template <typename Output>
std::unique_ptr<EstimateOutput> opened(std::unique_ptr<Output> output, const EstimateFile& file,
                                       std::string& error) {
  if (output->open(file)) return output;
  error = output->error();
  return nullptr;
}

bool is_csv(const std::string& path) {
  return path == drivers::kStandardOutput || path.ends_with(".csv") || path.ends_with(".csv.gz");
}

}  // namespace

std::string problem_of_output_name(const std::string& path) {
  if (path.ends_with(".lcmlog") || path.ends_with(".mat") || is_csv(path)) return {};
  return path +
         ": the output's name must end in .lcmlog, .csv, .csv.gz, .mat or .sqlite, or be - "
         "(standard output, CSV)";
}

std::unique_ptr<EstimateOutput> estimate_output(const Config& config, const EstimateFile& file,
                                                std::string& error) {
  if (is_csv(file.path))
    return opened(std::make_unique<TableOutput<EstimatesCsvWriter>>(config), file, error);
  if (file.path.ends_with(".mat"))
    return opened(std::make_unique<TableOutput<EstimatesMatWriter>>(config), file, error);
  return opened(std::make_unique<LogOutput>(), file, error);
}

std::unique_ptr<EstimateOutput> lcm_estimate_output(const Config& config, const std::string& url,
                                                    std::string& error) {
  auto lcm = drivers::open_lcm(url.empty() ? config.lcm.url : url, config.lcm.reception, error);
  if (!lcm) return nullptr;
  return std::make_unique<LcmOutput>(std::move(lcm));
}

}  // namespace framewatch::daemon
