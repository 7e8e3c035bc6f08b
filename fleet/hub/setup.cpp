#include "fleet/hub/setup.h"

#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr int kNotFound = 404;

std::string name_of(const HubPart& part) {
  return part.consumer.empty() ? part.stream : part.stream + "/" + part.consumer;
}

/// Empty, with the reason, when the hub refuses or says nothing that is understood. An answer that
/// there is no such part is an object without "config".
std::optional<json> asked(const AskHub& ask, const std::string& subject, const json& request,
                          std::string& error) {
  const auto answer = ask("$JS.API." + subject, request.is_null() ? "" : request.dump(), error);
  if (!answer) return std::nullopt;
  json document = json::parse(*answer, nullptr, false);
  if (!document.is_object()) {
    error = "what answers is no JetStream";
    return std::nullopt;
  }
  const auto failure = document.find("error");
  if (failure == document.end()) return document;
  const auto member = [&](const char* name) {
    return failure->is_object() && failure->contains(name) ? (*failure)[name] : json();
  };
  if (member("code") == kNotFound && request.is_null()) return json::object();
  const json why = member("description");
  error = why.is_string() ? why.get<std::string>() : "refused";
  return std::nullopt;
}

/// "max_bytes 1 -> 2, ..." : of the values that matter.
std::string differences(const json& is, const json& should_be) {
  std::string out;
  for (const auto& [key, wanted] : should_be.items()) {
    const auto found = is.find(key);
    // A value that the server leaves out is none, false or nought.
    const bool absent = found == is.end();
    if (absent && (wanted == 0 || wanted == false)) continue;
    if (!absent && *found == wanted) continue;
    out += fmt::format("{}{} {} -> {}", out.empty() ? "" : ", ", key,
                       absent ? "none" : found->dump(), wanted.dump());
  }
  return out;
}

std::string info_subject(const HubPart& part) {
  return part.consumer.empty() ? "STREAM.INFO." + part.stream
                               : fmt::format("CONSUMER.INFO.{}.{}", part.stream, part.consumer);
}

/// The call that makes the part, or changes it when it is there.
std::pair<std::string, json> making(const HubPart& part, bool is_there) {
  const json config = json::parse(part.config);
  if (part.consumer.empty())
    return {fmt::format("STREAM.{}.{}", is_there ? "UPDATE" : "CREATE", part.stream), config};
  return {fmt::format("CONSUMER.DURABLE.CREATE.{}.{}", part.stream, part.consumer),
          {{"stream_name", part.stream}, {"config", config}}};
}

}  // namespace

SetupOutcome set_up(const std::vector<HubPart>& parts, const AskHub& ask, bool only_look) {
  SetupOutcome out;
  for (const HubPart& part : parts) {
    const std::string name = name_of(part);
    std::string error;
    const auto info = asked(ask, info_subject(part), nullptr, error);
    if (!info) {
      out.problems.push_back(fmt::format("{}: {}", name, error));
      continue;
    }
    const auto config = info->find("config");
    const bool is_there = config != info->end();
    const std::string differs =
        is_there ? differences(*config, json::parse(part.config)) : "missing";
    if (differs.empty()) {
      out.lines.push_back(name + ": as it should be");
      continue;
    }
    ++out.changed;
    if (only_look) {
      out.lines.push_back(fmt::format("{}: {}", name, differs));
      continue;
    }
    const auto [subject, request] = making(part, is_there);
    if (asked(ask, subject, request, error))
      out.lines.push_back(is_there ? fmt::format("{}: changed: {}", name, differs)
                                   : name + ": made");
    else
      out.problems.push_back(fmt::format("{}: {} ({})", name, error, differs));
  }
  return out;
}

}  // namespace framewatch::fleet
