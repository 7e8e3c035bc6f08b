// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace framewatch::daemon {

/// Type of a key's value. text to table are the names that TOML uses. choice is one of a few texts.
/// grid is a number, which stands for all places, or nested lists of numbers.
enum class OptionType { text, choice, integer, number, boolean, texts, grid, table };

/// Value of a key. Which member holds it depends on the key's type.
struct KeyValue {
  double number = 0;      ///< value of a number or an integer
  int integer = 0;        ///< value of an integer; for a choice, its index in the list of choices
  bool boolean = false;   ///< value of a boolean
  std::string text = {};  ///< value of a text
  std::vector<std::string> texts = {};  ///< value of a list of texts
  std::vector<double> list = {};        ///< values of a grid with one dimension
};

/// Identifies a settings struct by the address of this variable.
template <class Settings>
inline constexpr char kOwner = 0;

/// Field of a settings struct that holds the value of a key. `into` makes one; a
/// default-constructed target stands for no field.
struct Target {
  const void* owner = nullptr;                ///< &kOwner of the struct; null without a field
  OptionType type = OptionType::number;       ///< type of a key that the field holds, if not given
  bool (*takes)(OptionType) = nullptr;        ///< true if the field can hold a value of this type
  KeyValue (*initial)(OptionType) = nullptr;  ///< value of the field in a new settings struct
  void (*store)(const KeyValue&,
                void* settings) = nullptr;               ///< sets the field of an `owner` struct
  std::string* (*text)(void* settings) = nullptr;        ///< the field, or null for other types
  void (*copy)(const void* from, void* to) = nullptr;    ///< copies only this field
  bool (*same)(const void* a, const void* b) = nullptr;  ///< true if the fields are equal
  double (*converted)(double) = nullptr;  ///< from the key's unit to the field's; linear

  explicit operator bool() const { return owner != nullptr; }

  /// Returns this target for a field whose unit differs from the key's. `unit` converts from the
  /// key's unit to the field's and must be linear, because defaults are converted back.
  constexpr Target in(double (*unit)(double)) const {
    Target out = *this;
    out.converted = unit;
    return out;
  }
};

namespace target_detail {

template <class Struct, class Field>
Struct struct_of(Field Struct::*);

/// Returns object.*first.*second and so on.
template <auto first, auto... rest>
auto& field_of(auto& object) {
  if constexpr (sizeof...(rest) == 0)
    return object.*first;
  else
    return field_of<rest...>(object.*first);
}

template <class Field>
constexpr bool takes(OptionType type) {
  switch (type) {
    case OptionType::boolean:
      return std::same_as<Field, bool>;
    case OptionType::number:
      return std::floating_point<Field>;
    case OptionType::integer:
      return std::is_arithmetic_v<Field> && !std::same_as<Field, bool>;
    case OptionType::choice:
      return std::is_enum_v<Field> || std::same_as<Field, int>;
    case OptionType::text:
      return std::same_as<Field, std::string>;
    case OptionType::texts:
      return std::same_as<Field, std::vector<std::string>>;
    case OptionType::grid:
      return std::same_as<Field, std::vector<double>> ||
             std::same_as<Field, std::vector<std::int64_t>>;
    case OptionType::table:
      return false;
  }
  return false;
}

/// Returns the first type that the field can hold, in the order below.
template <class Field>
constexpr OptionType natural_type() {
  using enum OptionType;
  for (const OptionType type : {number, boolean, integer, text, texts, grid})
    if (takes<Field>(type)) return type;
  return choice;
}

template <class Field>
void assign(const KeyValue& value, Field& field) {
  if constexpr (takes<Field>(OptionType::boolean))
    field = value.boolean;
  else if constexpr (takes<Field>(OptionType::number))
    field = value.number;
  else if constexpr (takes<Field>(OptionType::integer) || takes<Field>(OptionType::choice))
    field = static_cast<Field>(value.integer);
  else if constexpr (takes<Field>(OptionType::text))
    field = value.text;
  else if constexpr (takes<Field>(OptionType::texts))
    field = value.texts;
  else
    field.assign(value.list.begin(), value.list.end());
}

template <class Field>
KeyValue value_of(const Field& field, OptionType type) {
  KeyValue out;
  if constexpr (takes<Field>(OptionType::boolean))
    out.boolean = field;
  else if constexpr (takes<Field>(OptionType::integer) || takes<Field>(OptionType::choice)) {
    if (type != OptionType::number) out.integer = static_cast<int>(field);
    out.number = static_cast<double>(field);
  } else if constexpr (takes<Field>(OptionType::text))
    out.text = field;
  else if constexpr (takes<Field>(OptionType::texts))
    out.texts = field;
  else
    out.list.assign(field.begin(), field.end());
  return out;
}

template <class Settings, class Field, auto... path>
constexpr auto text_access() -> std::string* (*)(void*) {
  if constexpr (std::same_as<Field, std::string>)
    return [](void* settings) { return &field_of<path...>(*static_cast<Settings*>(settings)); };
  else
    return nullptr;
}

template <auto first, auto... rest>
constexpr Target make() {
  using Settings = decltype(struct_of(first));
  using Field =
      std::remove_reference_t<decltype(field_of<first, rest...>(*static_cast<Settings*>(nullptr)))>;
  return {.owner = &kOwner<Settings>,
          .type = natural_type<Field>(),
          .takes = takes<Field>,
          .initial =
              [](OptionType type) {
                const Settings settings{};
                return value_of<Field>(field_of<first, rest...>(settings), type);
              },
          .store =
              [](const KeyValue& value, void* settings) {
                assign(value, field_of<first, rest...>(*static_cast<Settings*>(settings)));
              },
          .text = text_access<Settings, Field, first, rest...>(),
          .copy =
              [](const void* from, void* to) {
                field_of<first, rest...>(*static_cast<Settings*>(to)) =
                    field_of<first, rest...>(*static_cast<const Settings*>(from));
              },
          .same =
              [](const void* a, const void* b) {
                return field_of<first, rest...>(*static_cast<const Settings*>(a)) ==
                       field_of<first, rest...>(*static_cast<const Settings*>(b));
              }};
}

}  // namespace target_detail

/// into<&Settings::field>, or into<&Settings::part, &Part::field> for a field of a part.
template <auto first, auto... rest>
inline constexpr Target into = target_detail::make<first, rest...>();

/// Conversions for Target::in: degrees to radians and seconds to microseconds.
inline double radians(double degrees) {
  return degrees * 3.14159265358979323846 / 180;
}
inline double microseconds(double seconds) {
  return 1e6 * seconds;
}

}  // namespace framewatch::daemon
