// SPDX-License-Identifier: MIT
#include "daemon/tools/report/modes_output.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/mat_file.h"
#include "daemon/base/printable.h"
#include "daemon/base/words.h"
#include "drivers/files/text_output.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

using estimator::kNaN;

const estimator::NaturalMode* mode_at(const estimator::NaturalModes& of, int index) {
  return index < 0 ? nullptr : &of.modes[static_cast<std::size_t>(index)];
}

const estimator::MeasuredMode* measured_at(const RecordModes& m, int index) {
  return index < 0 ? nullptr : &m.measured[static_cast<std::size_t>(index)];
}

/// A column of numbers, one per row of the table.
struct Column {
  const char* name;
  std::vector<double> values;
};

std::vector<Column> columns(const RecordModes& m) {
  std::vector<Column> out;
  const auto add = [&](const char* name, const auto& value) {
    out.push_back({name, {}});
    for (const ModeRow& row : m.rows) out.back().values.push_back(value(row));
  };
  const auto identified = [&](auto member) {
    return [&m, member](const ModeRow& row) {
      const estimator::NaturalMode* mode = mode_at(m.identified, row.identified);
      return mode ? mode->*member : kNaN;
    };
  };
  const auto measured = [&](auto member) {
    return [&m, member](const ModeRow& row) {
      const estimator::MeasuredMode* mode = measured_at(m, row.measured);
      return mode ? static_cast<double>(mode->*member) : kNaN;
    };
  };
  const auto design = [&](auto member) {
    return [&m, member](const ModeRow& row) {
      const estimator::NaturalMode* mode = mode_at(m.design, row.design);
      return mode ? mode->*member : kNaN;
    };
  };
  using estimator::MeasuredMode;
  using estimator::NaturalMode;
  add("identified_hz", identified(&NaturalMode::frequency_hz));
  add("identified_std_error_hz", identified(&NaturalMode::frequency_error_hz));
  add("identified_damping_ratio", identified(&NaturalMode::damping_ratio));
  add("identified_damping_std_error", identified(&NaturalMode::damping_error));
  add("measured_hz", measured(&MeasuredMode::frequency_hz));
  add("measured_spread_hz", measured(&MeasuredMode::frequency_spread_hz));
  add("measured_damping_ratio", measured(&MeasuredMode::damping_ratio));
  add("measured_damping_spread", measured(&MeasuredMode::damping_spread));
  add("measured_orders", measured(&MeasuredMode::orders));
  add("design_hz", design(&NaturalMode::frequency_hz));
  add("design_damping_ratio", design(&NaturalMode::damping_ratio));
  add("mac_identified_measured", [](const ModeRow& row) { return row.mac_measured; });
  add("mac_identified_design", [](const ModeRow& row) { return row.mac_design; });
  add("mac_design_measured", [](const ModeRow& row) { return row.mac_design_measured; });
  return out;
}

/// Shapes at the channels, by row of the table; NaN where a list does not have the mode.
struct Shapes {
  const char* name;
  Eigen::MatrixXcd at_channels;  ///< rows x channels
};

std::vector<Shapes> shapes(const RecordModes& m) {
  const auto rows = static_cast<Eigen::Index>(m.rows.size());
  const auto channels = static_cast<Eigen::Index>(m.channels.size());
  const Eigen::MatrixXcd none = Eigen::MatrixXcd::Constant(rows, channels, {kNaN, kNaN});
  std::vector<Shapes> out{
      {"identified_shape", none}, {"measured_shape", none}, {"design_shape", none}};
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ModeRow& row = m.rows[static_cast<std::size_t>(i)];
    if (const auto* mode = mode_at(m.identified, row.identified))
      out[0].at_channels.row(i) = (m.weights * mode->shape).transpose();
    if (const auto* mode = measured_at(m, row.measured))
      out[1].at_channels.row(i) = mode->shape.transpose();
    if (const auto* mode = mode_at(m.design, row.design))
      out[2].at_channels.row(i) = (m.weights * mode->shape).transpose();
  }
  return out;
}

Json shape_json(const Eigen::VectorXcd& shape) {
  Json out = Json::array();
  for (const std::complex<double>& value : shape)
    out.push_back({json_value(value.real()), json_value(value.imag())});
  return out;
}

Json natural_json(const estimator::NaturalMode& mode) {
  Json out{{"frequency_hz", json_value(mode.frequency_hz)},
           {"frequency_std_error_hz", json_value(mode.frequency_error_hz)},
           {"damping_ratio", json_value(mode.damping_ratio)},
           {"damping_std_error", json_value(mode.damping_error)},
           {"motion_x", json_value(mode.motion[0])},
           {"motion_y", json_value(mode.motion[1])},
           {"motion_rotation", json_value(mode.motion[2])},
           {"equal_frequencies", mode.last_equal - mode.first_equal + 1},
           {"shape", shape_json(mode.shape)},
           {"shape_std_error", Json::array()}};
  for (const double error : mode.shape_error) out["shape_std_error"].push_back(json_value(error));
  return out;
}

std::string percent(double ratio, const char* format) {
  return or_dash(100 * ratio, format);
}

}  // namespace

std::string modes_text(const RecordModes& m) {
  std::string out = fmt::format(
      "{:>4} {:>10} {:>8} {:>6} {:>6} | {:>10} {:>6} | {:>10} {:>6} | {:>6} {:>6} {:>6} | {}\n",
      "mode", "identified", "+-", "damp.", "+-", "measured", "damp.", "design", "damp.", "MAC im",
      "id", "dm", "motion");
  out += fmt::format(
      "{:>4} {:>10} {:>8} {:>6} {:>6} | {:>10} {:>6} | {:>10} {:>6} | {:>6} {:>6} {:>6} |\n", "",
      "Hz", "Hz", "%", "%", "Hz", "%", "Hz", "%", "", "", "");
  int number = 0;
  for (const ModeRow& row : m.rows) {
    const auto* identified = mode_at(m.identified, row.identified);
    const auto* measured = measured_at(m, row.measured);
    const auto* design = mode_at(m.design, row.design);
    const auto of = [](const auto* mode, auto member) { return mode ? mode->*member : kNaN; };
    using estimator::MeasuredMode;
    using estimator::NaturalMode;
    out += fmt::format(
        "{:>4} {:>10} {:>8} {:>6} {:>6} | {:>10} {:>6} | {:>10} {:>6} | {:>6} {:>6} {:>6} | {}",
        ++number, or_dash(of(identified, &NaturalMode::frequency_hz), "{:.4f}"),
        or_dash(of(identified, &NaturalMode::frequency_error_hz), "{:.2g}"),
        percent(of(identified, &NaturalMode::damping_ratio), "{:.3f}"),
        percent(of(identified, &NaturalMode::damping_error), "{:.2g}"),
        or_dash(of(measured, &MeasuredMode::frequency_hz), "{:.4f}"),
        percent(of(measured, &MeasuredMode::damping_ratio), "{:.2f}"),
        or_dash(of(design, &NaturalMode::frequency_hz), "{:.4f}"),
        percent(of(design, &NaturalMode::damping_ratio), "{:.2f}"),
        or_dash(row.mac_measured, "{:.4f}"), or_dash(row.mac_design, "{:.4f}"),
        or_dash(row.mac_design_measured, "{:.4f}"),
        identified ? motion_words(*identified)
        : design   ? motion_words(*design)
                   : "-");
    out += row.note.empty() ? "\n" : "; " + row.note + "\n";
  }
  for (const auto& [list, reason] : {std::pair{"identified", m.no_identified},
                                     {"measured", m.no_measured},
                                     {"design", m.no_design}})
    if (!reason.empty()) out += fmt::format("{}: - because {}\n", list, reason);
  if (m.identified.overdamped > 0)
    out += fmt::format("{} overdamped motions of the identified model have no frequency\n",
                       m.identified.overdamped);
  for (const std::string& name : m.silent)
    out += fmt::format("channel {} has no samples and was left out\n", printable(name));
  if (m.refinement.has_values())
    out += fmt::format(
        "identified from {:.2f} s, up to {:.3g} Hz; misfit {:.3g} times what sensor noise "
        "explains\n",
        1e-6 * static_cast<double>(m.to_us - m.from_us), m.refinement.band.high_hz,
        m.refinement.misfit_ratio);
  out += fmt::format(
      "+-: one standard error. MAC over {} channels (1: equal shapes): im identified and "
      "measured, id identified and design, dm design and measured. measured: from the record "
      "alone\n",
      m.channels.size());
  return out;
}

Json modes_json(const RecordModes& m) {
  Json out{{"from_us", m.from_us},
           {"to_us", m.to_us},
           {"channels", m.channels},
           {"channels_without_samples", m.silent},
           {"degrees_of_freedom", Json::array()},
           {"measured_up_to_hz", json_value(estimator::kMeasuredBand * m.rate_hz)},
           {"refinement", status_word(m.refinement.status)}};
  for (int d = 0; d < m.structure.degrees_of_freedom(); ++d)
    out["degrees_of_freedom"].push_back(freedom_name(m.structure, d));
  if (m.refinement.has_values()) {
    out["fitted_up_to_hz"] = json_value(m.refinement.band.high_hz);
    out["misfit_ratio"] = json_value(m.refinement.misfit_ratio);
  }
  out["overdamped"] = m.identified.overdamped;
  for (const auto& [list, reason] : {std::pair{"no_identified", m.no_identified},
                                     {"no_measured", m.no_measured},
                                     {"no_design", m.no_design}})
    if (!reason.empty()) out[list] = reason;
  out["modes"] = Json::array();
  for (const ModeRow& row : m.rows) {
    Json one;
    if (const auto* mode = mode_at(m.identified, row.identified))
      one["identified"] = natural_json(*mode);
    if (const auto* mode = measured_at(m, row.measured))
      one["measured"] = {{"frequency_hz", json_value(mode->frequency_hz)},
                         {"frequency_spread_hz", json_value(mode->frequency_spread_hz)},
                         {"damping_ratio", json_value(mode->damping_ratio)},
                         {"damping_spread", json_value(mode->damping_spread)},
                         {"orders", mode->orders},
                         {"shape_at_channels", shape_json(mode->shape)}};
    if (const auto* mode = mode_at(m.design, row.design)) one["design"] = natural_json(*mode);
    one["mac_identified_measured"] = json_value(row.mac_measured);
    one["mac_identified_design"] = json_value(row.mac_design);
    one["mac_design_measured"] = json_value(row.mac_design_measured);
    one["note"] = row.note;
    out["modes"].push_back(std::move(one));
  }
  return out;
}

std::string write_modes_csv(const RecordModes& m, const std::string& path) {
  const std::vector<Column> numbers = columns(m);
  const std::vector<Shapes> all = shapes(m);
  std::string out = "mode";
  const auto quoted = [](std::string text) {
    for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2))
      text.insert(at, 1, '"');
    return "\"" + text + "\"";
  };
  for (const Column& column : numbers) out += fmt::format(",{}", column.name);
  out += ",note";
  for (const Shapes& one : all)
    for (const std::string& channel : m.channels)
      for (const char* part : {"re", "im"})
        out += "," + quoted(fmt::format("{}_{} {}", one.name, part, channel));
  out += "\n";
  const auto number = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
  };
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    out += fmt::format("{}", i + 1);
    for (const Column& column : numbers) out += "," + number(column.values[i]);
    out += "," + quoted(m.rows[i].note);
    for (const Shapes& one : all)
      for (const std::complex<double>& value : one.at_channels.row(static_cast<Eigen::Index>(i)))
        out += "," + number(value.real()) + "," + number(value.imag());
    out += "\n";
  }
  return drivers::write_text_file(path, out);
}

std::string write_modes_mat(const RecordModes& m, const std::string& path) {
  return write_mat_file(path, [&](MatFile& file) {
    bool good = file.texts("channels", m.channels);
    std::vector<std::string> notes;
    for (const ModeRow& row : m.rows) notes.push_back(row.note);
    good = good && file.texts("notes", notes);
    for (const Column& column : columns(m))
      good = good && file.matrix(column.name, column.values, 1);
    for (const Shapes& one : shapes(m)) {
      std::vector<double> real, imaginary;
      for (Eigen::Index i = 0; i < one.at_channels.rows(); ++i)
        for (const std::complex<double>& value : one.at_channels.row(i)) {
          real.push_back(value.real());
          imaginary.push_back(value.imag());
        }
      const std::string name = one.name;
      good = good && file.matrix((name + "_re").c_str(), real, m.channels.size()) &&
             file.matrix((name + "_im").c_str(), imaginary, m.channels.size());
    }
    return good;
  });
}

}  // namespace framewatch::daemon
