// SPDX-License-Identifier: MIT
#include "fleet/message/address.h"

#include <algorithm>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"

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

constexpr char kSeal = '~';
constexpr std::size_t kSealDigits = 24;

std::string without_slashes(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte <= ' ' || byte >= 0x7f || c == '/' || c == '%')
      out += fmt::format("%{:02X}", byte);
    else
      out += c;
  }
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

EventKey event_key(const event_t& event) {
  return {event.kind, event.id, event.time_us, event.state};
}

std::string message_key(std::string_view building, const EventKey& key) {
  return fmt::format("{}/event/{}/{}/{}/{}", building, without_slashes(key.kind), key.id,
                     key.time_us, key.state);
}

std::string message_key(std::string_view building, const SummaryKey& key) {
  return fmt::format("{}/summary/{}/{}", building, key.period_s, key.start_us);
}

std::string raw_key(std::string_view building, std::string_view request, std::int64_t piece) {
  return fmt::format("{}/raw/{}/{}", building, request, piece);
}

std::string newest_key(std::string_view building, std::string_view kind, std::int64_t time_us) {
  return fmt::format("{}/{}/{}", building, kind, time_us);
}

std::string sealed_key(std::string_view key, std::string_view secret,
                       std::span<const std::uint8_t> content) {
  std::string said(secret);
  said.append(1, '\0').append(key).append(1, '\0').append(content.begin(), content.end());
  return fmt::format("{}{}{}", key, kSeal, daemon::sha256(said).substr(0, kSealDigits));
}

std::string_view key_of_sealed(std::string_view sealed) {
  const std::size_t at = sealed.rfind(kSeal);
  const bool is_sealed = at != sealed.npos && sealed.size() - at == kSealDigits + 1 &&
                         sealed.find('/', at) == sealed.npos;
  return is_sealed ? sealed.substr(0, at) : sealed;
}

std::optional<KeyParts> key_parts(std::string_view key) {
  const std::size_t first = key.find('/');
  if (first == key.npos) return std::nullopt;
  const std::size_t second = key.find('/', first + 1);
  if (second == key.npos || second == first + 1 || second + 1 == key.size()) return std::nullopt;
  KeyParts out{std::string(key.substr(0, first)),
               std::string(key.substr(first + 1, second - first - 1))};
  if (!is_building_name(out.building)) return std::nullopt;
  return out;
}

}  // namespace framewatch::fleet
