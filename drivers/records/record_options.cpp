// SPDX-License-Identifier: MIT
#include "drivers/records/record_options.h"

#include <array>
#include <utility>

#include <fmt/format.h>

namespace framewatch::drivers {
namespace {

constexpr std::array<std::pair<std::string_view, RecordFormat>, 16> kFormats = {{
    {"detect", RecordFormat::detect},
    {"csv", RecordFormat::csv},
    {"at2", RecordFormat::at2},
    {"columns", RecordFormat::columns},
    {"two-columns", RecordFormat::columns},
    {"rows", RecordFormat::rows},
    {"xsens", RecordFormat::xsens},
    {"mseed", RecordFormat::mseed},
    {"mat", RecordFormat::mat},
    {"cosmos", RecordFormat::cosmos},
    {"smc", RecordFormat::smc},
    {"knet", RecordFormat::knet},
    {"sac", RecordFormat::sac},
    {"csmip", RecordFormat::csmip},
    {"esm", RecordFormat::esm},
    {"geonet", RecordFormat::geonet},
}};

}  // namespace

std::optional<RecordFormat> record_format(std::string_view name) {
  for (const auto& [known, format] : kFormats)
    if (known == name) return format;
  return std::nullopt;
}

std::string record_format_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, format] : kFormats)
    if (name != "detect" && name != "two-columns") names.push_back(name);
  return fmt::format("{} or {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

}  // namespace framewatch::drivers
