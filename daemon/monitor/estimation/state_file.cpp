// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/state_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "drivers/files/descriptor.h"
#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"

namespace framewatch::daemon {
namespace {

struct Description {
  std::string_view name, without;
  /// Sections of the configuration file and further SavedState::grounds on which the section
  /// depends. It is refused when one of them has changed.
  std::vector<std::string> grounds;
};

/// Returns the sections in the order of the file.
const std::array<Description, 11>& descriptions() {
  static const std::array<Description, 11> all{{
      {"counts", "counters of windows start at 0", {}},
      {"events", "raised findings and their acknowledgements are forgotten", {}},
      {"weather", "the readings of weather count as first ones", {"weather", "watch"}},
      {"lcm", "all nodes count as new", {"channel", "lcm"}},
      {"can", "all CAN nodes count as new", {"channel", "can", "estimator"}},
      {"tuning", "filters are tuned again", {"structure", "channel", "parameters"}},
      {"window", "the window starts empty", {"structure", "channel", "estimator", "long window"}},
      {"baseline",
       "baselines and their dependence on amplitude and temperature are learned again",
       {"structure", "parameters"}},
      {"watch",
       "evidence for changes is collected again, and lasting changes are announced again",
       {"structure", "parameters", "estimator", "long window", "watch"}},
      {"gap",
       "the model of the gap monitor is learned again",
       {"structure", "channel", "estimator", "gap"}},
      {"event_report",
       "the report of a strong motion under way starts here",
       {"structure", "channel", "estimator"}},
  }};
  return all;
}

const Description* find(std::string_view name) {
  const auto& all = descriptions();
  const auto found = std::ranges::find(all, name, &Description::name);
  return found == all.end() ? nullptr : &*found;
}

const std::string kMagic = "framewatch state\n";
constexpr std::int32_t kFormat = estimator::kStateFormat;
constexpr std::int32_t kOldestFormat = 17;  ///< the oldest that is read
constexpr std::size_t kDigestBytes = 64;
constexpr std::int64_t kMaxBytes = std::int64_t{1} << 30;
constexpr std::size_t kMaxEntries = 100;  ///< of a list in the head; a real one has about ten
constexpr std::string_view kLaterSection = "weather";  // older files of the same format lack it
constexpr const char* kUnlike = "has impossible sizes or numbers";

/// Archives a list of the head, with its length.
template <typename Archive, typename T>
void archive_list(Archive& a, std::vector<T>& list) {
  const std::size_t count = a.count(list.size());
  if (count > kMaxEntries) return a.refuse();
  list.resize(count);
  for (T& entry : list) entry.archive(a);
}

/// The part of the file before the sections.
struct Head {
  struct Ground {
    std::string name, digest;
    template <typename Archive>
    void archive(Archive& a) {
      a(name, digest);
    }
  };
  struct Entry {
    std::string name;
    std::int64_t size = 0;
    std::string digest;
    template <typename Archive>
    void archive(Archive& a) {
      a(name);
      a.within(size, 0, static_cast<double>(kMaxBytes));
      a(digest);
    }
  };
  std::string magic = kMagic;
  std::int32_t format = kFormat;
  std::string version = FRAMEWATCH_VERSION;
  std::string config_sha256;
  std::int64_t events_before = 0;
  std::vector<Ground> grounds;
  std::vector<Entry> entries;

  template <typename Archive>
  void archive_identity(Archive& a) {
    a(magic, format, version);
  }
  template <typename Archive>
  void archive_rest(Archive& a) {
    a(config_sha256, events_before);
    archive_list(a, grounds);
    archive_list(a, entries);
  }
};

std::string digest_of(const std::vector<std::uint8_t>& bytes) {
  return sha256({bytes.begin(), bytes.end()});
}

std::map<std::string, std::string> grounds_of(const Config& config) {
  std::map<std::string, std::string> out = config.section_sha256;
  const estimator::ParameterTable table = config.pipeline.parameters();
  std::string names;
  for (int p = 0; p < table.size(); ++p) names += table[p].name + "\n";
  out["parameters"] = sha256(names);
  out["long window"] = fmt::format("{}", config.pipeline.options.long_window_s);
  return out;
}

/// Returns, for people, on what a section depends that differs in this configuration; empty if it
/// fits.
std::string other_grounds(const std::string& section, const SavedState& state,
                          const std::map<std::string, std::string>& grounds) {
  const auto in = [](const std::map<std::string, std::string>& all, const std::string& name) {
    const auto found = all.find(name);
    return found == all.end() ? std::string() : found->second;
  };
  std::string out;
  const Description* const description = find(section);
  if (description == nullptr) return out;
  for (const std::string& name : description->grounds) {
    if (in(state.grounds, name) == in(grounds, name)) continue;
    if (!out.empty()) out += ", ";
    out += name == "parameters"    ? "the identified parameters"
           : name == "long window" ? "the length of the long window"
                                   : "[" + name + "]";
  }
  return out;
}

/// A state file with its undamaged sections.
struct ReadState {
  std::string problem = {};
  SavedState state = {};
  std::vector<LostSection> lost = {};
};

ReadState read_state(const std::string& path) {
  ReadState out;
  const std::optional<std::string> text = drivers::read_whole_file(path, kMaxBytes, out.problem);
  if (!text) return out;
  const std::vector<std::uint8_t> bytes{text->begin(), text->end()};
  estimator::StateReader reader(bytes);
  Head head;
  head.magic.clear();
  head.archive_identity(reader);
  if (head.magic != kMagic) return {"is not a state of framewatch"};
  // Another version of the program may load it, so that an upgrade keeps the window.
  if (reader.good() && (head.format < kOldestFormat || head.format > kFormat))
    return {fmt::format("was written by framewatch {} (format {}), this is {} (format {})",
                        head.version, head.format, FRAMEWATCH_VERSION, kFormat)};
  head.archive_rest(reader);
  estimator::StateWriter again;
  if (reader.good()) head.archive_identity(again), head.archive_rest(again);
  const std::vector<std::uint8_t>& own = again.bytes();
  std::size_t at = own.size();
  if (!reader.good() || text->substr(at, kDigestBytes) != digest_of(own))
    return {"is damaged or cut off: the digest of its head does not match"};
  at += kDigestBytes;
  out.state.config_sha256 = head.config_sha256;
  out.state.events_before = head.events_before;
  for (const Head::Ground& ground : head.grounds) out.state.grounds[ground.name] = ground.digest;
  for (const Head::Entry& entry : head.entries) {
    const std::size_t size = std::min(static_cast<std::size_t>(entry.size), bytes.size() - at);
    const auto begin = bytes.begin() + std::ptrdiff_t(at);
    StateSection section{entry.name, {begin, begin + std::ptrdiff_t(size)}, head.format};
    at += size;
    if (size < static_cast<std::size_t>(entry.size))
      out.lost.push_back({entry.name, "is cut off"});
    else if (digest_of(section.bytes) != entry.digest)
      out.lost.push_back({entry.name, "is damaged: its digest does not match"});
    else
      out.state.sections.push_back(std::move(section));
  }
  return out;
}

void lose(ReadState& read, const std::string& name, const std::string& why) {
  std::erase_if(read.state.sections, [&](const StateSection& s) { return s.name == name; });
  read.lost.push_back({name, why});
}

/// Returns the undamaged section of this name, or nullptr.
const StateSection* section_of(const ReadState& read, const std::string& name) {
  const auto& sections = read.state.sections;
  const auto found = std::ranges::find(sections, name, &StateSection::name);
  return found == sections.end() ? nullptr : &*found;
}

/// Keeps the sections that depend on unchanged settings and for which no other section is missing.
void leave_what_fits(ReadState& read, const Config& config, Estimation& estimation) {
  const std::map<std::string, std::string> grounds = grounds_of(config);
  for (const std::string& name : estimation.section_names()) {
    if (section_of(read, name) != nullptr) {
      if (const std::string other = other_grounds(name, read.state, grounds); !other.empty())
        lose(read, name, "was written under another configuration: " + other);
    } else if (name != kLaterSection &&
               std::ranges::find(read.lost, name, &LostSection::name) == read.lost.end()) {
      read.lost.push_back({name, "is not in the file"});
    }
  }
  if (section_of(read, "watch") != nullptr && section_of(read, "baseline") == nullptr)
    lose(read, "watch", "needs the section baseline");
}

}  // namespace

std::string_view without_section(std::string_view name) {
  const Description* found = find(name);
  return found == nullptr ? std::string_view{} : found->without;
}

SavedState saved_state(const Config& config, Estimation& estimation, std::int64_t events_before) {
  return {config.sha256, events_before, grounds_of(config), estimation.save()};
}

std::vector<std::uint8_t> state_bytes(const SavedState& state) {
  Head head;
  head.config_sha256 = state.config_sha256;
  head.events_before = state.events_before;
  for (const auto& [name, digest] : state.grounds) head.grounds.push_back({name, digest});
  for (const StateSection& s : state.sections)
    head.entries.push_back({s.name, static_cast<std::int64_t>(s.bytes.size()), digest_of(s.bytes)});
  estimator::StateWriter writer;
  head.archive_identity(writer);
  head.archive_rest(writer);
  std::vector<std::uint8_t> bytes = writer.bytes();
  const std::string digest = digest_of(bytes);
  bytes.insert(bytes.end(), digest.begin(), digest.end());
  for (const StateSection& s : state.sections)
    bytes.insert(bytes.end(), s.bytes.begin(), s.bytes.end());
  return bytes;
}

std::string write_state(const std::string& path, const SavedState& state) {
  drivers::PartialFile file;
  if (!file.open(path)) return file.error();
  const std::vector<std::uint8_t> bytes = state_bytes(state);
  if (!drivers::write_fully(file.descriptor(), bytes.data(), bytes.size()))
    return std::strerror(errno);
  return file.commit() ? "" : file.error();
}

LoadedState load_state(const std::string& path, const Config& config, Estimation& estimation,
                       bool& touched) {
  touched = false;
  ReadState read = read_state(path);
  if (!read.problem.empty()) return {read.problem};
  if (read.state.config_sha256 != config.sha256)
    return {fmt::format("belongs to another configuration (sha256 {}...), {} has {}...",
                        read.state.config_sha256.substr(0, 12), config.path,
                        config.sha256.substr(0, 12))};
  leave_what_fits(read, config, estimation);
  if (!read.lost.empty())
    return {fmt::format("section {} {}", read.lost[0].name, read.lost[0].why)};
  touched = true;
  if (const std::string spoilt = estimation.load(read.state.sections); !spoilt.empty())
    return {fmt::format("section {} {}", spoilt, kUnlike)};
  estimation.went_without({});
  return {"", read.state.events_before};
}

LoadedState load_what_fits(const std::string& path, const Config& config, Estimation& estimation,
                           const std::function<Estimation&()>& anew) {
  ReadState read = read_state(path);
  if (!read.problem.empty()) return {read.problem};
  Estimation* into = &estimation;
  leave_what_fits(read, config, *into);
  for (;;) {
    const std::string spoilt = into->load(read.state.sections);
    if (spoilt.empty()) break;
    lose(read, spoilt, kUnlike);
    into = &anew();
    leave_what_fits(read, config, *into);
  }
  std::vector<std::string> lost;
  for (const LostSection& l : read.lost) lost.push_back(l.name);
  into->went_without(lost);
  return {"", read.state.events_before, read.lost};
}

}  // namespace framewatch::daemon
