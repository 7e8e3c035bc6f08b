// SPDX-License-Identifier: MIT
#include "daemon/base/html_page.h"

#include <algorithm>
#include <string_view>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr const char* kStyle =
    ":root{--page:#fff;--ink:#1a1a1a;--soft:#5c5c5c;--rule:#d0d0d0;--stripe:#f6f6f4;"
    "color-scheme:light dark}"
    "@media screen and (prefers-color-scheme:dark){:root{--page:#161616;--ink:#e8e8e8;"
    "--soft:#a8a8a8;--rule:#444;--stripe:#1f1f1f}}"
    "@media print{:root{color-scheme:light}}"
    "body{background:var(--page);color:var(--ink);font:15px/1.5 system-ui,sans-serif;"
    "max-width:1000px;margin:2em auto;padding:0 1em}"
    "h1{font-size:1.7em;line-height:1.2}h2{font-size:1.3em;margin-top:2.2em;"
    "border-bottom:1px solid var(--rule);padding-bottom:.2em}h3{font-size:1.05em}"
    "p{max-width:46em}code,pre{font:13px/1.5 ui-monospace,monospace}"
    "pre{background:var(--stripe);padding:.6em .8em;overflow-x:auto}"
    ".wide{overflow-x:auto}"
    "table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums;margin:1em 0}"
    "th,td{padding:.25em .55em;text-align:right;border-bottom:1px solid var(--rule)}"
    "th{border-bottom:2px solid var(--rule);vertical-align:bottom}"
    "th:first-child,td:first-child{text-align:left}td{white-space:nowrap}tr:nth-child(even) "
    "td{background:var(--stripe)}"
    "figure{margin:1.2em 0;break-inside:avoid}figure>div{display:flex;flex-wrap:wrap;gap:.4em}"
    "figcaption{color:var(--soft);font-size:13px;max-width:60em}"
    "details summary{cursor:pointer;color:var(--soft)}"
    ".verdict{font-size:1.35em;line-height:1.35;font-weight:600;max-width:40em;margin:.2em 0 .6em}"
    "nav ol{columns:2;max-width:40em;font-size:13px;color:var(--soft)}nav a{color:inherit}"
    "img{max-width:100%;max-height:14cm}"
    "@page{size:A4;margin:14mm 13mm 16mm;"
    "@bottom-right{content:counter(page) \" of \" counter(pages);font:8pt sans-serif}}"
    "@media print{body{font-size:10pt;margin:0;padding:0;max-width:none}"
    "h1{margin:.4em 0}h2{margin-top:1.1em}h2,h3{break-after:avoid}"
    "figure{break-inside:auto;margin:.6em 0}figure>div{zoom:.68}.plot{break-inside:avoid}"
    "figcaption{break-before:avoid}p{orphans:3;widows:3}"
    ".wide{overflow:visible}table{font-size:7.5pt;margin:.5em 0}th,td{padding:.2em .4em}"
    ".short,tr{break-inside:avoid}thead{display:table-header-group}a{color:inherit}}";

constexpr std::size_t kShortTable = 10;  // rows of a table that stays on one page of paper
constexpr std::size_t kLongWords = 40;   // characters
constexpr std::size_t kMaxColumns = 16;  // columns that are searched for words

bool is_number(const std::string& cell) {
  return !cell.empty() && std::string("0123456789+-.").find(cell[0]) != std::string::npos;
}

/// Returns "w2 w5 l5": the columns after the first that hold only words (w) and long words (l).
std::string columns_of_words(std::size_t columns,
                             const std::vector<std::vector<std::string>>& rows) {
  std::string out;
  for (std::size_t c = 1; c < std::min(columns, kMaxColumns); ++c) {
    std::size_t longest = 0;
    bool words = !rows.empty();
    for (const auto& row : rows) {
      if (c >= row.size()) continue;
      words = words && !is_number(row[c]);
      longest = std::max(longest, row[c].size());
    }
    const std::string n = std::to_string(c + 1);
    if (words) out += " w" + n + (longest > kLongWords ? " l" + n : "");
  }
  return out;
}

/// Returns CSS for columns_of_words(): left-aligned, with line breaks in long words.
std::string style_of_words() {
  std::string left, broken;
  for (std::size_t c = 2; c <= kMaxColumns; ++c) {
    const std::string n = std::to_string(c), comma = left.empty() ? "" : ",";
    left += comma + ".w" + n + " th:nth-child(" + n + "),.w" + n + " td:nth-child(" + n + ")";
    broken += comma + ".l" + n + " td:nth-child(" + n + ")";
  }
  return left + "{text-align:left}" + broken + "{white-space:normal}";
}

}  // namespace

std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"wide\"><table class=\"" +
                    std::string(rows.size() <= kShortTable ? "short" : "long") +
                    columns_of_words(head.size(), rows) + "\"><thead><tr>";
  for (const std::string& cell : head) out += "<th>" + cell + "</th>";
  out += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (const std::string& cell : row) out += "<td>" + cell + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string html_figure(const std::vector<std::string>& plots, const std::string& caption) {
  std::string out = "<figure><div>\n";
  for (const std::string& plot : plots) out += plot;
  return out + "</div><figcaption>" + caption + "</figcaption></figure>\n";
}

std::string html_figure(const std::vector<Picture>& pictures, const std::string& caption) {
  std::vector<std::string> plots;
  for (const Picture& picture : pictures) plots.push_back(picture.plot.svg());
  return html_figure(plots, caption);
}

std::string with_contents(const std::string& body) {
  constexpr std::string_view kBegins = "<h2>", kEnds = "</h2>";
  std::string list, out;
  std::size_t from = 0;
  int chapter = 0;
  for (auto at = body.find(kBegins); at != std::string::npos; at = body.find(kBegins, from)) {
    const std::size_t end = body.find(kEnds, at);
    const std::string id = fmt::format("chapter-{}", ++chapter);
    const std::size_t title = at + kBegins.size();
    list += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, body.substr(title, end - title));
    out += body.substr(from, at - from) + fmt::format("<a id=\"{}\"></a>", id);
    out += kBegins;
    from = title;
  }
  return "<nav aria-label=\"contents\"><ol>\n" + list + "</ol></nav>\n" + out + body.substr(from);
}

std::string html_page(const std::string& title, const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>" +
         html_text(title) + "</title>\n<style>" + kStyle + style_of_words() + svg_style() +
         "</style></head>\n<body>\n" + body + "</body></html>\n";
}

}  // namespace framewatch::daemon
