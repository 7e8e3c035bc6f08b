#include "drivers/stations/cosmos_header.h"

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "drivers/stations/fortran_numbers.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kIntegersRead = 76, kRealsRead = 64;

/// A line "100 Real-header values follow on 20 lines, Format= (5F15.6)" and the values.
std::vector<double> read_list(LineReader& lines, std::string_view what, std::size_t least,
                              FileProblems& problems) {
  std::string_view line;
  if (!lines.next(line) || !holds(line, what)) {
    if (!problems.any())
      problems.add(lines.number(), fmt::format("COSMOS: the {} are not here", what));
    return {};
  }
  const auto count = parse_integer(first_word(trimmed(line)));
  const auto format = find_fortran_format(line);
  if (!count || !format || *count < static_cast<std::int64_t>(least)) {
    problems.add(lines.number(), fmt::format("COSMOS: the {} need their number, {} at least, "
                                             "and a format such as (10I8)",
                                             what, least));
    return {};
  }
  return read_fortran_numbers(lines, *format, static_cast<std::size_t>(*count), what, problems)
      .value_or(std::vector<double>{});
}

/// "Values used when parameter or data value is unknown/unspecified:   -999, -999.00"
void read_unknown(CosmosHeader& header) {
  std::vector<std::string_view> fields;
  split_commas(after(header, "unspecified:"), fields);
  if (const auto value = parse_number(fields.front())) header.unknown_integer = *value;
  if (const auto value = parse_number(fields.back())) header.unknown_real = *value;
}

/// "|<SCNL>8040.HNE.NP.01": station, channel, network, location.
void read_comments(LineReader& lines, CosmosHeader& header, FileProblems& problems) {
  std::string_view line;
  if (!lines.next(line)) return;
  const auto count = parse_integer(first_word(trimmed(line)));
  if (!count || *count < 0 || !holds(line, "omment")) {
    problems.add(lines.number(), "COSMOS: the number of comment lines is not here");
    return;
  }
  for (std::int64_t i = 0; i < *count && lines.next(line); ++i) {
    const auto at = line.find("<SCNL>");
    if (at == std::string_view::npos) continue;
    std::string dotted(first_word(line.substr(at + 6)));
    std::vector<std::string> parts(1);
    for (const char c : dotted) {
      if (c == '.')
        parts.emplace_back();
      else
        parts.back() += c;
    }
    if (parts.size() == 4)
      header.seed_name = fmt::format("{}.{}.{}.{}", parts[2], parts[0], parts[3], parts[1]);
  }
}

}  // namespace

bool holds(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

std::string_view after(const CosmosHeader& header, std::string_view mark) {
  for (const std::string& line : header.text)
    if (const auto at = line.find(mark); at != std::string::npos)
      return trimmed(std::string_view(line).substr(at + mark.size()));
  return {};
}

std::string_view first_word(std::string_view text) {
  return text.substr(0, text.find_first_of(" \t"));
}

std::optional<CosmosHeader> read_cosmos_header(LineReader& lines, std::string_view first,
                                               FileProblems& problems) {
  CosmosHeader header;
  header.line = lines.number();
  header.text.emplace_back(first);
  const auto with = first.find("with");
  const auto count = parse_integer(
      with == std::string_view::npos ? "" : first_word(trimmed(first.substr(with + 4))));
  if (!count || *count < 2 || *count > 100) {
    problems.add(header.line, "COSMOS: the first line must say how many lines of text there are");
    return std::nullopt;
  }
  std::string_view line;
  while (header.text.size() < static_cast<std::size_t>(*count) && lines.next(line))
    header.text.emplace_back(line);
  read_unknown(header);
  header.integers = read_list(lines, "nteger-header values", kIntegersRead, problems);
  if (problems.any()) return std::nullopt;
  header.reals = read_list(lines, "eal-header values", kRealsRead, problems);
  if (problems.any()) return std::nullopt;
  read_comments(lines, header, problems);
  return header;
}

}  // namespace framewatch::drivers
