#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/process.h"
#include "fleet/uplink/raw_sender.h"

namespace framewatch::fleet {
namespace {

class HistoryExporter : public RawExporter {
 public:
  explicit HistoryExporter(std::string config) : config_(std::move(config)) {}

  std::string begin(const RawRequest& request, const std::string& path) override {
    std::error_code none;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", none);
    const auto seconds = [](std::int64_t us) {
      return fmt::format("{:.6f}", 1e-6 * static_cast<double>(us));
    };
    std::vector<std::string> arguments{"history", config_,
                                       "--from",  seconds(request.time.from_us),
                                       "--to",    seconds(request.time.to_us),
                                       "--raw",   path};
    for (const std::string& channel : request.channels) {
      arguments.emplace_back("--channel");
      arguments.push_back(channel);
    }
    std::string error;
    process_ = daemon::ChildProcess::start(std::move(arguments), error,
                                           (self.parent_path() / "framewatch").string());
    return process_ ? "" : "framewatch history cannot be started: " + error;
  }

  std::optional<std::string> ended() override {
    const std::optional<int> status = process_ ? process_->ended() : std::optional<int>(1);
    if (!status) return std::nullopt;
    process_.reset();
    if (*status == 0) return "";
    return fmt::format("framewatch history found none, or failed (status {})", *status);
  }

 private:
  std::string config_;
  std::optional<daemon::ChildProcess> process_;
};

}  // namespace

std::unique_ptr<RawExporter> history_exporter(std::string config) {
  return std::make_unique<HistoryExporter>(std::move(config));
}

}  // namespace framewatch::fleet
