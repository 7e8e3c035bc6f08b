#include "daemon/base/svg_style.h"

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

/// Okabe and Ito's colours, which differ in lightness too; their brighter relatives on black.
constexpr const char* kLight[] = {"#0072b2", "#d55e00", "#009e73", "#aa4499",
                                  "#b27d00", "#3d9ad1", "#7f7f7f"};
constexpr const char* kDark[] = {"#4da6e8", "#ff8c42", "#2fce9f", "#e39bd0",
                                 "#f2b93b", "#8fd3fb", "#a0a0a0"};

std::string variables(const char* const (&colors)[7], const char* grid) {
  std::string out = fmt::format("--grid:{};", grid);
  for (int i = 0; i < 7; ++i) out += fmt::format("--s{}:{};", i, colors[i]);
  return out;
}

constexpr const char* kMarks =
    ".plot{max-width:100%;height:auto;font:11px system-ui,sans-serif;color:inherit}"
    ".plot text{fill:currentColor}.plot .ti{font-weight:600;font-size:12px}"
    ".plot .ye{text-anchor:end}.plot .xe{text-anchor:middle}"
    ".plot .g{stroke:var(--grid);stroke-width:1}"
    ".plot .o{fill:none;stroke:currentColor;stroke-width:.8;opacity:.6}"
    ".plot .r{stroke:currentColor;stroke-width:1;stroke-dasharray:2 3;opacity:.7}"
    ".plot .l{fill:none;stroke-width:1.6}.plot .t{fill:none;stroke-width:.8;opacity:.75}"
    ".plot .d{stroke-dasharray:6 4}"
    ".plot .b{fill:var(--page);stroke-width:1.2}.plot .m{stroke-width:2.4}";

}  // namespace

std::string svg_style() {
  const std::string light = variables(kLight, "#e4e4e4"), dark = variables(kDark, "#3a3a3a");
  std::string out = fmt::format(
      ":root{{{}}}@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}", light, dark);
  out += kMarks;
  for (int i = 0; i < 7; ++i)
    out += fmt::format(".plot .s{0}{{stroke:var(--s{0})}}.plot .f{0}{{fill:var(--s{0})}}", i);
  return out;
}

}  // namespace framewatch::daemon
