// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/base/utc_time.h"
#include "daemon/base/words.h"
#include "daemon/tools/compare/comparison.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxInPicture = 24;  // parameters side by side
constexpr int kColors = 6;
constexpr double kUsualErrors = 2;  // of a transfer function, drawn as rules

int color_of(std::size_t run) {
  return static_cast<int>(run % kColors);
}

/// Returns the parameters of stiffness, or of damping, that some run knows.
std::vector<std::size_t> known(const Comparison& c, bool stiffness) {
  std::vector<std::size_t> out;
  for (std::size_t p = 0; p < c.runs.front().values.size(); ++p)
    if (is_stiffness_kind(c.runs.front().table().kind[p]) == stiffness &&
        std::any_of(c.runs.begin(), c.runs.end(),
                    [&](const ComparedRun& run) { return std::isfinite(run.values[p].value); }))
      out.push_back(p);
  return out;
}

/// Returns how many of `all` parameters each picture shows: about equally many, at most
/// kMaxInPicture.
std::size_t even_share(std::size_t all) {
  const std::size_t pictures = (all + kMaxInPicture - 1) / kMaxInPicture;
  return pictures == 0 ? 1 : (all + pictures - 1) / pictures;
}

/// Returns how far the marks of a later run stand from the middle of their category.
double beside(const Comparison& c, std::size_t run) {
  const auto later = static_cast<double>(c.differences.size());
  return 0.7 * ((static_cast<double>(run) + 0.5) / later - 0.5);
}

/// Plots the differences of the later runs with their standard errors.
std::vector<Picture> difference_pictures(const Comparison& c, bool stiffness) {
  const std::vector<std::size_t> all = known(c, stiffness);
  const std::string what = stiffness ? "stiffness" : "damping";
  std::vector<Picture> out;
  const std::size_t most = even_share(all.size());
  for (std::size_t from = 0; from < all.size(); from += most) {
    const std::size_t count = std::min(most, all.size() - from);
    SvgAxis names{""};
    for (std::size_t i = 0; i < count; ++i)
      names.categories.push_back(place_of(c.runs.front().report, all[from + i]));
    SvgPlot plot(what + " against " + c.runs.front().name, names, {"difference of " + what + ", %"},
                 980, 300);
    plot.add_rule(0);
    for (std::size_t r = 0; r < c.differences.size(); ++r) {
      SvgSeries bars{c.runs[r + 1].name, color_of(r), SvgMark::bars, {}, {}, {}};
      for (std::size_t i = 0; i < count; ++i) {
        const Difference& d = c.differences[r][all[from + i]];
        bars.x.push_back(static_cast<double>(i + 1) + beside(c, r));
        bars.y.push_back(100 * d.ratio);
        bars.error.push_back(100 * d.std_error);
      }
      plot.add(std::move(bars));
    }
    out.push_back({"difference-" + what + (from == 0 ? "" : fmt::format("-{}", from / most + 1)),
                   std::move(plot)});
  }
  return out;
}

/// Plots the measured transfer functions of every run, and the differences in standard errors.
std::vector<Picture> transfer_function_pictures(const Comparison& c) {
  std::vector<Picture> out;
  for (const TransferFunction& first : c.runs.front().transfer()) {
    const std::string direction = letter(first.direction);
    SvgAxis f{"frequency, Hz", 0};
    if (std::isfinite(first.model_mode_hz))
      f.high = std::min(6 * first.model_mode_hz, first.frequency_hz.back());
    SvgPlot gain("top floor over base, along " + direction, f,
                 {"acceleration ratio", std::nan(""), std::nan(""), true}, 485, 260);
    SvgPlot errors("difference from " + c.runs.front().name + ", along " + direction, f,
                   {"difference, standard errors"}, 485, 260);
    for (std::size_t r = 0; r < c.runs.size(); ++r)
      for (const TransferFunction& t : c.runs[r].transfer())
        if (t.direction == first.direction)
          gain.add(
              SvgSeries{c.runs[r].name, color_of(r), SvgMark::line, t.frequency_hz, t.measured});
    bool any = false;
    for (std::size_t r = 0; r < c.transfer.size(); ++r)
      for (const TransferDifference& d : c.transfer[r])
        if (c.runs.front().transfer()[d.first].direction == first.direction) {
          any = true;
          errors.add(SvgSeries{c.runs[r + 1].name, color_of(r + 1), SvgMark::line, d.frequency_hz,
                               d.errors});
        }
    if (!any) continue;
    errors.add_rule(kUsualErrors);
    errors.add_rule(-kUsualErrors);
    out.push_back({"transfer-" + direction, std::move(gain)});
    out.push_back({"transfer-" + direction + "-difference", std::move(errors)});
  }
  return out;
}

std::vector<Picture> drift_pictures(const Comparison& c) {
  SvgPlot plot("peak story drift", {"peak story drift, % of the height", 0}, {"floor", 0}, 485,
               300);
  bool any = false;
  for (std::size_t r = 0; r < c.runs.size(); ++r) {
    if (!c.runs[r].report.drifts) continue;
    SvgSeries line{c.runs[r].name, color_of(r), SvgMark::line, {}, {}};
    for (const estimator::StoryDrift& d : c.runs[r].report.drifts->drifts) {
      line.x.push_back(d.known() ? 100 * d.ratio : estimator::kNaN);
      line.y.push_back(d.story - 0.5);
    }
    any = true;
    plot.add(std::move(line));
  }
  if (!any) return {};
  return {{"drifts", std::move(plot)}};
}

std::string cell(const estimator::WindowMean& m, double factor) {
  if (!std::isfinite(m.value)) return "-";
  return m.std_error > 0 ? with_error(factor * m.value, factor * m.std_error)
                         : fmt::format("{:.4g}", factor * m.value);
}

std::string in_errors(double errors) {
  return std::isinf(errors) ? "exact values" : or_dash(errors, "{:.1f}");
}

/// Returns the titles of a table: `places`, the first run, and value and difference of the others.
std::vector<std::string> head_of(const Comparison& c, std::vector<std::string> places,
                                 const std::string& unit = "") {
  std::vector<std::string> out = std::move(places);
  out.push_back(html_text(c.runs.front().name) + unit);
  for (std::size_t r = 1; r < c.runs.size(); ++r)
    for (const std::string& title : {html_text(c.runs[r].name) + unit, std::string("difference, %"),
                                     std::string("standard errors")})
      out.push_back(title);
  return out;
}

void add_difference(std::vector<std::string>& row, const Difference& d) {
  const std::string size = std::isfinite(d.ratio) ? change_with_error(d.ratio, d.std_error) : "-";
  row.push_back(d.different ? "<strong>" + size + "</strong>" : size);
  row.push_back(in_errors(d.errors()));
}

std::string parameter_table(const Comparison& c, bool stiffness) {
  std::vector<std::vector<std::string>> rows;
  for (const std::size_t p : known(c, stiffness)) {
    const SessionReport& first = c.runs.front().report;
    const auto [factor, unit] = first.units.of(c.runs.front().table().kind[p]);
    std::vector<std::string> row{html_text(place_of(first, p)),
                                 html_text(c.runs.front().table().name[p]), unit,
                                 cell(c.runs.front().values[p], factor)};
    for (std::size_t r = 0; r < c.differences.size(); ++r) {
      row.push_back(cell(c.runs[r + 1].values[p], factor));
      add_difference(row, c.differences[r][p]);
    }
    rows.push_back(std::move(row));
  }
  return html_table(head_of(c, {"place", "parameter", "unit"}), rows);
}

/// Plots frequencies, or damping ratios, of the later runs against the first.
std::vector<Picture> mode_pictures(const Comparison& c) {
  const std::vector<std::size_t> known = c.known_modes();
  std::vector<Picture> out;
  for (const bool frequency : {true, false}) {
    SvgAxis numbers{"mode"};
    for (const std::size_t i : known) numbers.categories.push_back(fmt::format("{}", i + 1));
    const std::string what = frequency ? "natural frequency" : "damping ratio";
    SvgPlot plot(what + " against " + c.runs.front().name, numbers,
                 {"difference of " + what + ", %"}, 485, 260);
    plot.add_rule(0);
    bool any = false;
    for (std::size_t r = 0; r < c.modes.size(); ++r) {
      SvgSeries dots{c.runs[r + 1].name, color_of(r + 1), SvgMark::rings, {}, {}, {}};
      for (std::size_t k = 0; k < known.size(); ++k) {
        const ModeDifference& d = c.modes[r][known[k]];
        const Difference& of = frequency ? d.frequency : d.damping;
        dots.x.push_back(static_cast<double>(k + 1) + beside(c, r));
        dots.y.push_back(100 * of.ratio);
        dots.error.push_back(100 * of.std_error);
        any = any || std::isfinite(of.ratio);
      }
      plot.add(std::move(dots));
    }
    if (any)
      out.push_back(
          {frequency ? "difference-frequency" : "difference-damping-ratio", std::move(plot)});
  }
  return out;
}

std::string modes_section(const Comparison& c) {
  const std::vector<std::size_t> known = c.known_modes();
  if (known.empty()) return "";
  std::vector<std::string> head = head_of(c, {"mode", "motion", ""});
  for (std::size_t r = 1; r < c.runs.size(); ++r)
    head.push_back("MAC with " + html_text(c.runs[r].name));
  std::vector<std::vector<std::string>> rows;
  for (const std::size_t i : known) {
    const RunMode& first = c.runs.front().modes.modes[i];
    const auto begin = [&](const char* what, const std::string& value) {
      return std::vector<std::string>{fmt::format("{}", i + 1), motion_words(first.natural), what,
                                      value};
    };
    const auto frequency_of = [](const RunMode& m) {
      return cell({m.natural.frequency_hz, m.natural.frequency_error_hz, 1}, 1);
    };
    const auto damping_of = [](const RunMode& m) {
      return cell({m.natural.damping_ratio, m.natural.damping_error, 1}, 100);
    };
    std::vector<std::string> frequency = begin("frequency, Hz", frequency_of(first)),
                             damping = begin("damping ratio, %", damping_of(first)),
                             measured = begin("measured, Hz", or_dash(first.measured_hz, "{:.4f}"));
    std::vector<std::string> macs;
    for (std::size_t r = 0; r < c.modes.size(); ++r) {
      const ModeDifference& d = c.modes[r][i];
      const RunMode* later =
          d.later < 0 ? nullptr : &c.runs[r + 1].modes.modes[static_cast<std::size_t>(d.later)];
      frequency.push_back(later ? frequency_of(*later) : "-");
      add_difference(frequency, d.frequency);
      damping.push_back(later ? damping_of(*later) : "-");
      add_difference(damping, d.damping);
      const double hz = later ? later->measured_hz : estimator::kNaN;
      measured.push_back(or_dash(hz, "{:.4f}"));
      measured.push_back(or_dash(100 * (hz / first.measured_hz - 1), "{:+.2f}"));
      measured.push_back("");
      macs.push_back(or_dash(d.mac, "{:.4f}"));
    }
    frequency.insert(frequency.end(), macs.begin(), macs.end());
    for (std::vector<std::string>* row : {&damping, &measured}) row->resize(head.size());
    for (std::vector<std::string>* row : {&frequency, &damping, &measured})
      rows.push_back(std::move(*row));
  }
  return "<h2>Modes</h2>\n" +
         html_figure(mode_pictures(c), "Natural frequencies and damping ratios against " +
                                           html_text(c.runs.front().name) +
                                           ", with one standard error of the difference.") +
         html_table(head, rows) +
         fmt::format(
             "<p>Of the model refined from the samples; of a run without samples, of its mean "
             "stiffness. MAC compares shapes at all floors and frames; 1 means equal. Measured: "
             "from "
             "the samples alone. Bold: a frequency that differs by at least {:.3g} % and {:g} "
             "standard errors. Damping ratios depend on the amplitude, so they do not decide the "
             "verdict.</p>\n",
             100 * c.limits.least_frequency(), c.limits.errors);
}

std::string run_section(const Comparison& c) {
  std::vector<std::vector<std::string>> rows;
  for (const ComparedRun& run : c.runs) {
    const SessionEstimates& e = run.report.estimates;
    rows.push_back({html_text(run.name), run.what, html_text(e.table.structure),
                    e.windows() > 0 ? sensor_time_text(e.start_us.front()) : "-",
                    e.windows() > 0
                        ? fmt::format("{:.1f}", 1e-6 * static_cast<double>(e.end_us.back() -
                                                                           e.start_us.front()))
                        : "-",
                    html_text(e.table.config_sha256.substr(0, 12))});
  }
  std::string out =
      "<h2>Runs</h2>\n" +
      html_table({"run", "from", "building", "begins", "length, s", "configuration"}, rows);
  for (const std::string& note : c.notes) out += html_paragraph(note);
  return out;
}

std::string stiffness_section(const Comparison& c) {
  return "<h2>Stiffness</h2>\n" +
         html_figure(difference_pictures(c, true),
                     "Stiffness against " + html_text(c.runs.front().name) +
                         ", with one standard error of the difference.") +
         parameter_table(c, true) +
         fmt::format(
             "<p>Values are means of windows that do not overlap, with their standard "
             "errors. Bold: a difference of at least {} and {:g} standard errors.</p>\n",
             c.limits.ratio > 0 ? fmt::format("{:.3g} %", 100 * c.limits.ratio)
                                : fmt::format("{:.3g} % (floor panels {:.3g} %)",
                                              100 * c.limits.least(0), 100 * c.limits.least(1)),
             c.limits.errors);
}

std::string damping_section(const Comparison& c) {
  if (known(c, false).empty()) return "";
  return "<h2>Damping</h2>\n" +
         html_figure(difference_pictures(c, false),
                     "Damping against " + html_text(c.runs.front().name) +
                         ", with one standard error of the difference.") +
         parameter_table(c, false) +
         "<p>Damping depends on the amplitude of the motion, so it does not decide the "
         "verdict.</p>\n";
}

std::string drift_section(const Comparison& c) {
  const std::vector<Picture> pictures = drift_pictures(c);
  if (pictures.empty()) return "";
  const std::vector<std::string> head = head_of(c, {"story"}, ", mm");
  std::vector<std::vector<std::string>> rows;
  const auto with_drifts = std::find_if(c.runs.begin(), c.runs.end(), [](const ComparedRun& run) {
    return run.report.drifts.has_value();
  });
  for (const estimator::StoryDrift& of : with_drifts->report.drifts->drifts) {
    std::vector<std::string> row{fmt::format("{}", of.story),
                                 cell(drift_mm(c.runs.front(), of.story), 1)};
    for (std::size_t r = 0; r < c.drifts.size(); ++r) {
      const Difference d = c.drifts[r].empty() ? Difference{estimator::kNaN, estimator::kNaN}
                                               : c.drifts[r][rows.size()];
      row.push_back(cell(drift_mm(c.runs[r + 1], of.story), 1));
      add_difference(row, d);
    }
    rows.push_back(std::move(row));
  }
  return "<h2>Peak story drifts</h2>\n" +
         html_figure(pictures,
                     "Peak drift of each story. It follows the motion of the base, so it "
                     "does not decide the verdict.") +
         html_table(head, rows);
}

std::string transfer_functions_section(const Comparison& c) {
  const std::vector<Picture> pictures = transfer_function_pictures(c);
  if (pictures.empty()) return "";
  std::vector<std::vector<std::string>> rows;
  for (const ComparedRun& run : c.runs)
    for (const TransferFunction& t : run.transfer())
      rows.push_back({html_text(run.name), letter(t.direction),
                      or_dash(t.measured_mode_hz, "{:.3f}"), or_dash(t.mac, "{:.2f}"),
                      fmt::format("{}", t.segments)});
  return "<h2>Transfer functions</h2>\n" +
         html_figure(pictures,
                     "Left: mean of the top floor's frames over the base. Right: differences in "
                     "standard errors, which follow from coherence and segments; dotted: two of "
                     "them. Near a sharp peak the segments' length adds an error that is not "
                     "counted.") +
         html_table(
             {"run", "direction", "measured mode, Hz", "likeness to the model (MAC)", "segments"},
             rows);
}

std::string files_section(const Comparison& c) {
  std::vector<std::vector<std::string>> rows;
  for (const ComparedRun& run : c.runs)
    for (const ReportFile& file : run.report.files)
      rows.push_back({html_text(run.name), html_text(file.path), file.use,
                      "<code>" + file.sha256 + "</code>"});
  return "<h2>Provenance</h2>\n" + html_table({"run", "file", "use", "SHA-256"}, rows) +
         "<p>Compared by framewatch " FRAMEWATCH_VERSION ".</p>\n";
}

}  // namespace

std::vector<Picture> comparison_pictures(const Comparison& c) {
  std::vector<Picture> out;
  for (std::vector<Picture> more :
       {difference_pictures(c, true), difference_pictures(c, false), mode_pictures(c),
        drift_pictures(c), transfer_function_pictures(c)})
    for (Picture& picture : more) out.push_back(std::move(picture));
  return out;
}

std::string comparison_html(const Comparison& c) {
  std::string title = "Comparison of " + c.runs.front().name, body;
  for (std::size_t r = 1; r < c.runs.size(); ++r)
    title += (r + 1 == c.runs.size() ? " and " : ", ") + c.runs[r].name;
  for (const std::string& sentence : verdict_sentences(c))
    body += "<p class=\"verdict\">" + html_text(sentence) + "</p>\n";
  return html_page(
      title, body + "<h1>" + html_text(title) + "</h1>\n" + about_section(c.about) +
                 with_contents(run_section(c) + stiffness_section(c) + damping_section(c) +
                               modes_section(c) + drift_section(c) + transfer_functions_section(c) +
                               photograph_section(c.about) + files_section(c)));
}

}  // namespace framewatch::daemon
