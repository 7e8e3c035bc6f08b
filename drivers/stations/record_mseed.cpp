#include <libmseed.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/packed_file.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/record_merge.h"
#include "drivers/stations/count_meanings.h"
#include "drivers/stations/seed_trace.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

constexpr double kMinRate_hz = 1e-4, kSameRate = 1e-3;

struct FreeSeedRecord {
  void operator()(MSRecord* record) const { msr_free(&record); }
};
using SeedRecord = std::unique_ptr<MSRecord, FreeSeedRecord>;

void say_nothing(char* /*text*/) {}

/// A code of a channel's name, without the blanks that fill it.
std::string seed_code(const char* code) {
  std::string out;
  for (const char c : std::string_view(code))
    if (c != ' ') out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return out;
}

std::string seed_name(const MSRecord& record) {
  return fmt::format("{}.{}.{}.{}", seed_code(record.network), seed_code(record.station),
                     seed_code(record.location), seed_code(record.channel));
}

/// The samples of a record as numbers; false where they are none.
bool seed_values(const MSRecord& record, std::vector<double>& values) {
  const auto copy = [&](const auto* from) {
    values.assign(from, from + record.numsamples);
    return true;
  };
  switch (record.sampletype) {
    case 'i':
      return copy(static_cast<const std::int32_t*>(record.datasamples));
    case 'f':
      return copy(static_cast<const float*>(record.datasamples));
    case 'd':
      return copy(static_cast<const double*>(record.datasamples));
    default:
      return false;
  }
}

/// Reads a file record after record, in bounded memory.
class SeedRecords {
 public:
  explicit SeedRecords(FileProblems& problems) : problems_(problems), file_(problems.path()) {
    ms_loginit(&say_nothing, nullptr, &say_nothing, nullptr);
    if (!file_.is_open()) problems_.add(0, file_.error());
  }

  /// Null at the end, and when there is a problem.
  SeedRecord next() {
    if (!file_.is_open() || !fill() || at_ == buffer_.size()) return nullptr;
    char* const begin = buffer_.data() + at_;
    const int bytes = static_cast<int>(buffer_.size() - at_);
    MSRecord* parsed = nullptr;
    const int code = msr_parse(begin, bytes, &parsed, 0, 1, 0);
    SeedRecord record(parsed);
    if (code != MS_NOERROR) {
      problems_.add(0, fmt::format("byte {}: {}", offset(), why_not(code)));
      return nullptr;
    }
    at_ += static_cast<std::size_t>(record->reclen);
    return record;
  }

  /// Of what next() reads next.
  std::int64_t offset() const {
    return read_ - std::ssize(buffer_) + static_cast<std::int64_t>(at_);
  }

 private:
  /// Room for the longest record, and for the header behind it.
  static constexpr std::int64_t kAhead = std::int64_t{MAXRECLEN} + 64;

  bool fill() {
    const std::int64_t left = std::ssize(buffer_) - static_cast<std::int64_t>(at_);
    if (ended_ || left >= kAhead) return true;
    buffer_.erase(0, at_);
    at_ = 0;
    buffer_.resize(static_cast<std::size_t>(left + kAhead));
    const std::int64_t got = file_.read(buffer_.data() + left, kAhead);
    buffer_.resize(static_cast<std::size_t>(left + std::max<std::int64_t>(got, 0)));
    read_ += std::max<std::int64_t>(got, 0);
    ended_ = got < kAhead;
    if (got < 0) problems_.add(0, file_.error());
    return got >= 0;
  }

  std::string why_not(int code) const {
    if (code > 0 && ended_) return "the last record is cut off";
    switch (code) {
      case MS_NOTSEED:
        return "no miniSEED record is here";
      case MS_UNKNOWNFORMAT:
        return "samples in an encoding that is not read";
      default:
        return fmt::format("a damaged record ({})", code > 0 ? "its length" : ms_errorstr(code));
    }
  }

  FileProblems& problems_;
  GzipInput file_;
  std::string buffer_;
  std::size_t at_ = 0;
  std::int64_t read_ = 0;
  bool ended_ = false;
};

struct SeedContents {
  std::map<std::string, SeedTrace> traces;  ///< by name
  std::vector<std::string> notes;
};

std::optional<SeedContents> read_traces(const RecordOptions& options, FileProblems& problems) {
  SeedContents out;
  SeedRecords records(problems);
  std::map<std::string, std::size_t> without_samples, left_out;
  std::size_t count = 0;
  while (const SeedRecord record = records.next()) {
    const std::string name = seed_name(*record);
    const auto& wanted = options.columns;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) {
      ++left_out[name];
      continue;
    }
    SeedPiece piece{record->starttime, {}};
    if (record->numsamples == 0 || record->samprate == 0 || !seed_values(*record, piece.values)) {
      ++without_samples[name];
      continue;
    }
    if (!(record->samprate > kMinRate_hz && record->samprate <= RecordBuilder::kMaxRateHz))
      problems.add(0, fmt::format("{}: {:g} Hz is no rate, in the record before byte {}", name,
                                  record->samprate, records.offset()));
    count += piece.values.size();
    if (count > RecordBuilder::kMaxValues)
      problems.add(0, fmt::format("a record holds at most {} values", RecordBuilder::kMaxValues));
    if (std::any_of(piece.values.begin(), piece.values.end(),
                    [](double v) { return std::isinf(v); }))
      problems.add(0, fmt::format("{}: a sample is infinite, in the record before byte {}", name,
                                  records.offset()));
    SeedTrace& trace =
        out.traces.try_emplace(name, SeedTrace{name, record->samprate, {}}).first->second;
    if (std::abs(record->samprate / trace.rate_hz - 1) > kSameRate)
      problems.add(0, fmt::format("{} changes its rate from {:g} to {:g} Hz, before byte {}", name,
                                  trace.rate_hz, record->samprate, records.offset()));
    if (problems.any()) break;
    trace.pieces.push_back(std::move(piece));
  }
  for (const auto& [name, number] : left_out)
    out.notes.push_back(fmt::format("{}: not one of --columns, left out", name));
  for (const auto& [name, number] : without_samples)
    out.notes.push_back(fmt::format("{}: {} records without samples, left out", name, number));
  for (const std::string& name : options.columns)
    if (!out.traces.contains(name))
      problems.add(0, fmt::format("--columns {}: there is no such channel", show_text(name)));
  if (!problems.any() && out.traces.empty()) problems.add(0, "there are no samples");
  if (problems.any()) return std::nullopt;
  return out;
}

/// Channels of different rates, or so far apart in time that a table of them would be empty for the
/// most part.
void check_together(const SeedContents& contents, FileProblems& problems) {
  const SeedTrace& first = contents.traces.begin()->second;
  std::int64_t begin_us = INT64_MAX, end_us = INT64_MIN;
  for (const auto& [name, trace] : contents.traces) {
    if (std::abs(trace.rate_hz / first.rate_hz - 1) > kSameRate)
      problems.add(0, fmt::format("{} has {:g} Hz, {} has {:g} Hz: take those of one rate with "
                                  "--columns",
                                  first.name, first.rate_hz, name, trace.rate_hz));
    for (const SeedPiece& piece : trace.pieces) {
      begin_us = std::min(begin_us, piece.start_us);
      end_us = std::max(end_us, piece.start_us);
    }
  }
  const double instants = 1e-6 * static_cast<double>(end_us - begin_us) * first.rate_hz;
  if (instants * static_cast<double>(contents.traces.size()) >
      static_cast<double>(RecordBuilder::kMaxValues))
    problems.add(
        0, fmt::format("the channels span {:.6g} s, which with what is missing is more "
                       "than {} values: take fewer with --columns, or cut the file",
                       1e-6 * static_cast<double>(end_us - begin_us), RecordBuilder::kMaxValues));
}

std::int64_t first_us(const SeedTrace& trace) {
  std::int64_t out = INT64_MAX;
  for (const SeedPiece& piece : trace.pieces) out = std::min(out, piece.start_us);
  return out;
}

}  // namespace

std::optional<Record> read_mseed(const RecordOptions& options, FileProblems& problems) {
  auto contents = read_traces(options, problems);
  if (!contents) return std::nullopt;
  check_together(*contents, problems);
  const auto meanings = CountMeanings::read(options, problems);
  if (problems.any()) return std::nullopt;
  std::vector<Record> records;
  std::vector<std::string> where;
  for (auto& [name, trace] : contents->traces) {
    const auto meaning =
        meanings->of(name, 1e-6 * static_cast<double>(first_us(trace)), trace.rate_hz, problems);
    if (!meaning) continue;  // every channel's problem is told
    auto record = record_of_trace(std::move(trace), meaning->unit_mps2, problems);
    if (!record) return std::nullopt;
    if (!meaning->note.empty()) record->headers = {meaning->header};
    if (!meaning->note.empty()) record->notes.push_back(meaning->note);
    where.push_back(name);
    records.push_back(std::move(*record));
  }
  if (problems.any()) return std::nullopt;
  std::vector<std::size_t> samples;
  for (const Record& record : records) samples.push_back(record.time_s.size());
  std::vector<Problem> apart;
  auto merged = merge_records(std::move(records), where, MergeSpan::all, apart);
  for (const Problem& p : apart) problems.add(0, fmt::format("{}: {}", p.where, p.message));
  if (!merged) return std::nullopt;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i] < merged->time_s.size())
      merged->notes.push_back(
          fmt::format("{}: {} of {} instants are before its first sample or after its last",
                      where[i], merged->time_s.size() - samples[i], merged->time_s.size()));
  merged->notes.insert(merged->notes.begin(), contents->notes.begin(), contents->notes.end());
  return merged;
}

}  // namespace framewatch::drivers
