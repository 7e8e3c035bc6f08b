#include "fleet/message/subject.h"

#include <algorithm>

namespace framewatch::fleet {
namespace {

constexpr std::size_t kLongestBuilding = 32, kLongestKind = 64;
constexpr std::string_view kUp = "fw.up.", kDown = "fw.down.", kEvery = "all";

bool is_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
}

bool is_kind(std::string_view kind) {
  if (kind.empty() || kind.size() > kLongestKind || kind.front() == '.' || kind.back() == '.')
    return false;
  if (kind.find("..") != kind.npos) return false;
  return std::all_of(kind.begin(), kind.end(),
                     [](char c) { return is_of_name(c) || c == '.' || c == '_'; });
}

std::optional<SubjectParts> parts_after(std::string_view prefix, std::string_view subject) {
  if (!subject.starts_with(prefix)) return std::nullopt;
  subject.remove_prefix(prefix.size());
  const std::size_t dot = subject.find('.');
  if (dot == subject.npos) return std::nullopt;
  SubjectParts out{std::string(subject.substr(0, dot)), std::string(subject.substr(dot + 1))};
  if (!is_kind(out.kind)) return std::nullopt;
  return out;
}

}  // namespace

bool is_building_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestBuilding && name != kEvery &&
         std::all_of(name.begin(), name.end(), is_of_name);
}

std::string up_subject(std::string_view building, std::string_view kind) {
  return std::string(kUp).append(building).append(".").append(kind);
}

std::string down_subject(std::string_view building, std::string_view verb) {
  return std::string(kDown).append(building).append(".").append(verb);
}

std::optional<SubjectParts> up_parts(std::string_view subject) {
  auto out = parts_after(kUp, subject);
  if (out && !is_building_name(out->building)) return std::nullopt;
  return out;
}

std::optional<SubjectParts> down_parts(std::string_view subject) {
  auto out = parts_after(kDown, subject);
  if (out && out->building != kEvery && !is_building_name(out->building)) return std::nullopt;
  return out;
}

}  // namespace framewatch::fleet
