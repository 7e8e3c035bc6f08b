#include "daemon/tools/init/answer_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

constexpr int kMaxBays = 20;
constexpr std::size_t kMaxDecimals = 3;  ///< that anybody types: 18000,20000 are two masses

bool may_be_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  const auto is_digit = [&](std::size_t at) {
    return at < text.size() && text[at] >= '0' && text[at] <= '9';
  };
  std::size_t decimals = 0;
  while (comma != std::string_view::npos && is_digit(comma + 1 + decimals)) ++decimals;
  return decimals > 0 && decimals <= kMaxDecimals && comma > 0 && is_digit(comma - 1) &&
         text.find(',', comma + 1) == std::string_view::npos &&
         text.find('.') == std::string_view::npos;
}

}  // namespace

std::string why_no_quantity(std::string_view text, const std::string& rule) {
  if (!may_be_decimal_comma(text)) return rule;
  return "a comma between two digits can be read in two ways: write 3.5, or 3, 5 with a blank";
}

std::optional<Quantity> parse_quantity(std::string_view text) {
  if (may_be_decimal_comma(text)) return std::nullopt;
  Quantity out;
  std::string_view rest = drivers::trimmed(text);
  for (;;) {
    const std::size_t end = rest.find_first_not_of("0123456789.eE+-");
    std::string_view number = rest.substr(0, end);
    auto value = drivers::parse_number(number);
    if (!value || !std::isfinite(*value) || *value <= 0) return std::nullopt;
    out.values.push_back(*value);
    rest = drivers::trimmed(rest.substr(number.size()));
    if (rest.empty() || rest.front() != ',') break;
    rest = drivers::trimmed(rest.substr(1));
  }
  out.unit = std::string(rest);
  std::erase(out.unit, ' ');
  return out;
}

std::optional<std::vector<double>> spread(const std::vector<double>& values, std::size_t count) {
  if (values.size() == 1) return std::vector<double>(count, values.front());
  if (values.size() == count) return values;
  return std::nullopt;
}

std::optional<Bays> parse_bays(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto x = drivers::parse_integer(drivers::trimmed(text.substr(0, cross)));
  const auto y = drivers::parse_integer(drivers::trimmed(text.substr(cross + 1)));
  const auto good = [](const auto& n) { return n && *n >= 0 && *n <= kMaxBays; };
  if (!good(x) || !good(y)) return std::nullopt;
  return Bays{static_cast<int>(*x), static_cast<int>(*y)};
}

std::string list_text(const std::vector<double>& values) {
  const bool equal =
      std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); });
  std::string out;
  for (const double value : values) {
    out += fmt::format("{}{:.6g}", out.empty() ? "" : ", ", value);
    if (equal) break;
  }
  return out;
}

}  // namespace framewatch::daemon
