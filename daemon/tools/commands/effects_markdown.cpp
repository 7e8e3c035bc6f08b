#include "daemon/tools/commands/effects_markdown.h"

#include <fmt/core.h>

#include "estimator/structure/effect.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kIntroduction = R"(# Effects

Made by `framewatch check --print-effects-markdown` from the catalogue of effects; do not edit.

What a linear shear building and perfect accelerometers leave out, by the names that scenarios,
configurations and diagnoses use. One `[[effect]]` table each:

```toml
[[effect]]
kind = "cubic_stiffness"
story = 1
frame = "y1"
k3_npm3 = 1e7
```

d is the deformation of a frame story or floor panel in m, the b'y of [the equations](equations.md):
of a frame its story drift, positive when the upper floor is further toward +x or +y; of a panel its
shear angle times sqrt(Lx Ly). v is its rate. A force f is a restoring force in N, added to k d + c v
of the element. In a panel, numbers per metre of d are so of this d.

| place | keys |
| --- | --- |
| frame story | `story`, `frame` |
| floor panel | `story`, `panel`: the y-parallel and the x-parallel frame where its spans start, `"x1y1"` |
| node | `story`, `frame`: one degree of freedom |
| two floors | `story`, `to_story` (0 is the base), `frame` |
| crossing | `story`, `node`: `"x1y1"`, both directions |
| floor | `story` |
| building | `direction` |
| whole frame | `frame`: all its stories |
| mode | `mode`: 1 is that of the lowest natural frequency |
| channel | `channel` |
| two channels | `channel`, `with_channel` |

`framewatch simulate` advances the linear part of the building exactly, by the matrix exponential, and
the laws by the fourth-order Runge-Kutta scheme in the coordinates that move with it (Lawson, SIAM J.
Numer. Anal. 4, 1967), in parts of at most 0.5 ms. Halving them changes no response of
`tests/simulate` by more than 3e-5 of its peak (laws with corners) or 1e-7 (smooth ones). A drop, or a
force that sets in, does so with the first part that begins at its time or after it. Effects of
channels act on what the sensor senses, before its noise; clipping acts after the noise.
)";

const char* place_name(estimator::PlaceKind kind) {
  switch (kind) {
    case estimator::PlaceKind::frame:
      return "frame story";
    case estimator::PlaceKind::panel:
      return "floor panel";
    case estimator::PlaceKind::node:
      return "node";
    case estimator::PlaceKind::node_pair:
      return "two floors";
    case estimator::PlaceKind::crossing:
      return "crossing";
    case estimator::PlaceKind::floor:
      return "floor";
    case estimator::PlaceKind::building:
      return "building";
    case estimator::PlaceKind::whole_frame:
      return "whole frame";
    case estimator::PlaceKind::mode:
      return "mode";
    case estimator::PlaceKind::channel:
      return "channel";
    case estimator::PlaceKind::channel_pair:
      return "two channels";
  }
  return "";
}

std::string default_text(const estimator::EffectParameter& p) {
  return p.default_value ? fmt::format("`{}`", *p.default_value) : "required";
}

}  // namespace

std::string effects_markdown() {
  std::string out = kIntroduction;
  for (const estimator::EffectDescription& d : estimator::effect_catalogue()) {
    std::string places;
    for (const estimator::PlaceKind place : d.places)
      places += fmt::format("{}{}", places.empty() ? "" : " or ", place_name(place));
    out += fmt::format("\n## `{}`\n\nAt: {}.\n\n```\n{}\n```\n\n", d.name, places, d.equation);
    if (!d.sign.empty()) out += fmt::format("{} ", d.sign);
    out += fmt::format("Source: {}.\n", d.source);
    if (d.parameters.empty()) continue;
    out += "\n| key | unit | default | meaning |\n| --- | --- | --- | --- |\n";
    for (const estimator::EffectParameter& p : d.parameters)
      out += fmt::format("| `{}` | {} | {} | {} |\n", p.key, p.unit, default_text(p), p.meaning);
  }
  return out;
}

}  // namespace framewatch::daemon
