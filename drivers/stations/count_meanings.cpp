#include "drivers/stations/count_meanings.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

constexpr double kSameRateRatio = 1e-3;

std::string note_of(const StationXmlChannel& channel, double unit_mps2, double rate_hz,
                    const std::string& path) {
  const AxisHeader& header = channel.header;
  std::string out = fmt::format("{}: {}{}{}, {:.6g} m/s2 a count ({}, line {})", channel.name,
                                direction_text(header), header.place.empty() ? "" : ", ",
                                header.place, unit_mps2, path, channel.line);
  if (channel.rate_hz && std::abs(*channel.rate_hz / rate_hz - 1) > kSameRateRatio)
    out += fmt::format("; there it has {:g} Hz, in the record {:g} Hz", *channel.rate_hz, rate_hz);
  return out + "; not used: the response's stages, elevation, depth";
}

}  // namespace

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
  if (!start_utc_s) why = "the record has no time, so no epoch of " + name + " is its";
  const auto unit_mps2 = channel != nullptr ? mps2_per_count(*channel, why) : std::nullopt;
  if (unit_mps2)
    return CountMeaning{*unit_mps2, channel->header, note_of(*channel, *unit_mps2, rate_hz, path_)};
  problems.add(0, channel != nullptr ? fmt::format("{}:{}: {}", path_, channel->line, why)
                                     : fmt::format("{}: {}", path_, why));
  return std::nullopt;
}

}  // namespace framewatch::drivers
