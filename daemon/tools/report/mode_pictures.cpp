// SPDX-License-Identifier: MIT
#include "daemon/tools/report/mode_pictures.h"

#include <cmath>
#include <complex>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/monitor/events/change_words.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using estimator::kNaN;

constexpr int kPictureWide = 310, kPictureHigh = 330;  // px
/// Largest displacement in a picture, as a share of the building's height.
constexpr double kDrawnMotion = 0.13;
/// Oblique projection of the depth y: to the right and upward.
constexpr double kDepthRight = 0.42, kDepthUp = 0.28;

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

  /// Adds columns and beams under a shape to a line.
  void add_lines(const VectorXd& shape, SvgSeries& line) const {
    for (std::size_t x = 0; x < lines_x_.size(); ++x)
      for (std::size_t y = 0; y < lines_y_.size(); ++y) {
        for (std::size_t floor = 0; floor < levels_.size(); ++floor)
          add_point(floor, x, y, shape, line);
        end_line(line);
      }
    for (std::size_t floor = 0; floor < levels_.size(); ++floor) {
      for (std::size_t y = 0; y < lines_y_.size(); ++y) {
        for (std::size_t x = 0; x < lines_x_.size(); ++x) add_point(floor, x, y, shape, line);
        end_line(line);
      }
      for (std::size_t x = 0; x < lines_x_.size(); ++x) {
        for (std::size_t y = 0; y < lines_y_.size(); ++y) add_point(floor, x, y, shape, line);
        end_line(line);
      }
    }
  }

  /// Adds a point on a frame of a story, at one end of the frame. shape: the motion of all frames.
  void add_frame_point(int story, int frame, const VectorXd& shape, SvgSeries& points) const {
    const auto line = static_cast<std::size_t>(frame < s_.n() ? frame : frame - s_.n());
    add_point(static_cast<std::size_t>(story), frame < s_.n() ? 0 : line, frame < s_.n() ? line : 0,
              shape, points);
  }

 private:
  static void end_line(SvgSeries& line) {
    line.x.push_back(kNaN);
    line.y.push_back(kNaN);
  }
  /// Adds the crossing of two frames; floor 0 is the base.
  void add_point(std::size_t floor, std::size_t x, std::size_t y, const VectorXd& shape,
                 SvgSeries& out) const {
    const double u = motion(floor, s_.n() > 0 ? static_cast<int>(y) : -1, shape);
    const double v = motion(floor, s_.m() > 0 ? s_.n() + static_cast<int>(x) : -1, shape);
    const double depth = lines_y_[y] + v;
    out.x.push_back(lines_x_[x] + u + kDepthRight * depth);
    out.y.push_back(levels_[floor] + kDepthUp * depth);
  }
  double motion(std::size_t floor, int frame, const VectorXd& shape) const {
    if (floor == 0 || frame < 0) return 0;
    return amplitude_ * shape[s_.dof(static_cast<int>(floor), frame)];
  }

  const estimator::Structure& s_;
  std::vector<double> levels_, lines_x_, lines_y_;
  double amplitude_ = 0;
};

/// The shapes of one row of the table, by degree of freedom. An empty vector: the list lacks the
/// mode.
struct DrawnShapes {
  VectorXd identified, identified_error, design;
  VectorXd measured;  ///< NaN where no channel sits on the frame
  /// Returns the shape that the others are scaled to.
  const VectorXd& main() const { return identified.size() > 0 ? identified : design; }
};

/// Returns the measured motion at the channels that sit on a frame, scaled and turned to fit
/// `like`, or as it is if that is empty.
VectorXd measured_places(const RecordModes& m, const VectorXd& like,
                         const estimator::MeasuredMode& measured) {
  std::complex<double> factor = 1;
  if (like.size() > 0) {
    const Eigen::VectorXcd at_channels = (m.weights * like).cast<std::complex<double>>();
    factor = measured.shape.dot(at_channels) / measured.shape.squaredNorm();
  }
  VectorXd out = VectorXd::Constant(m.weights.cols(), kNaN);
  for (Index c = 0; c < m.weights.rows(); ++c) {
    Index dof = 0;
    if (m.weights.row(c).maxCoeff(&dof) == 1) out[dof] = (factor * measured.shape[c]).real();
  }
  return out;
}

DrawnShapes shapes_of(const RecordModes& m, const ModeRow& row) {
  DrawnShapes out;
  if (row.identified >= 0) {
    const estimator::NaturalMode& mode =
        m.identified.modes[static_cast<std::size_t>(row.identified)];
    out.identified = mode.shape.real();
    out.identified_error = mode.shape_error;
  }
  if (row.design >= 0) {
    out.design = m.design.modes[static_cast<std::size_t>(row.design)].shape.real();
    if (out.identified.size() > 0)
      out.design *= out.design.dot(out.identified) / out.design.squaredNorm();
  }
  if (row.measured >= 0)
    out.measured =
        measured_places(m, out.main(), m.measured[static_cast<std::size_t>(row.measured)]);
  return out;
}

/// Returns "mode 1 (x): 2.100 Hz, 2.00 %" of the identified model, the design or the record.
std::string title_of(const RecordModes& m, const ModeRow& row, int number) {
  const auto words = [&](const std::string& what, double hz, double damping_ratio) {
    return fmt::format("mode {} ({}): {:.3f} Hz, {:.2f} %", number, what, hz, 100 * damping_ratio);
  };
  if (row.identified < 0 && row.design < 0) {
    const estimator::MeasuredMode& mode = m.measured[static_cast<std::size_t>(row.measured)];
    return words("record", mode.frequency_hz, mode.damping_ratio);
  }
  const bool identified = row.identified >= 0;
  const estimator::NaturalMode& mode =
      identified ? m.identified.modes[static_cast<std::size_t>(row.identified)]
                 : m.design.modes[static_cast<std::size_t>(row.design)];
  return words(motion_words(mode) + (identified ? "" : ", design"), mode.frequency_hz,
               mode.damping_ratio);
}

SvgPlot plot_of(const RecordModes& m, const DrawnShapes& shapes, const std::string& title) {
  const WireModel wires(m.structure);
  SvgPlot plot(title, {""}, {""}, kPictureWide, kPictureHigh);
  plot.leave_out_axes();
  const VectorXd still = VectorXd::Zero(m.weights.cols());
  const auto add = [&](const char* name, int color, SvgMark mark, const VectorXd& shape) {
    if (shape.size() == 0) return;
    SvgSeries line{name, color, mark, {}, {}};
    wires.add_lines(shape, line);
    plot.add(std::move(line));
  };
  add("at rest", 6, SvgMark::thin_line, still);
  add("design", 4, SvgMark::dashed, shapes.design);
  add("identified", 0, SvgMark::line, shapes.identified);
  if (shapes.measured.size() == 0) return plot;
  SvgSeries rings{"measured", 1, SvgMark::rings, {}, {}};
  const estimator::Structure& s = m.structure;
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      const double value = shapes.measured[s.dof(story, f)];
      if (!std::isfinite(value)) continue;
      VectorXd with = shapes.main().size() > 0 ? shapes.main() : still;
      with[s.dof(story, f)] = value;
      wires.add_frame_point(story, f, with, rings);
    }
  plot.add(std::move(rings));
  return plot;
}

std::string csv_of(const estimator::Structure& s, const DrawnShapes& shapes) {
  std::string out = "floor,frame,label,identified,identified_std_error,measured,design\n";
  const FrameLabels labels = frame_labels(s);
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      const std::string name = s.frame_name(f);
      const auto label = labels.find(name);
      out += fmt::format("{},{},{}", story, name,
                         label == labels.end() ? "" : csv_text(label->second));
      for (const VectorXd* shape :
           {&shapes.identified, &shapes.identified_error, &shapes.measured, &shapes.design})
        out += "," + (shape->size() == 0 ? "" : csv_number((*shape)[s.dof(story, f)]));
      out += "\n";
    }
  return out;
}

}  // namespace

std::vector<Picture> mode_pictures(const RecordModes& m, const std::string& suffix) {
  std::vector<Picture> out;
  for (const ModeRow& row : m.rows) {
    const int number = static_cast<int>(out.size()) + 1;
    const DrawnShapes shapes = shapes_of(m, row);
    out.push_back({fmt::format("mode-{}{}", number, suffix),
                   plot_of(m, shapes, title_of(m, row, number)), csv_of(m.structure, shapes)});
  }
  return out;
}

}  // namespace framewatch::daemon
