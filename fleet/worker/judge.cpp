// SPDX-License-Identifier: MIT
#include "fleet/worker/judge.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "drivers/files/number_text.h"
#include "drivers/lcm/message_check.h"
#include "fleet/message/address.h"

namespace framewatch::fleet {
namespace {

constexpr std::size_t kMaxBytes = 4 << 20;  // unpacked
constexpr std::int64_t kMaxPieces = 100'000;
constexpr std::size_t kLongestWhy = 1000;
constexpr std::size_t kDigestDigits = 64;

/// Kinds of which the hub keeps only the newest message, with their types.
struct NewestKind {
  const char *kind, *type;
};
constexpr NewestKind kNewest[] = {{"service", "service_t"},
                                  {"status", "status_t"},
                                  {"history", "history_status_t"},
                                  {"watch", "watch_t"},
                                  {"acknowledged", "acknowledged_t"},
                                  {"config", "toml"},
                                  {"inventory", "json"},
                                  {"parameters", "parameter_table_t"}};

bool is_digest(std::string_view text) {
  return text.size() == kDigestDigits && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

bool is_request_name(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-';
  });
}

/// Checks one message.
class Judgement {
 public:
  Judgement(const Message& message, std::int64_t hub_us, FleetBatch& batch)
      : message_(message), hub_us_(hub_us), batch_(batch) {}

  void run() {
    const auto parts = up_parts(message_.subject);
    if (!parts) return refuse("its subject is not fw.up.BUILDING.KIND");
    building_ = parts->building;
    kind_ = parts->kind;
    key_ = key_of_sealed(message_.header(header::kKey));
    const auto key = key_parts(key_);
    if (!key) return refuse("its key (Nats-Msg-Id) is missing");
    if (key->building != building_)
      return refuse(fmt::format("its key names {}, its subject {}", key->building, building_));
    type_ = message_.header(header::kType);
    std::string why;
    auto content = unpacked(message_, kMaxBytes, why);
    if (!content) return refuse(why);
    content_ = std::move(*content);
    if (kind_ == "event") return event();
    if (kind_.starts_with("summary.")) return summary();
    if (kind_.starts_with("raw.")) return piece();
    for (const NewestKind& newest : kNewest)
      if (kind_ == newest.kind) return this->newest(newest.type);
    unknown();
  }

 private:
  void other(std::string reason) {
    batch_.others.push_back({message_.subject, key_, std::move(reason), type_,
                             message_.header(header::kVersion), message_.bytes});
  }
  void refuse(std::string reason) { other(std::move(reason)); }
  void unknown() { other(""); }

  /// Decodes the content. Returns nullopt after adding the message to `others` if it fails.
  template <typename Type>
  std::optional<Type> taken(const char* type) {
    if (type_ != type) {
      refuse(fmt::format("{} must be {}, not {}", kind_, type, type_));
      return std::nullopt;
    }
    auto message = drivers::decoded<Type>(content_);
    if (message) return message;
    const auto print = drivers::fingerprint(content_);
    // A newer program in a building must not stop the others.
    if (print && drivers::known_type(*print) == nullptr)
      unknown();
    else
      refuse(drivers::why_not(type, content_));
    return std::nullopt;
  }
  bool is_key(const std::string& wanted) {
    if (key_ == wanted) return true;
    refuse("its key does not match its content, " + wanted);
    return false;
  }

  void event() {
    auto event = taken<event_t>("event_t");
    if (event && is_key(message_key(building_, event_key(*event))))
      batch_.events.push_back({building_, std::move(*event)});
  }

  void summary() {
    auto s = taken<summary_t>("summary_t");
    if (!s || !is_key(message_key(building_, SummaryKey{s->period_s, s->start_us}))) return;
    if (kind_ != fmt::format("summary.{}", s->period_s))
      return refuse(fmt::format("its subject says {}, its content {} s", kind_, s->period_s));
    if (s->start_us < 0 || s->start_us > hub_us_ + daemon::kDay_us)
      return refuse(fmt::format("it begins at {} us, before 1970 or after tomorrow", s->start_us));
    if (!s->config_sha256.empty() && !is_digest(s->config_sha256))
      return refuse("its configuration digest is not a SHA-256");
    batch_.summaries.push_back({building_, std::move(*s)});
  }

  void newest(const char* type) {
    if (kind_ == "parameters") {
      auto table = taken<parameter_table_t>(type);
      if (!table) return;
      if (!is_digest(table->config_sha256))
        return refuse("its configuration digest is not a SHA-256");
      batch_.parameters.push_back({building_, std::move(*table)});
    } else if (type_ != type) {
      return refuse(fmt::format("{} must be {}, not {}", kind_, type, type_));
    }
    batch_.newest.push_back({building_, kind_, type_, std::move(content_)});
  }

  void piece() {
    const auto piece = drivers::parse_integer(message_.header(header::kPiece));
    const auto pieces = drivers::parse_integer(message_.header(header::kPieces));
    const std::string request = kind_.substr(4);
    if (!is_request_name(request)) return refuse("its request must be a name of a-z, 0-9 and -");
    const bool says_why_none = piece == 0 && pieces == 0;
    if (!piece || !pieces || *piece < 0 || *pieces > kMaxPieces ||
        (*piece >= *pieces && !says_why_none))
      return refuse("its piece number is not valid");
    if (says_why_none && content_.size() > kLongestWhy)
      return refuse("its reason for sending nothing is too long");
    if (!is_key(raw_key(building_, request, *piece))) return;
    batch_.pieces.push_back({building_, request, message_.header(header::kFile),
                             static_cast<std::int32_t>(*piece), static_cast<std::int32_t>(*pieces),
                             std::move(content_)});
  }

  const Message& message_;
  std::int64_t hub_us_;
  FleetBatch& batch_;
  std::string building_, kind_, key_, type_;
  Bytes content_;
};

}  // namespace

void judge(const Message& message, std::int64_t hub_us, FleetBatch& batch) {
  Judgement(message, hub_us, batch).run();
}

}  // namespace framewatch::fleet
