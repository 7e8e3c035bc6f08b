#include "daemon/page/web/web_event_reports.h"

#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/served_file.h"
#include "daemon/monitor/event_report/event_report_folder.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxReports = 50;

}  // namespace

std::string event_reports_json(const std::string& folder) {
  const std::vector<std::string> names = event_report_names(folder);
  Json out = Json::array();
  for (auto name = names.rbegin(); name != names.rend() && out.size() < kMaxReports; ++name)
    if (const auto s = event_report_summary(folder, *name))
      out.push_back({{"name", s->name},
                     {"verdict", color_word(s->color)},
                     {"reason", s->reason},
                     {"placard", s->placard},
                     {"start_us", s->start_us},
                     {"end_us", s->end_us}});
  return json_line(out);
}

std::optional<WebFile> event_report_document(const std::string& folder, const std::string& path) {
  const std::size_t dot = path.find('.');
  const std::string ending = dot == std::string::npos ? "" : path.substr(dot);
  const bool page = ending == ".html";
  if (folder.empty() || !is_event_report_name(path.substr(0, dot))) return std::nullopt;
  if (!page && ending != ".json") return std::nullopt;
  auto text = read_served_file(folder, {path});
  if (!text) return std::nullopt;
  return WebFile{page ? "text/html; charset=utf-8" : "application/json", std::move(*text)};
}

}  // namespace framewatch::daemon
