// SPDX-License-Identifier: MIT
#include "daemon/tools/report/record_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/words.h"
#include "daemon/tools/replay/refined_segment.h"
#include "estimator/identify/elements/story_design.h"
#include "estimator/numeric/nan.h"
#include "estimator/refine/combine.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;

constexpr double kShortestModes_s = 5;
constexpr double kFirstRefined_s = 10, kLongestModes_s = 120;
/// Pieces of a long stretch that are refined. Five of 120 s halve the errors of one.
constexpr std::size_t kMostPieces = 5;
/// Operations that a stretch may cost: bins times the cube of the channels.
constexpr double kRefinedOperations = 2e8;
constexpr double kMotionShare = 0.2;  ///< least share of kinetic energy that the words name
/// Relative standard error of a frequency above which a mode is hardly identified.
constexpr double kHardlyKnown = 0.05;

struct Rows {
  Index from = 0, to = 0;
  Index size() const { return to - from; }
};

/// Returns the longest stretch of rows without NaN.
Rows longest_whole(const Eigen::MatrixXd& accel) {
  Rows best, now;
  for (Index i = 0; i < accel.rows(); ++i) {
    if (!accel.row(i).allFinite()) {
      now = {i + 1, i + 1};
      continue;
    }
    now.to = i + 1;
    if (now.size() > best.size()) best = now;
  }
  return best;
}

/// Returns the piece of `size` rows with the most energy.
Rows strongest_rows(const Eigen::MatrixXd& accel, Rows within, Index size) {
  if (within.size() <= size) return within;
  const auto part = accel.middleRows(within.from, within.size());
  const Eigen::VectorXd power = (part.rowwise() - part.colwise().mean()).rowwise().squaredNorm();
  double sum = power.head(size).sum(), most = sum;
  Index at = 0;
  for (Index i = size; i < power.size(); ++i) {
    sum += power[i] - power[i - size];
    if (sum > most) {
      most = sum;
      at = i - size + 1;
    }
  }
  return {within.from + at, within.from + at + size};
}

/// Returns equal pieces of at most `size` rows, in order of time: the kMostPieces with the most
/// energy.
std::vector<Rows> strongest_pieces(const Eigen::MatrixXd& accel, Rows within, Index size) {
  const Index count = (within.size() + size - 1) / size;
  std::vector<std::pair<double, Rows>> pieces;
  for (Index i = 0; i < count; ++i) {
    const Rows rows{within.from + i * within.size() / count,
                    within.from + (i + 1) * within.size() / count};
    const auto part = accel.middleRows(rows.from, rows.size());
    pieces.emplace_back((part.rowwise() - part.colwise().mean()).squaredNorm(), rows);
  }
  std::ranges::stable_sort(pieces, std::greater<>(), &std::pair<double, Rows>::first);
  if (pieces.size() > kMostPieces) pieces.resize(kMostPieces);
  std::vector<Rows> out;
  for (const auto& [energy, rows] : pieces) out.push_back(rows);
  std::ranges::sort(out, {}, &Rows::from);
  return out;
}

std::vector<estimator::ComparedMode> compared_measured(
    const std::vector<estimator::MeasuredMode>& modes) {
  std::vector<estimator::ComparedMode> out;
  for (const estimator::MeasuredMode& mode : modes) {
    const auto own = static_cast<int>(out.size());
    out.push_back({mode.frequency_hz, mode.shape, own, own});
  }
  return out;
}

void add_note(std::string& note, const std::string& more) {
  note += (note.empty() ? "" : "; ") + more;
}

/// Returns the note of a mode of the identified model, or of the design without one.
std::string note_of(const RecordModes& m, const ModeRow& row) {
  std::string note;
  const bool has_identified = row.identified >= 0;
  const auto& modes = has_identified ? m.identified.modes : m.design.modes;
  const int at = has_identified ? row.identified : row.design;
  const estimator::NaturalMode& mode = modes[static_cast<std::size_t>(at)];
  if (mode.first_equal != mode.last_equal) {
    std::vector<std::string> others;
    for (int i = mode.first_equal; i <= mode.last_equal; ++i)
      if (i != at)
        others.push_back(fmt::format("{:.4g} Hz", modes[static_cast<std::size_t>(i)].frequency_hz));
    add_note(note, "frequency equal to " + listed(others) +
                       " within the errors: only the subspace of their shapes is known");
  }
  if (mode.frequency_error_hz > kHardlyKnown * mode.frequency_hz)
    add_note(note, "the motion hardly shows it");
  const double top_hz = estimator::kMeasuredBand * m.rate_hz;
  if (has_identified && mode.frequency_hz > m.refinement.band.high_hz)
    add_note(note, fmt::format("beyond the {:.3g} Hz up to which the model is fitted",
                               m.refinement.band.high_hz));
  if (row.measured < 0 && m.no_measured.empty())
    add_note(note, mode.frequency_hz > top_hz
                       ? fmt::format("beyond the sensors' band ({:.3g} Hz)", top_hz)
                       : "not measured: too weak in the record, or unlike at the channels");
  if (has_identified && row.design < 0 && m.no_design.empty())
    add_note(note, "no mode of the design is alike");
  return note;
}

void match(RecordModes& m) {
  const auto identified = compared_modes(m.identified, m.weights),
             design = compared_modes(m.design, m.weights);
  const auto measured = compared_measured(m.measured);
  const bool has_identified = !identified.empty();
  const auto& first = has_identified ? identified : design;
  const std::vector<int> to_measured = paired_modes(first, measured);
  const std::vector<int> to_design =
      has_identified ? paired_modes(identified, design) : std::vector<int>();
  std::vector<bool> told(measured.size(), false);
  for (int i = 0; i < static_cast<int>(first.size()); ++i) {
    const auto at = static_cast<std::size_t>(i);
    ModeRow row;
    row.identified = has_identified ? i : -1;
    row.design = has_identified ? to_design[at] : i;
    row.measured = to_measured[at];
    const auto of = [](const auto& as, int a, const auto& bs, int b) {
      return a < 0 || b < 0 ? estimator::kNaN : estimator::mac(as, a, bs, b);
    };
    row.mac_measured = of(identified, row.identified, measured, row.measured);
    row.mac_design = of(identified, row.identified, design, row.design);
    row.mac_design_measured = of(design, row.design, measured, row.measured);
    row.note = note_of(m, row);
    if (row.measured >= 0) told[static_cast<std::size_t>(row.measured)] = true;
    m.rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (told[i]) continue;
    ModeRow row;
    row.measured = static_cast<int>(i);
    row.mac_measured = row.mac_design = row.mac_design_measured = estimator::kNaN;
    if (!first.empty())
      row.note = has_identified ? "in the record only: the model has no such mode"
                                : "in the record only: the design has no such mode";
    m.rows.push_back(std::move(row));
  }
  const auto hz = [&](const ModeRow& row) {
    if (row.identified >= 0)
      return m.identified.modes[static_cast<std::size_t>(row.identified)].frequency_hz;
    if (row.design >= 0) return m.design.modes[static_cast<std::size_t>(row.design)].frequency_hz;
    return m.measured[static_cast<std::size_t>(row.measured)].frequency_hz;
  };
  std::stable_sort(m.rows.begin(), m.rows.end(),
                   [&](const ModeRow& a, const ModeRow& b) { return hz(a) < hz(b); });
}

/// Refines the model from the pieces of the stretch and computes its modes.
void identify(const RefinedSegment& segment, const std::vector<Rows>& pieces,
              const estimator::ParameterTable& configured, const std::vector<double>& start,
              RecordModes& m) {
  const estimator::PipelineConfig& c = segment.config;
  const estimator::ParameterTable table = c.parameters();
  const Eigen::VectorXd design = identified_design(c);
  Eigen::VectorXd from = design;
  for (int p = 0; p < table.size(); ++p) {
    const std::optional<int> same = configured.find(table[p].name);
    if (same && static_cast<std::size_t>(*same) < start.size() &&
        start[static_cast<std::size_t>(*same)] > 0)
      from[p] = start[static_cast<std::size_t>(*same)];
  }
  estimator::RefineOptions options;
  // Without drawings the design is a guess, which must not pull the parameters.
  options.prior = c.options.prior && c.design.size() > 0;
  const auto refined = [&](Rows rows) {
    const Eigen::MatrixXd accel = segment.accel.middleRows(rows.from, rows.size());
    estimator::Refinement out =
        refine_max_likelihood(c, accel, options.prior ? design : from, from, options);
    if (out.status == estimator::RefineStatus::converged)
      from = (out.theta.array() > 0).select(out.theta, from);
    return out;
  };
  // The likelihood of a long stretch has many maxima: a short one leads to the right one.
  const auto first = static_cast<Index>(std::llround(kFirstRefined_s * c.options.rate_hz));
  if (pieces.front().size() > first) refined(strongest_rows(segment.accel, pieces.front(), first));
  std::vector<estimator::Refinement> found;
  for (const Rows& piece : pieces) {
    found.push_back(refined(piece));
    options.prior = false;  // its information counts once
  }
  m.refinement = combine(found);
  if (m.refinement.status == estimator::RefineStatus::converged)
    m.identified = natural_modes(c.structure, table, estimator::story_design(c), m.refinement.theta,
                                 m.refinement.covariance);
  if (m.identified.modes.empty())
    m.no_identified =
        m.refinement.status == estimator::RefineStatus::converged
            ? fmt::format("the building has more than {} degrees of freedom, or is overdamped",
                          estimator::kMostModalFreedoms)
            : fmt::format("the stretch gives no model: {}", status_word(m.refinement.status));
}

}  // namespace

std::vector<estimator::ComparedMode> compared_modes(const estimator::NaturalModes& modes,
                                                    const Eigen::MatrixXd& weights) {
  std::vector<estimator::ComparedMode> out;
  for (const estimator::NaturalMode& mode : modes.modes)
    out.push_back({mode.frequency_hz, weights * mode.shape, mode.first_equal, mode.last_equal});
  return out;
}

std::string motion_words(const estimator::NaturalMode& mode) {
  static constexpr std::array kWords{"x", "y", "rotation"};
  std::string out;
  for (std::size_t i = 0; i < kWords.size(); ++i)
    if (mode.motion[i] >= kMotionShare) out += (out.empty() ? "" : " + ") + std::string(kWords[i]);
  return out;
}

std::string freedom_name(const estimator::Structure& s, int dof) {
  return fmt::format("floor {}, frame {}", dof / s.frames() + 1, s.frame_name(dof % s.frames()));
}

RecordModes record_modes(const Config& config, const SessionMotion& motion,
                         const std::vector<double>& start, Index from, Index to) {
  const estimator::PipelineConfig& pipeline = config.pipeline;
  RecordModes m;
  m.rate_hz = motion.rate_hz;
  m.structure = pipeline.structure;
  RefinedSegment segment =
      without_silent_channels(pipeline, motion.axes, motion.accel.middleRows(from, to - from));
  const auto& axes = segment.config.axes;
  m.silent = segment.silent;
  m.weights = channel_weights(m.structure, axes);
  for (const std::size_t a : estimator::compared_axes(axes)) m.channels.push_back(axes[a].name);
  if (pipeline.design.size() == 0)
    m.no_design = "the configuration has no [design]";
  else
    m.design = natural_modes(m.structure, pipeline.parameters(), estimator::story_design(pipeline),
                             identified_design(pipeline));
  if (m.design.modes.empty() && m.no_design.empty())
    m.no_design = fmt::format("the building has more than {} degrees of freedom",
                              estimator::kMostModalFreedoms);

  const Rows whole = longest_whole(segment.accel);
  const auto samples = [&](double seconds) {
    return static_cast<Index>(std::llround(seconds * motion.rate_hz));
  };
  m.from_us = motion.time_us(from + whole.from);
  m.to_us = motion.time_us(from + std::max(whole.from, whole.to - 1));
  if (whole.size() < samples(kShortestModes_s)) {
    m.no_identified = m.no_measured =
        fmt::format("no {:g} s of the stretch are without missing samples", kShortestModes_s);
  } else {
    const Rows used = strongest_rows(segment.accel, whole, samples(kLongestModes_s));
    m.measured = measured_modes(estimator::recorded_motion(m.structure, axes, motion.rate_hz,
                                                           segment.accel, used.from, used.to));
    if (m.measured.empty()) m.no_measured = "no mode is stable over the orders of the fit";
    const double channels = static_cast<double>(axes.size());
    const auto most = static_cast<Index>(kRefinedOperations / (channels * channels * channels));
    const Index longest = std::clamp(most, samples(kShortestModes_s), samples(kLongestModes_s));
    const std::vector<Rows> pieces = strongest_pieces(segment.accel, whole, longest);
    m.from_us = motion.time_us(from + pieces.front().from);
    m.to_us = motion.time_us(from + pieces.back().to - 1);
    identify(segment, pieces, pipeline.parameters(), start, m);
  }
  match(m);
  return m;
}

}  // namespace framewatch::daemon
