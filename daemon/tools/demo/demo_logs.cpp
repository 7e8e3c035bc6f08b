#include "daemon/tools/demo/demo_logs.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/core.h>

#include "daemon/tools/report/report_command.h"

namespace framewatch::daemon {

DemoLogs::DemoLogs(const std::string& report) : report_(report) {
  if (report_.empty()) return;
  char name[] = "/tmp/framewatch-demo-XXXXXX";
  if (const char* made = ::mkdtemp(name)) folder_ = made;
  open_ = !folder_.empty() && raw_.open(folder_ + "/raw.lcmlog") &&
          estimates_.open(folder_ + "/estimates.lcmlog");
  if (!open_) fmt::print(stderr, "framewatch demo: no log in /tmp, so no report\n");
}

DemoLogs::~DemoLogs() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

void DemoLogs::raw(std::int64_t time_us, const std::string& channel, const void* data,
                   std::size_t size) {
  open_ = open_ && raw_.write(time_us, channel, data, size);
}

void DemoLogs::estimate(std::int64_t time_us, const std::string& channel,
                        const std::vector<std::uint8_t>& bytes) {
  open_ = open_ && estimates_.write(time_us, channel, bytes.data(), bytes.size());
}

void DemoLogs::write_report(const DemoBuilding& building) {
  if (report_.empty()) return;
  const std::string config = folder_ + "/building.toml";
  std::ofstream(config) << building.config_text;
  if (!open_ || !raw_.close() || !estimates_.close()) return;
  ReportArguments a;
  a.estimates = folder_ + "/estimates.lcmlog";
  a.config = config;
  if (raw_.events() > 0) a.raw = {folder_ + "/raw.lcmlog"};
  a.out = report_;
  a.title = building.title;
  if (report(a) != 0) fmt::print(stderr, "framewatch demo: no report\n");
}

}  // namespace framewatch::daemon
