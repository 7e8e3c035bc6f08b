// SPDX-License-Identifier: MIT
// miniSEED 2, the format of seismic networks.
#include <libmseed.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/file_problems.h"
#include "drivers/files/packed_file.h"
#include "drivers/records/record.h"
#include "drivers/records/record_builder.h"
#include "drivers/stations/station_formats.h"
#include "drivers/stations/station_xml.h"

namespace framewatch::drivers {
namespace {

/// The samples of one miniSEED record.
struct SeedPiece {
  std::int64_t start_us = 0;  ///< time of the first sample since 1970
  std::vector<double> values;
};

/// All samples of one SEED channel, in the order of the file.
struct SeedTrace {
  std::string name;
  double rate_hz = 0;
  std::vector<SeedPiece> pieces;
};

/// Times without blockette 1001 are rounded to this.
constexpr double kTimeResolution_us = 100;
constexpr double kMaxSlackSteps = 0.4;
/// Relative error allowed for the clock over an interruption.
constexpr double kDriftOverInterruption = 1e-4;
constexpr std::size_t kMaxNoted = 10;

std::string time_text_of(double time_us) {
  std::array<char, 64> text{};
  ms_hptime2isotimestr(std::llround(time_us), text.data(), 1);
  return std::string(text.data()) + "Z";
}

/// Samples without an interruption. The start times of the first and the last piece give the step.
struct SeedRun {
  double start_us = 0, last_us = 0;  ///< start times of the first and the last piece
  std::size_t last = 0;              ///< index of the first sample of the last piece
  std::vector<double> values;
};

class TraceJoiner {
 public:
  TraceJoiner(const SeedTrace& trace, FileProblems& problems)
      : name_(trace.name),
        step_us_(1e6 / trace.rate_hz),
        slack_steps_(
            std::min(std::max(RecordBuilder::kStepTolerance, kTimeResolution_us / step_us_),
                     kMaxSlackSteps)),
        problems_(problems) {}

  void add(SeedPiece piece) {
    const auto start_us = static_cast<double>(piece.start_us);
    if (runs_.empty()) return begin_run(start_us, std::move(piece));
    SeedRun& run = runs_.back();
    const double due_us =
        run.last_us + static_cast<double>(run.values.size() - run.last) * step_us_;
    const double off_steps = (start_us - due_us) / step_us_, whole = std::round(off_steps);
    if (std::abs(off_steps - whole) > slack_steps_ + kDriftOverInterruption * std::abs(whole))
      problems_.add(
          0, fmt::format("{}: the samples from {} on are {:.2f} of a step off those before", name_,
                         time_text_of(start_us), std::abs(off_steps - whole)));
    else if (whole < 0)
      add_overlapping(start_us, static_cast<std::size_t>(-whole), piece);
    else if (whole > 0)
      begin_run_after_interruption(due_us, start_us, std::move(piece));
    else
      append(run, start_us, piece, 0);
  }

  const std::vector<SeedRun>& runs() const { return runs_; }
  double step_us() const { return step_us_; }

  std::vector<std::string> notes() const {
    std::vector<std::string> out = interruptions_;
    if (interruption_count_ > interruptions_.size())
      out.push_back(
          fmt::format("{} more interruptions", interruption_count_ - interruptions_.size()));
    if (twice_ > 0)
      out.push_back(fmt::format("{} samples appear twice with equal values: used once", twice_));
    return out;
  }

 private:
  void begin_run(double start_us, SeedPiece piece) {
    runs_.push_back({start_us, start_us, 0, std::move(piece.values)});
  }

  void begin_run_after_interruption(double due_us, double start_us, SeedPiece piece) {
    if (interruption_count_++ < kMaxNoted)
      interruptions_.push_back(fmt::format("an interruption of {:.6g} s from {} on",
                                           1e-6 * (start_us - due_us), time_text_of(due_us)));
    begin_run(start_us, std::move(piece));
  }

  static void append(SeedRun& run, double start_us, const SeedPiece& piece, std::size_t from) {
    if (from == 0) {
      run.last_us = start_us;
      run.last = run.values.size();
    }
    run.values.insert(run.values.end(), piece.values.begin() + static_cast<std::ptrdiff_t>(from),
                      piece.values.end());
  }

  void add_overlapping(double start_us, std::size_t overlap, const SeedPiece& piece) {
    SeedRun& run = runs_.back();
    const std::size_t common = std::min(overlap, piece.values.size());
    const auto alike = [](double a, double b) {
      return a == b || (std::isnan(a) && std::isnan(b));
    };
    if (overlap > run.values.size() ||
        !std::equal(piece.values.begin(),
                    piece.values.begin() + static_cast<std::ptrdiff_t>(common),
                    run.values.end() - static_cast<std::ptrdiff_t>(overlap), alike)) {
      problems_.add(0, fmt::format("{}: {} samples from {} on appear twice, with different values",
                                   name_, common, time_text_of(start_us)));
      return;
    }
    twice_ += common;
    append(run, start_us, piece, common);
  }

  const std::string& name_;
  double step_us_, slack_steps_;
  FileProblems& problems_;
  std::vector<SeedRun> runs_;
  std::vector<std::string> interruptions_;
  std::size_t interruption_count_ = 0, twice_ = 0;
};

/// Makes a record of a trace: sorts its pieces by time and joins them. Fills interruptions with NaN
/// and takes samples that appear twice with equal values once; notes both. `unit_mps2` is the m/s^2
/// of one count. Returns nullopt with a problem in two cases. Samples appear twice with different
/// values. A piece is off the steps of the others by more than a tenth of a step and by more than
/// 100 us, to which SEED may round times.
std::optional<Record> record_of_trace(SeedTrace trace, double unit_mps2, FileProblems& problems) {
  std::stable_sort(trace.pieces.begin(), trace.pieces.end(),
                   [](const SeedPiece& a, const SeedPiece& b) { return a.start_us < b.start_us; });
  TraceJoiner joiner(trace, problems);
  for (SeedPiece& piece : trace.pieces)
    if (!problems.full()) joiner.add(std::move(piece));
  if (problems.any()) return std::nullopt;
  RecordBuilder builder({trace.name}, problems);
  builder.expect(trace.rate_hz, 0);
  for (const SeedRun& run : joiner.runs()) {
    const double step_us = run.last > 0
                               ? (run.last_us - run.start_us) / static_cast<double>(run.last)
                               : joiner.step_us();
    for (std::size_t i = 0; i < run.values.size(); ++i) {
      const double accel_mps2 = run.values[i] * unit_mps2;
      builder.add(0, (run.start_us + static_cast<double>(i) * step_us) / 1e6, {&accel_mps2, 1});
    }
  }
  for (const std::string& note : joiner.notes()) builder.note(note);
  return builder.finish();
}

constexpr double kMinRate_hz = 1e-4, kSameRate = 1e-3;

struct FreeSeedRecord {
  void operator()(MSRecord* record) const { msr_free(&record); }
};
using SeedRecord = std::unique_ptr<MSRecord, FreeSeedRecord>;

void say_nothing(char* /*text*/) {}

/// Returns a part of a channel's name without the blanks that pad it.
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

/// Copies the samples of a record to `values`. Returns false when they are not numbers.
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

/// Reads a file record by record in bounded memory.
class SeedRecords {
 public:
  explicit SeedRecords(FileProblems& problems) : problems_(problems), file_(problems.path()) {
    ms_loginit(&say_nothing, nullptr, &say_nothing, nullptr);
    if (!file_.is_open()) problems_.add(0, file_.error());
  }

  /// Returns the next record. Returns null at the end, and when there is a problem.
  SeedRecord next() {
    if (!file_.is_open() || !fill() || at_ == buffer_.size()) return nullptr;
    char* const begin = buffer_.data() + at_;
    const int bytes = static_cast<int>(buffer_.size() - at_);
    MSRecord* parsed = nullptr;
    const int code = msr_parse(begin, bytes, &parsed, length_at(begin, bytes), 1, 0);
    SeedRecord record(parsed);
    if (code != MS_NOERROR) {
      problems_.add(0, fmt::format("byte {}: {}", offset(), why_not(code)));
      return nullptr;
    }
    at_ += static_cast<std::size_t>(record->reclen);
    length_ = record->reclen;
    return record;
  }

  /// Returns the byte offset of the record that next() reads next.
  std::int64_t offset() const {
    return read_ - std::ssize(buffer_) + static_cast<std::int64_t>(at_);
  }

 private:
  /// Bytes of the longest record and the header behind it.
  static constexpr std::int64_t kAhead = std::int64_t{MAXRECLEN} + 64;

  /// Returns the length of the record at `begin`; 0 leaves it to the library, which reads it from
  /// blockette 1000 or finds the next header. A last record without that blockette has the length
  /// of those before; if it is the only one, it fills the file.
  int length_at(const char* begin, int bytes) const {
    const bool unknown = ended_ && bytes >= MINRECLEN && ms_detect(begin, bytes) == 0;
    if (!unknown) return 0;
    if (length_ > 0) return length_ <= bytes ? length_ : 0;
    return std::has_single_bit(static_cast<unsigned>(bytes)) ? bytes : 0;
  }

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
        return "samples in an unsupported encoding";
      default:
        return fmt::format("a damaged record ({})", code > 0 ? "its length" : ms_errorstr(code));
    }
  }

  FileProblems& problems_;
  GzipInput file_;
  std::string buffer_;
  std::size_t at_ = 0;
  std::int64_t read_ = 0;
  int length_ = 0;  ///< bytes of the last record; 0: none yet
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
      problems.add(0, fmt::format("{}: {:g} Hz is not a valid rate, in the record before byte {}",
                                  name, record->samprate, records.offset()));
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

/// Reports channels of different rates, and channels so far apart in time that most of a table of
/// them would be empty.
void check_together(const SeedContents& contents, FileProblems& problems) {
  const SeedTrace& first = contents.traces.begin()->second;
  std::int64_t begin_us = INT64_MAX, end_us = INT64_MIN;
  for (const auto& [name, trace] : contents.traces) {
    if (std::abs(trace.rate_hz / first.rate_hz - 1) > kSameRate)
      problems.add(0, fmt::format("{} has {:g} Hz, {} has {:g} Hz: select those of one rate with "
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
        0, fmt::format("the channels span {:.6g} s, more than {} values with missing samples "
                       "filled in: select fewer with --columns, or cut the file",
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
    if (!meaning) continue;  // go on, to report the problems of all channels
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
