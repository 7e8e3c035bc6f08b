#include "fleet/message/key.h"

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "fleet/message/subject.h"

namespace framewatch::fleet {
namespace {

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
