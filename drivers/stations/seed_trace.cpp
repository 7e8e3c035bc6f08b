#include "drivers/stations/seed_trace.h"

#include <libmseed.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>

#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

/// Times without blockette 1001 are multiples of this.
constexpr double kTimeResolution_us = 100;
constexpr double kMaxSlackSteps = 0.4;
/// What the clock may be off its rate over a gap.
constexpr double kDriftOverGap = 1e-4;
constexpr std::size_t kMaxGapsNoted = 10;

std::string time_text_of(double time_us) {
  std::array<char, 64> text{};
  ms_hptime2isotimestr(std::llround(time_us), text.data(), 1);
  return std::string(text.data()) + "Z";
}

/// Samples without a gap. The pieces say when they begin: the clock's step is found from the first
/// and the last one.
struct SeedRun {
  double start_us = 0, last_us = 0;  ///< of the first and the last piece
  std::size_t last = 0;              ///< index of the last piece's first sample
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
    if (std::abs(off_steps - whole) > slack_steps_ + kDriftOverGap * std::abs(whole))
      problems_.add(
          0, fmt::format("{}: the samples from {} on lie {:.2f} of a step off those before", name_,
                         time_text_of(start_us), std::abs(off_steps - whole)));
    else if (whole < 0)
      add_overlapping(start_us, static_cast<std::size_t>(-whole), piece);
    else if (whole > 0)
      begin_run_after_gap(due_us, start_us, std::move(piece));
    else
      append(run, start_us, piece, 0);
  }

  const std::vector<SeedRun>& runs() const { return runs_; }
  double step_us() const { return step_us_; }

  std::vector<std::string> notes() const {
    std::vector<std::string> out = gaps_;
    if (gap_count_ > gaps_.size())
      out.push_back(fmt::format("{} more gaps", gap_count_ - gaps_.size()));
    if (twice_ > 0)
      out.push_back(fmt::format("{} samples are there twice, alike: taken once", twice_));
    return out;
  }

 private:
  void begin_run(double start_us, SeedPiece piece) {
    runs_.push_back({start_us, start_us, 0, std::move(piece.values)});
  }

  void begin_run_after_gap(double due_us, double start_us, SeedPiece piece) {
    if (gap_count_++ < kMaxGapsNoted)
      gaps_.push_back(fmt::format("a gap of {:.6g} s from {} on", 1e-6 * (start_us - due_us),
                                  time_text_of(due_us)));
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
      problems_.add(
          0, fmt::format("{}: {} samples from {} on are there twice, with different values", name_,
                         common, time_text_of(start_us)));
      return;
    }
    twice_ += common;
    append(run, start_us, piece, common);
  }

  const std::string& name_;
  double step_us_, slack_steps_;
  FileProblems& problems_;
  std::vector<SeedRun> runs_;
  std::vector<std::string> gaps_;
  std::size_t gap_count_ = 0, twice_ = 0;
};

}  // namespace

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

}  // namespace framewatch::drivers
