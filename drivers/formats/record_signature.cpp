#include "drivers/formats/record_signature.h"

#include <libmseed.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "drivers/files/packed_file.h"
#include "drivers/formats/mat_signature.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

struct KnownUnread {
  std::string_view begins;
  std::string_view what;
};

constexpr std::string_view kInstead = "export it as CSV or MATLAB .mat from the program it is of";
constexpr std::array kUnread = {
    KnownUnread{"MDF     ", "ASAM MDF"},
    KnownUnread{"UnFinMF ", "ASAM MDF, not finished"},
    KnownUnread{"\x89HDF\r\n\x1a\n", "HDF5, but no MATLAB file"},
};

/// Between two lines of -1 a Universal File has its data sets, each with its number: 58, 58b, 151.
bool is_universal_file(std::string_view head) {
  std::array<std::string_view, 2> lines;
  for (std::string_view& line : lines) {
    const std::size_t end = head.find('\n');
    if (end == std::string_view::npos) return false;
    line = trimmed(head.substr(0, head.find_first_of("\r\n")));
    head.remove_prefix(end + 1);
  }
  std::string_view number = lines[1].substr(0, lines[1].find(' '));
  if (number.ends_with('b')) number.remove_suffix(1);
  return lines[0] == "-1" && parse_integer(number).value_or(0) > 0;
}

std::string bytes_of(FileProblems& problems) {
  GzipInput file(problems.path());
  std::string head(kSacHeaderBytes, '\0');
  const std::int64_t got = file.read(head.data(), std::ssize(head));
  if (!file.error().empty()) problems.add(0, file.error());
  head.resize(static_cast<std::size_t>(std::max<std::int64_t>(got, 0)));
  return head;
}

}  // namespace

std::optional<RecordFormat> format_by_signature(FileProblems& problems) {
  const std::string head = bytes_of(problems);
  if (mat_level(head) != MatLevel::none) return RecordFormat::mat;
  if (head.size() >= 48 && MS_ISVALIDHEADER(head.data())) return RecordFormat::mseed;
  if (is_sac_header(head)) return RecordFormat::sac;
  std::string what;
  for (const KnownUnread& known : kUnread)
    if (head.starts_with(known.begins)) what = known.what;
  if (is_universal_file(head)) what = "a Universal File (UFF, UNV)";
  if (!what.empty()) problems.add(0, fmt::format("is {}, which is not read: {}", what, kInstead));
  if (head.starts_with("MS\x03"))
    problems.add(0, "is miniSEED 3, which is not read: write miniSEED 2");
  if (head.starts_with("000001V "))
    problems.add(0, "is a full SEED volume: extract its data records as miniSEED 2");
  return std::nullopt;
}

}  // namespace framewatch::drivers
