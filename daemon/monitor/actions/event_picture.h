// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <framewatch/event_t.hpp>

#include "daemon/base/svg_converter.h"
#include "daemon/base/svg_plot.h"
#include "daemon/config/config.h"
#include "daemon/monitor/actions/email.h"
#include "daemon/monitor/history/summary_query.h"

namespace framewatch::daemon {

/// Folders with what can be shown of an event; empty: not configured.
struct EventSources {
  std::string history, event_reports;
};
EventSources event_sources(const Config& config);

/// Draws the medians and quartiles of the parameter of an event, in percent of its usual value,
/// over the 30 days before the event. Lines break where periods are missing. Returns nullopt
/// without values.
std::optional<SvgPlot> parameter_plot(SummaryQuery& summaries, const event_t& event);

/// Returns a plot as PNG; as SVG without a converter or if it fails.
EmailAttachment as_picture(const SvgPlot& plot, const std::string& name,
                           const std::optional<SvgConverter>& converter);

/// Returns what shows an event, for an e-mail: the page of the event report for strong motion, or a
/// plot of the last 30 days for a parameter of the history. The plot is PNG; SVG on a machine
/// without librsvg. Returns nullopt if nothing is stored about the event. Waits up to 5 s for a
/// report that is being written.
std::optional<EmailAttachment> event_picture(const EventSources& sources, const event_t& event,
                                             const Abandoned& abandoned);

}  // namespace framewatch::daemon
