// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/words.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostPictures = 6;
constexpr double kPictureWide = 235, kPictureHigh = 270, kPictureEdge = 12,
                 kPictureTitle = 36;  // px
/// Largest displacement in a picture, as a share of the building's height.
constexpr double kDrawnMotion = 0.13;
/// Oblique projection of the depth y: to the right and upward.
constexpr double kDepthRight = 0.42, kDepthUp = 0.28;

struct Point {
  double x, y;  ///< y upward
};

/// The crossings of a building's frames, drawn as a wire model. A building with frames along one
/// direction only gets a second line, so that it has a width.
class WireModel {
 public:
  explicit WireModel(const estimator::Structure& s) : s_(s) {
    double height = 0;
    levels_.push_back(0);
    for (const double story : s.story_height) levels_.push_back(height += story);
    for (int f = 0; f < s.n(); ++f) lines_y_.push_back(line_position(s, f));
    for (int f = 0; f < s.m(); ++f) lines_x_.push_back(line_position(s, s.n() + f));
    const double width = 0.4 * height;
    if (s.m() == 0) lines_x_ = {0, width};
    if (s.n() == 0) lines_y_ = {0, width};
    amplitude_ = kDrawnMotion * height;
  }

  /// Returns the place of a crossing under a shape; floor 0 is the base.
  Point at(std::size_t floor, std::size_t x, std::size_t y, const Eigen::VectorXd& shape) const {
    const double u = motion(floor, s_.n() > 0 ? static_cast<int>(y) : -1, shape);
    const double v = motion(floor, s_.m() > 0 ? s_.n() + static_cast<int>(x) : -1, shape);
    const double depth = lines_y_[y] + v;
    return {lines_x_[x] + u + kDepthRight * depth, levels_[floor] + kDepthUp * depth};
  }

  /// Returns the ends of all columns and beams.
  std::vector<std::array<Point, 2>> lines(const Eigen::VectorXd& shape) const {
    std::vector<std::array<Point, 2>> out;
    for (std::size_t floor = 0; floor < levels_.size(); ++floor)
      for (std::size_t x = 0; x < lines_x_.size(); ++x)
        for (std::size_t y = 0; y < lines_y_.size(); ++y) {
          const Point here = at(floor, x, y, shape);
          if (floor + 1 < levels_.size()) out.push_back({here, at(floor + 1, x, y, shape)});
          if (x + 1 < lines_x_.size()) out.push_back({here, at(floor, x + 1, y, shape)});
          if (y + 1 < lines_y_.size()) out.push_back({here, at(floor, x, y + 1, shape)});
        }
    return out;
  }

 private:
  double motion(std::size_t floor, int frame, const Eigen::VectorXd& shape) const {
    if (floor == 0 || frame < 0) return 0;
    return amplitude_ * shape[s_.dof(static_cast<int>(floor), frame)];
  }

  const estimator::Structure& s_;
  std::vector<double> levels_, lines_x_, lines_y_;
  double amplitude_ = 0;
};

/// Returns the shape of a mode with the measured motion at the channels that sit on a frame, scaled
/// and turned to fit; NaN elsewhere.
Eigen::VectorXd measured_places(const RecordModes& m, const estimator::NaturalMode& mode,
                                const estimator::MeasuredMode& measured) {
  const Eigen::VectorXcd at_channels = m.weights * mode.shape;
  const std::complex<double> factor =
      measured.shape.dot(at_channels) / measured.shape.squaredNorm();
  Eigen::VectorXd out = Eigen::VectorXd::Constant(mode.shape.size(), estimator::kNaN);
  for (Eigen::Index c = 0; c < m.weights.rows(); ++c) {
    Eigen::Index dof = 0;
    if (m.weights.row(c).maxCoeff(&dof) == 1) out[dof] = (factor * measured.shape[c]).real();
  }
  return out;
}

/// Draws a mode: the building at rest in gray, its shape in blue, measured channels as rings.
std::string picture(const RecordModes& m, const std::string& title, const std::string& subtitle,
                    const estimator::NaturalMode& mode, const estimator::MeasuredMode* measured) {
  const WireModel wires(m.structure);
  const Eigen::VectorXd shape = mode.shape.real();
  const auto rest = wires.lines(Eigen::VectorXd::Zero(shape.size()));
  const auto moved = wires.lines(shape), back = wires.lines(-shape);
  Point low = rest.front()[0], high = low;
  for (const auto* lines : {&rest, &moved, &back})
    for (const auto& line : *lines)
      for (const Point& p : line) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
  const double scale =
      std::min((kPictureWide - 2 * kPictureEdge) / std::max(high.x - low.x, 1e-9),
               (kPictureHigh - kPictureTitle - kPictureEdge) / std::max(high.y - low.y, 1e-9));
  const auto px = [&](const Point& p) {
    return Point{kPictureWide / 2 + scale * (p.x - (low.x + high.x) / 2),
                 kPictureHigh - kPictureEdge - scale * (p.y - low.y)};
  };
  std::string out = fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "aria-label=\"{2}\"><text class=\"ti\" x=\"{3}\" y=\"14\">{2}</text><text x=\"{3}\" "
      "y=\"29\">{4}</text>",
      kPictureWide, kPictureHigh, html_text(title), kPictureEdge, html_text(subtitle));
  for (const auto& [lines, style] : {std::pair{&rest, "t s6"}, std::pair{&moved, "l s0"}}) {
    out += fmt::format("<path class=\"{}\" d=\"", style);
    for (const auto& [from, to] : *lines) {
      const Point a = px(from), b = px(to);
      fmt::format_to(std::back_inserter(out), "M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x, a.y, b.x, b.y);
    }
    out += "\"/>";
  }
  if (measured != nullptr) {
    const Eigen::VectorXd places = measured_places(m, mode, *measured);
    const estimator::Structure& s = m.structure;
    for (int story = 1; story <= s.stories; ++story)
      for (int f = 0; f < s.frames(); ++f) {
        const double value = places[s.dof(story, f)];
        if (!std::isfinite(value)) continue;
        Eigen::VectorXd with = shape;
        with[s.dof(story, f)] = value;
        const auto line = static_cast<std::size_t>(f < s.n() ? f : f - s.n());
        const Point at = px(wires.at(static_cast<std::size_t>(story), f < s.n() ? 0 : line,
                                     f < s.n() ? line : 0, with));
        fmt::format_to(std::back_inserter(out),
                       "<circle class=\"b s1\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>", at.x, at.y);
      }
  }
  return out + "</svg>\n";
}

std::string pictures(const RecordModes& m) {
  std::vector<std::string> out;
  std::size_t number = 0;
  bool rings = false;
  for (const ModeRow& row : m.rows) {
    ++number;
    if ((row.identified < 0 && row.design < 0) || out.size() == kMostPictures) continue;
    const bool identified = row.identified >= 0;
    const estimator::NaturalMode& mode =
        identified ? m.identified.modes[static_cast<std::size_t>(row.identified)]
                   : m.design.modes[static_cast<std::size_t>(row.design)];
    const estimator::MeasuredMode* measured =
        row.measured < 0 ? nullptr : &m.measured[static_cast<std::size_t>(row.measured)];
    rings = rings || measured != nullptr;
    out.push_back(picture(m,
                          fmt::format("mode {}: {:.3f} Hz, {:.2f} %", number, mode.frequency_hz,
                                      100 * mode.damping_ratio),
                          identified ? motion_words(mode) : motion_words(mode) + " (design)", mode,
                          measured));
  }
  if (out.empty()) return "";
  return html_figure(out, std::string("Shapes of the lowest modes, blue, beside the building at "
                                      "rest, gray. Frequency and damping ratio of the ") +
                              (m.identified.modes.empty() ? "design." : "identified model.") +
                              (rings ? " Rings: the measured shape at the channels." : ""));
}

std::string modes_table(const RecordModes& m) {
  std::vector<std::vector<std::string>> rows;
  int number = 0;
  const auto percent = [](double ratio, const char* format) {
    return or_dash(100 * ratio, format);
  };
  for (const ModeRow& row : m.rows) {
    const estimator::NaturalMode none{
        estimator::kNaN, estimator::kNaN, estimator::kNaN, estimator::kNaN, {}, {}};
    const auto natural = [&](const estimator::NaturalModes& of, int at) {
      return at < 0 ? none : of.modes[static_cast<std::size_t>(at)];
    };
    const estimator::NaturalMode identified = natural(m.identified, row.identified),
                                 design = natural(m.design, row.design);
    const estimator::MeasuredMode measured =
        row.measured < 0 ? estimator::MeasuredMode{estimator::kNaN, estimator::kNaN, 0, 0, {}, 0}
                         : m.measured[static_cast<std::size_t>(row.measured)];
    const auto with_error = [](double value, double error, const char* format) {
      return or_dash(value, format) +
             (std::isfinite(error) ? fmt::format(" &plusmn; {:.1g}", error) : "");
    };
    rows.push_back(
        {fmt::format("{}", ++number),
         with_error(identified.frequency_hz, identified.frequency_error_hz, "{:.4f}"),
         with_error(100 * identified.damping_ratio, 100 * identified.damping_error, "{:.3f}"),
         or_dash(measured.frequency_hz, "{:.4f}"), percent(measured.damping_ratio, "{:.2f}"),
         or_dash(design.frequency_hz, "{:.4f}"), percent(design.damping_ratio, "{:.2f}"),
         or_dash(row.mac_measured, "{:.4f}"), or_dash(row.mac_design, "{:.4f}"),
         or_dash(row.mac_design_measured, "{:.4f}"),
         row.identified >= 0 ? motion_words(identified)
         : row.design >= 0   ? motion_words(design)
                             : "",
         html_text(row.note)});
  }
  std::string out =
      html_table({"mode", "identified, Hz", "damping, %", "measured, Hz", "damping, %",
                  "design, Hz", "damping, %", "MAC i-m", "MAC i-d", "MAC d-m", "motion", ""},
                 rows);
  for (const auto& [list, reason] : {std::pair{"Identified", m.no_identified},
                                     {"Measured", m.no_measured},
                                     {"Design", m.no_design}})
    if (!reason.empty()) out += fmt::format("<p>{}: - because {}.</p>\n", list, html_text(reason));
  return out;
}

/// Compares the identified modes before and after a change.
std::string changed_modes(const RecordModes& before, const RecordModes& after) {
  if (before.identified.modes.empty() || after.identified.modes.empty()) return "";
  const auto were = compared_modes(before.identified, before.weights),
             are = compared_modes(after.identified, after.weights);
  const std::vector<int> pairs = paired_modes(were, are);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] < 0) continue;
    const estimator::NaturalMode& was = before.identified.modes[i];
    const estimator::NaturalMode& is = after.identified.modes[static_cast<std::size_t>(pairs[i])];
    const double error = std::hypot(was.frequency_error_hz, is.frequency_error_hz);
    rows.push_back({fmt::format("{:.4f}", was.frequency_hz), fmt::format("{:.4f}", is.frequency_hz),
                    fmt::format("{:+.2f}", 100 * (is.frequency_hz / was.frequency_hz - 1)),
                    fmt::format("{:.2g}", 100 * error / was.frequency_hz),
                    fmt::format("{:.3f}", 100 * was.damping_ratio),
                    fmt::format("{:.3f}", 100 * is.damping_ratio),
                    or_dash(estimator::mac(were, static_cast<int>(i), are, pairs[i]), "{:.4f}")});
  }
  if (rows.empty()) return "";
  return "<h3>Identified modes before and after the change</h3>\n" +
         html_table({"before, Hz", "after, Hz", "change, %", "standard error of it, %",
                     "damping before, %", "damping after, %", "MAC"},
                    rows);
}

}  // namespace

std::string modes_section(const SessionReport& r) {
  if (r.modes.empty()) return "";
  std::string out =
      "<h2>Modes</h2>\n<p>Identified: of the model refined from the stage. Its standard errors "
      "(&plusmn;) come from the covariance of all stiffnesses and dampings and leave out errors of "
      "the model. Measured: from the samples alone. MAC compares shapes at the channels; 1 means "
      "equal: identified with measured (i-m) and with the design (i-d), design with measured "
      "(d-m).</p>\n";
  const RecordModes *before = nullptr, *after = nullptr;
  for (const StageModes& of : r.modes) {
    const ReportStage& stage = r.compared[of.stage];
    (stage.after ? after : before) = &of.modes;
    out += "<h3>" + html_text(stage.name) + "</h3>\n" + pictures(of.modes) + modes_table(of.modes);
  }
  if (before != nullptr && after != nullptr) out += changed_modes(*before, *after);
  return out;
}

}  // namespace framewatch::daemon
