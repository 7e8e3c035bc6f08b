// SPDX-License-Identifier: MIT
// FDSN StationXML: the parts that a record of accelerations needs.
// https://docs.fdsn.org/projects/stationxml
#include "drivers/stations/station_xml.h"

#include <expat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "drivers/files/packed_file.h"
#include "drivers/records/unit_text.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kMaxBytes = std::int64_t{64} << 20;
constexpr std::size_t kDeepest = 32, kMaxChannels = 100'000, kLongestText = 1000;

/// Returns a name without the prefix of its namespace.
std::string_view local_name(std::string_view name) {
  return name.substr(name.find(':') + 1);
}

/// Collects channels while expat walks through the elements; open_ holds the path to the current
/// one.
class StationXmlReader {
 public:
  explicit StationXmlReader(FileProblems& problems)
      : problems_(problems), parser_(XML_ParserCreate(nullptr)) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const char* name, const char** attributes) {
          static_cast<StationXmlReader*>(self)->begin(local_name(name), attributes);
        },
        [](void* self, const char* /*name*/) { static_cast<StationXmlReader*>(self)->end(); });
    XML_SetCharacterDataHandler(parser_.get(), [](void* self, const char* text, int length) {
      static_cast<StationXmlReader*>(self)->take_text(text, static_cast<std::size_t>(length));
    });
    XML_SetStartDoctypeDeclHandler(parser_.get(), [](void* self, const char*, const char*,
                                                     const char*, int) {
      static_cast<StationXmlReader*>(self)->stop("has a document type, which no StationXML has");
    });
  }

  std::vector<StationXmlChannel> read() {
    GzipInput file(problems_.path());
    if (!file.is_open()) problems_.add(0, file.error());
    std::array<char, 16384> bytes{};
    std::int64_t all = 0;
    for (bool ended = false; !problems_.any() && !ended;) {
      const std::int64_t got = file.read(bytes.data(), std::ssize(bytes));
      if (got < 0) problems_.add(0, file.error());
      all += got;
      if (all > kMaxBytes) problems_.add(0, fmt::format("is longer than {} MiB", kMaxBytes >> 20));
      if (problems_.any()) break;
      ended = got < std::ssize(bytes);
      if (XML_Parse(parser_.get(), bytes.data(), static_cast<int>(got), ended) ==
              XML_STATUS_ERROR &&
          !problems_.any())
        problems_.add(line(), fmt::format("is not XML: {}",
                                          XML_ErrorString(XML_GetErrorCode(parser_.get()))));
    }
    if (!problems_.any() && channels_.empty()) problems_.add(0, "has no channel");
    return std::move(channels_);
  }

 private:
  using Path = std::initializer_list<std::string_view>;

  struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };

  std::int64_t line() const {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9  // which deprecates the other function
    return static_cast<std::int64_t>(XML_GetCurrentLineNumber64(parser_.get()));
#else
    return static_cast<std::int64_t>(XML_GetCurrentLineNumber(parser_.get()));
#endif
  }

  void stop(const std::string& why) {
    problems_.add(line(), why);
    stopped_ = true;  // expat still calls some handlers
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  void begin(std::string_view name, const char** attributes) {
    if (stopped_) return;
    text_.clear();
    if (open_.empty() && name != "FDSNStationXML")
      return stop(fmt::format("is not StationXML: its root element is {}", show_text(name)));
    if (open_.size() >= kDeepest) return stop(fmt::format("is nested more than {} deep", kDeepest));
    open_.emplace_back(name.substr(0, kLongestText));
    const auto attribute = [&](std::string_view wanted) -> std::string {
      for (const char** a = attributes; *a != nullptr; a += 2)
        if (local_name(a[0]) == wanted) return a[1];
      return {};
    };
    if (is_open({"Network"}, 1)) network_ = attribute("code");
    if (is_open({"Network", "Station"}, 1)) station_ = attribute("code");
    if (!is_open({"Network", "Station", "Channel"}, 1)) return;
    if (channels_.size() >= kMaxChannels)
      return stop(fmt::format("has more than {} channels", kMaxChannels));
    StationXmlChannel& channel = channels_.emplace_back();
    channel.line = line();
    channel.name = fmt::format("{}.{}.{}.{}", trimmed(network_), trimmed(station_),
                               trimmed(attribute("locationCode")), trimmed(attribute("code")));
    channel.start_utc_s = time_of(attribute("startDate"));
    channel.end_utc_s = time_of(attribute("endDate"));
  }

  void take_text(const char* text, std::size_t length) {
    if (text_.size() + length <= kLongestText) text_.append(text, length);
  }

  void end() {
    if (stopped_) return;
    take_element(std::string(trimmed(text_)));
    text_.clear();
    open_.pop_back();
  }

  /// Takes the text of an element below a channel.
  void take_element(const std::string& text) {
    if (open_.size() <= 4 || !begins_with_channel()) return;
    StationXmlChannel& channel = channels_.back();
    AxisHeader& header = channel.header;
    const auto is = [&](Path path) { return is_open(path, 4); };
    if (is({"Description"})) header.place = text;
    if (is({"Latitude"})) header.latitude_deg = number(text, "Latitude", -90, 90);
    if (is({"Longitude"})) header.longitude_deg = number(text, "Longitude", -360, 360);
    if (is({"Azimuth"})) header.azimuth_deg = number(text, "Azimuth", -360, 360);
    if (is({"Dip"})) {
      const auto dip = number(text, "Dip", -90, 90);
      if (dip) header.elevation_deg = *dip == 0 ? 0 : -*dip;
    }
    if (is({"SampleRate"})) channel.rate_hz = number(text, "SampleRate", 0, 1e6);
    if (is({"Response", "InstrumentSensitivity", "Value"}))
      channel.sensitivity = number(text, "InstrumentSensitivity", -1e30, 1e30);
    if (is({"Response", "InstrumentSensitivity", "InputUnits", "Name"})) channel.input_unit = text;
    if (is({"Response", "InstrumentSensitivity", "OutputUnits", "Name"})) header.unit = text;
  }

  std::optional<double> number(const std::string& text, const char* what, double least,
                               double most) {
    const auto value = parse_number(text);
    if (value && *value >= least && *value <= most) return value;
    return problems_.add(line(), fmt::format("{} {} is not a number from {:g} to {:g}", what,
                                             show_text(text), least, most));
  }

  /// Parses a time such as "2018-11-30T00:00:00.0000Z", in UTC when it has no zone. Returns nullopt
  /// for an empty text, and with a problem for an invalid one.
  std::optional<double> time_of(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const auto stamp = parse_time_stamp(text);
    if (!stamp) return problems_.add(line(), fmt::format("{} is not a time", show_text(text)));
    return stamp->local_s - 60.0 * stamp->offset_min.value_or(0);
  }

  /// Returns true if `path` is the open elements without the `first` outermost ones.
  bool is_open(Path path, std::ptrdiff_t first) const {
    return std::equal(open_.begin() + first, open_.end(), path.begin(), path.end());
  }
  bool begins_with_channel() const {
    return open_[1] == "Network" && open_[2] == "Station" && open_[3] == "Channel" &&
           !channels_.empty();
  }

  FileProblems& problems_;
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  bool stopped_ = false;
  std::vector<std::string> open_;  ///< names of the open elements, the root first
  std::string text_, network_, station_;
  std::vector<StationXmlChannel> channels_;
};

constexpr double kSameRateRatio = 1e-3;

std::string note_of(const StationXmlChannel& channel, double unit_mps2, double rate_hz,
                    const std::string& path) {
  const AxisHeader& header = channel.header;
  std::string out = fmt::format("{}: {}{}{}, {:.6g} m/s2 per count ({}, line {})", channel.name,
                                direction_text(header), header.place.empty() ? "" : ", ",
                                header.place, unit_mps2, path, channel.line);
  if (channel.rate_hz && std::abs(*channel.rate_hz / rate_hz - 1) > kSameRateRatio)
    out += fmt::format("; StationXML says {:g} Hz, the record {:g} Hz", *channel.rate_hz, rate_hz);
  return out + "; not used: the response's stages, elevation, depth";
}

}  // namespace

std::optional<std::vector<StationXmlChannel>> read_station_xml(const std::string& path,
                                                               std::vector<Problem>& found) {
  FileProblems problems(path, found);
  std::vector<StationXmlChannel> channels = StationXmlReader(problems).read();
  if (problems.any()) return std::nullopt;
  return channels;
}

const StationXmlChannel* channel_at(const std::vector<StationXmlChannel>& channels,
                                    std::string_view name, double utc_s, std::string& why) {
  const StationXmlChannel* found = nullptr;
  bool named = false;
  for (const StationXmlChannel& channel : channels) {
    if (channel.name != name) continue;
    named = true;
    const bool begun = !channel.start_utc_s || utc_s >= *channel.start_utc_s;
    const bool ended = channel.end_utc_s && utc_s >= *channel.end_utc_s;
    if (!begun || ended) continue;
    if (found != nullptr) {
      why = fmt::format("has two epochs of {} at that time, on lines {} and {}", name, found->line,
                        channel.line);
      return nullptr;
    }
    found = &channel;
  }
  if (found == nullptr)
    why = named ? fmt::format("has {}, but not at the time of the record", name)
                : fmt::format("has no channel {}", name);
  return found;
}

std::optional<double> mps2_per_count(const StationXmlChannel& channel, std::string& why) {
  const auto unit_mps2 = mps2_per(channel.input_unit);
  if (!channel.sensitivity || *channel.sensitivity == 0)
    why = fmt::format("{} has no InstrumentSensitivity", channel.name);
  else if (!unit_mps2)
    why = fmt::format("{} measures {}, which is not a known unit of acceleration", channel.name,
                      show_text(channel.input_unit));
  else
    return *unit_mps2 / *channel.sensitivity;
  return std::nullopt;
}

std::optional<CountMeanings> CountMeanings::read(const RecordOptions& options,
                                                 FileProblems& problems) {
  CountMeanings out;
  out.declared_mps2_ = options.unit_mps2;
  out.path_ = options.station_xml;
  if (out.path_.empty()) return out;
  std::vector<Problem> found;
  auto channels = read_station_xml(out.path_, found);
  for (const Problem& p : found) problems.add(0, fmt::format("{}: {}", p.where, p.message));
  if (!channels) return std::nullopt;
  out.channels_ = std::move(*channels);
  return out;
}

std::optional<CountMeaning> CountMeanings::of(const std::string& name,
                                              std::optional<double> start_utc_s, double rate_hz,
                                              FileProblems& problems) const {
  if (path_.empty()) return CountMeaning{declared_mps2_.value_or(1), {}, ""};
  std::string why;
  const StationXmlChannel* channel =
      start_utc_s ? channel_at(channels_, name, *start_utc_s, why) : nullptr;
  if (!start_utc_s) why = "the record has no time, so its epoch of " + name + " is unknown";
  const auto unit_mps2 = channel != nullptr ? mps2_per_count(*channel, why) : std::nullopt;
  if (unit_mps2)
    return CountMeaning{*unit_mps2, channel->header, note_of(*channel, *unit_mps2, rate_hz, path_)};
  problems.add(0, channel != nullptr ? fmt::format("{}:{}: {}", path_, channel->line, why)
                                     : fmt::format("{}: {}", path_, why));
  return std::nullopt;
}

}  // namespace framewatch::drivers
