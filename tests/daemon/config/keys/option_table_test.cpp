// SPDX-License-Identifier: MIT
#include "daemon/config/keys/option_table.h"

#include <cstdlib>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/config/keys/section_table.h"
#include "daemon/config/keys/suggest.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace option_table_test {

TEST(ConfigOptions, EveryRowIsComplete) {
  std::set<std::pair<std::string_view, std::string_view>> keys;
  for (const Option& o : options()) {
    SCOPED_TRACE(std::string(o.section) + "." + std::string(o.key));
    EXPECT_TRUE(keys.emplace(o.section, o.key).second) << "twice in the table";
    EXPECT_TRUE(o.meaning.ends_with(".")) << "meaning is a sentence";
    EXPECT_FALSE(o.required && !o.default_value.empty());
    EXPECT_LT(o.range.min, o.range.max);
    EXPECT_EQ(o.type == OptionType::choice, !o.choices.empty());
  }
}

TEST(ConfigOptions, DefaultsAreWithinTheirRanges) {
  for (const Option& o : options()) {
    if (o.default_value.empty()) continue;
    SCOPED_TRACE(std::string(o.section) + "." + std::string(o.key));
    if (o.type == OptionType::number || o.type == OptionType::integer) {
      for (const std::string& text : {o.default_value, o.paper_default}) {
        if (text.empty()) continue;
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        EXPECT_EQ(*end, '\0');
        EXPECT_TRUE(value >= o.range.min && value <= o.range.max &&
                    (value > o.range.min || !o.range.above_min));
      }
    }
    if (o.type == OptionType::choice) {
      bool known = false;
      for (const std::string& choice : choices(o))
        known = known || "\"" + choice + "\"" == o.default_value;
      EXPECT_TRUE(known);
    }
  }
}

TEST(ConfigOptions, UnitsAreInTheKeys) {
  const std::pair<std::string_view, std::string_view> kSuffixes[] = {
      {"s", "_s"},        {"Hz", "_hz"},
      {"m", "_m"},        {"kg", "_kg"},
      {"N/m", "_npm"},    {"m/s^2", "_mps2"},
      {"bytes", "bytes"}, {"m/s^2/sqrt(Hz)", "_mps2_per_rthz"}};
  for (const Option& o : options())
    for (const auto& [unit, suffix] : kSuffixes)
      EXPECT_TRUE(o.unit != unit || o.key.ends_with(suffix)) << o.key;
}

TEST(ConfigOptions, CommittedDocumentationIsFresh) {
  const std::string path = std::string(FRAMEWATCH_SOURCE_DIR) + "/docs/configuration.md";
  EXPECT_EQ(test::read_file(path), options_markdown())
      << "run: framewatch check --print-options-markdown > docs/configuration.md";
}

TEST(ConfigOptions, DocumentationHasEveryRow) {
  const std::string page = options_markdown();
  for (const Option& o : options())
    EXPECT_NE(page.find(std::string(o.meaning).substr(0, 20)), std::string::npos)
        << o.section << "." << o.key;
}

TEST(ConfigSuggest, GivesAdviceForKnownMistakes) {
  const auto advice = [](const char* section, const char* key) {
    return advice_on_unknown_key(section, key);
  };
  EXPECT_EQ(advice("structure", "node_mass_t"), "the unit is kg: write node_mass_kg");
  EXPECT_EQ(advice("structure", "node_mass"), "the unit is kg: write node_mass_kg");
  EXPECT_EQ(advice("estimator", "window_ms"), "the unit is s: write window_s");
  EXPECT_EQ(advice("estimator", "rate_khz"), "the unit is Hz: write rate_hz");
  EXPECT_EQ(advice("channel", "offset_g"), "the unit is m/s^2: write offset_mps2");
  EXPECT_EQ(advice("estimator", "self_tun"), "did you mean self_tune?");
  EXPECT_EQ(advice("structure", "strories"), "did you mean stories?");
  EXPECT_EQ(advice("structure", "window_s"), "it is a key of [estimator]");
  EXPECT_TRUE(advice("lcm", "zzzzzz").starts_with("the keys are url, prefix"));
}

}  // namespace option_table_test
}  // namespace framewatch::daemon
