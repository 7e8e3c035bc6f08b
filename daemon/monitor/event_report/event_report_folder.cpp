#include "daemon/monitor/event_report/event_report_folder.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/served_file.h"
#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

const std::string kBeginning = "event-", kStamp = "20261121T231500Z";

std::optional<EventColor> color_of_word(const std::string& word) {
  for (const EventColor color : {EventColor::green, EventColor::yellow, EventColor::red})
    if (word == color_word(color)) return color;
  return std::nullopt;
}

}  // namespace

bool is_event_report_name(const std::string& name) {
  return name.size() == kBeginning.size() + kStamp.size() && name.starts_with(kBeginning) &&
         read_utc_stamp(name.substr(kBeginning.size()));
}

std::vector<std::string> event_report_names(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (const std::string name = at->path().stem().string();
        at->path().extension() == ".json" && is_event_report_name(name))
      out.push_back(name);
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<EventReportSummary> event_report_summary(const std::string& folder,
                                                       const std::string& name) {
  const auto text = read_served_file(folder, {name + ".json"});
  if (!text) return std::nullopt;
  try {
    const Json json = Json::parse(*text);
    const auto color = color_of_word(json.at("verdict").get<std::string>());
    const Json& reasons = json.at("reasons");
    if (!color || reasons.empty()) return std::nullopt;
    EventReportSummary out{name, *color, reasons.at(0).get<std::string>(),
                           json.at("start_us").get<std::int64_t>(),
                           json.at("end_us").get<std::int64_t>()};
    if (json.contains("placard") && json.at("placard").is_object()) {
      out.placard = json.at("placard").at("words").get<std::string>();
      out.placard_reason = json.at("placard").at("reason").get<std::string>();
    }
    return out;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

NewestEventReport::NewestEventReport(std::string folder) : folder_(std::move(folder)) {}

const std::optional<EventReportSummary>& NewestEventReport::look() {
  if (folder_.empty()) return newest_;
  const std::vector<std::string> names = event_report_names(folder_);
  if (names.empty()) {
    name_.clear();
    newest_.reset();
  } else if (names.back() != name_ || !newest_) {
    name_ = names.back();
    newest_ = event_report_summary(folder_, name_);
  }
  return newest_;
}

}  // namespace framewatch::daemon
