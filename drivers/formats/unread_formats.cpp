// SPDX-License-Identifier: MIT
#include "drivers/formats/unread_formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

struct KnownUnread {
  std::string_view begins;
  std::string_view what, instead;
};

constexpr std::string_view kExport =
    "export it as CSV or MATLAB .mat from the program that wrote it";
constexpr std::array kUnread = {
    KnownUnread{"MDF     ", "ASAM MDF", kExport},
    KnownUnread{"UnFinMF ", "ASAM MDF, unfinished", kExport},
    KnownUnread{"\x89HDF\r\n\x1a\n", "HDF5, but not a MATLAB file", kExport},
    KnownUnread{"\x93NUMPY", "a NumPy array (.npy)",
                "write it with numpy.savetxt, or as .mat with scipy.io.savemat"},
    KnownUnread{"PK\x03\x04", "an Excel workbook (.xlsx) or another ZIP archive",
                "save the sheet as CSV UTF-8, or unpack the archive"},
    KnownUnread{"\xD0\xCF\x11\xE0", "an Excel workbook (.xls)", "save the sheet as CSV UTF-8"},
    KnownUnread{"TDSm", "a LabVIEW TDMS file",
                "write CSV with LabVIEW, or with Python's npTDMS (as_dataframe, to_csv)"},
    KnownUnread{"LabVIEW Measurement", "a LabVIEW measurement file (.lvm)",
                "write CSV with LabVIEW, or with Python's lvm_read; its table is below the second "
                "***End_of_Header***"},
    KnownUnread{"MS\x03", "miniSEED 3", "write miniSEED 2"},
    KnownUnread{"000001V ", "a full SEED volume", "extract its data records as miniSEED 2"},
};

/// Returns the first `count` lines of a text; fewer when it has fewer complete ones.
std::vector<std::string_view> first_lines(std::string_view text, std::size_t count) {
  std::vector<std::string_view> lines;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos && lines.size() < count;
       end = text.find('\n')) {
    lines.push_back(trimmed(text.substr(0, text.find_first_of("\r\n"))));
    text.remove_prefix(end + 1);
  }
  return lines;
}

/// Returns true if `head` begins a Universal File: a line of -1, then the number of a data set (58,
/// 58b, 151).
bool is_universal_file(std::string_view head) {
  const auto lines = first_lines(head, 2);
  if (lines.size() < 2 || lines[0] != "-1") return false;
  std::string_view number = lines[1].substr(0, lines[1].find(' '));
  if (number.ends_with('b')) number.remove_suffix(1);
  return parse_integer(number).value_or(0) > 0;
}

/// Returns true if `head` begins SAC's alphanumeric form: 14 lines of 5 real numbers, then 8 lines
/// of 5 whole numbers, of which the seventh is the version, 6 or 7.
bool is_sac_text(std::string_view head) {
  constexpr std::size_t kRealLines = 14, kPerLine = 5;
  const auto lines = first_lines(head, kRealLines + 2);
  if (lines.size() < kRealLines + 2) return false;
  std::vector<std::string_view> fields;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    split_blanks(lines[i], fields);
    const bool numbers = fields.size() == kPerLine &&
                         std::all_of(fields.begin(), fields.end(), [&](std::string_view field) {
                           return i < kRealLines ? parse_number(field).has_value()
                                                 : parse_integer(field).has_value();
                         });
    if (!numbers) return false;
  }
  return fields[1] == "6" || fields[1] == "7";
}

std::uint32_t word_at(std::string_view bytes, std::size_t at, bool big_endian) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word = word << 8 | static_cast<std::uint8_t>(bytes[at + (big_endian ? i : 3 - i)]);
  return word;
}

/// Returns true if `head` begins a MATLAB file of level 4. It has five whole numbers: the type
/// (precision and kind of matrix, plus 1000 for big-endian numbers), rows, columns, 1 for complex
/// numbers, the length of the name. The name and a zero follow. MathWorks, "MAT-File Format".
bool is_matlab_4(std::string_view head) {
  constexpr std::size_t kNameAt = 20, kLongestName = 64;
  constexpr std::uint32_t kBigEndian = 1000, kLastType = 52, kMostRows = 1U << 31;
  if (head.size() < kNameAt) return false;
  for (const bool big_endian : {false, true}) {
    const auto word = [&](std::size_t i) { return word_at(head, 4 * i, big_endian); };
    const std::uint32_t type = word(0) - (big_endian ? kBigEndian : 0), length = word(4);
    const bool sound = type <= kLastType && type % 10 <= 2 && word(1) < kMostRows &&
                       word(2) < kMostRows && word(3) <= 1 && length > 1 &&
                       length <= kLongestName && head.size() >= kNameAt + length;
    if (!sound || head[kNameAt + length - 1] != '\0') continue;
    const std::string_view name = head.substr(kNameAt, length - 1);
    if (std::all_of(name.begin(), name.end(),
                    [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; }))
      return true;
  }
  return false;
}

/// Returns true if `head` begins an event file of a Kinemetrics recorder: a tag of 16 bytes with
/// 'K', the byte order, the type 1 (header) and the header's length.
bool is_kinemetrics_event(std::string_view head) {
  constexpr std::uint32_t kHeaderTag = 1;
  if (head.size() < 16 || head[0] != 'K' || (head[1] != 0 && head[1] != 1)) return false;
  const bool big_endian = head[1] == 1;
  const std::uint32_t length = word_at(head, 8, big_endian) >> (big_endian ? 16 : 0) & 0xffff;
  return word_at(head, 4, big_endian) == kHeaderTag && (length == 2040 || length == 2736);
}

}  // namespace

std::string unread_format(std::string_view head) {
  KnownUnread found;
  for (const KnownUnread& known : kUnread)
    if (head.starts_with(known.begins)) found = known;
  if (is_universal_file(head)) found = {"", "a Universal File (UFF, UNV)", kExport};
  if (is_sac_text(head))
    found = {"", "the alphanumeric form of SAC", "write it as binary SAC (r alpha FILE; w FILE)"};
  if (is_matlab_4(head))
    found = {"", "a MATLAB file of level 4", "load it and save it again with -v7"};
  if (is_kinemetrics_event(head))
    found = {"", "an event file of a Kinemetrics recorder (.evt)",
             "write miniSEED 2 with ObsPy, or text with Kinemetrics' KW2ASC"};
  if (found.what.empty()) return "";
  return fmt::format("is {}, which is not supported: {}", found.what, found.instead);
}

}  // namespace framewatch::drivers
