#include "daemon/base/json_values.h"

#include <nlohmann/json.hpp>

namespace framewatch::daemon {

Json json_value(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string json_value_text(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace framewatch::daemon
