#include "fleet/uplink/verdict.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace framewatch::fleet {
namespace {

using nlohmann::json;

// JetStream says 503 too when a stream (10077) or the account (10023) is full; its own code tells
// them apart.
constexpr std::array<std::int64_t, 2> kFull{10077, 10023};

std::int64_t number_of(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number_integer() ? found->get<std::int64_t>() : 0;
}

Verdict refusal_of(const json& error) {
  Verdict out{Verdict::kUnavailable, "refused"};
  const std::int64_t code = number_of(error, "code"), own = number_of(error, "err_code");
  const bool full = std::find(kFull.begin(), kFull.end(), own) != kFull.end();
  if (full)
    out.code = static_cast<int>(own);
  else if (code > 0 && code < INT32_MAX)
    out.code = static_cast<int>(code);
  if (const auto why = error.find("description"); why != error.end() && why->is_string())
    out.why = why->get<std::string>();
  return out;
}

}  // namespace

Verdict verdict_of(const Message& answer) {
  if (answer.header(header::kStatus) == "503") return {Verdict::kUnavailable, "no stream is there"};
  const json document = json::parse(answer.bytes.begin(), answer.bytes.end(), nullptr, false);
  if (!document.is_object()) return {};
  const auto error = document.find("error");
  if (error != document.end() && error->is_object()) return refusal_of(*error);
  if (!document.contains("seq")) return {};
  const auto duplicate = document.find("duplicate");
  return {0, "", duplicate != document.end() && *duplicate == true};
}

}  // namespace framewatch::fleet
