// SPDX-License-Identifier: MIT
#include "daemon/tools/report/report_about.h"

#include <filesystem>
#include <initializer_list>
#include <utility>

#include "daemon/base/base64.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/toml_document.h"
#include "daemon/config/keys/option_table.h"
#include "daemon/config/keys/section.h"

namespace framewatch::daemon {
namespace {

/// Returns "image/jpeg" or "image/png" by the first bytes; "" for other files.
std::string picture_type(const std::string& bytes) {
  return bytes.starts_with("\xff\xd8\xff") ? "image/jpeg"
         : bytes.starts_with("\x89PNG")    ? "image/png"
                                           : "";
}

void read_photograph(const TomlValue& table, const std::string& folder, ReportAbout& out,
                     std::vector<TextProblem>& problems) {
  ConfigSection section("about.photograph", "photograph", &table, {}, problems);
  auto photograph = section.read<ReportPhotograph>();
  place_files("about.photograph", folder, photograph);
  if (!section.good("file")) return;
  std::string error;
  const auto bytes = read_text_file(photograph.file, error);
  const std::string type = bytes ? picture_type(*bytes) : "";
  if (!bytes)
    section.problem("file", photograph.file + ": " + error);
  else if (type.empty())
    section.problem("file", photograph.file + ": is neither JPEG nor PNG");
  if (type.empty()) return;
  photograph.file = "data:" + type + ";base64," + base64(*bytes);
  out.photographs.push_back(std::move(photograph));
}

}  // namespace

std::optional<ReportAbout> read_about(const std::string& path,
                                      std::vector<ConfigProblem>& problems) {
  ReportAbout out;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const bool good = read_toml_file(
      path,
      [&](const TomlValue& document, std::vector<TextProblem>& found) {
        ConfigSection section("about", "about", &document, {}, found);
        section.read_into(out);
        for (const TomlValue* table : tables_of(document, "photograph", found))
          read_photograph(*table, folder, out, found);
      },
      problems);
  return good ? std::optional(std::move(out)) : std::nullopt;
}

std::string about_section(const ReportAbout& about) {
  std::string out;
  const std::initializer_list<std::pair<const char*, const std::string*>> texts{
      {"report", &about.number},
      {"date", &about.date},
      {"laboratory", &about.laboratory},
      {"client", &about.client},
      {"author", &about.author}};
  for (const auto& [what, text] : texts)
    if (!text->empty())
      out += std::string(out.empty() ? "<p>" : "<br>\n") + what + ": " + html_text(*text);
  return out.empty() ? "" : out + "</p>\n";
}

std::string photograph_section(const ReportAbout& about) {
  std::string out;
  for (const ReportPhotograph& p : about.photographs)
    out += "<figure><img src=\"" + p.file + "\" alt=\"" + html_text(p.caption) + "\"><figcaption>" +
           html_text(p.caption) + "</figcaption></figure>\n";
  return out.empty() ? "" : "<h2>Photographs</h2>\n" + out;
}

}  // namespace framewatch::daemon
