#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace framewatch::daemon {

/// text ... table: what TOML calls them. choice: one of a few texts. grid: a number, which stands
/// for all, or nested lists of numbers.
enum class OptionType { text, choice, integer, number, boolean, texts, grid, table };

/// Value of a key, in the member that its type says.
struct KeyValue {
  double number = 0;      ///< of a number and of an integer
  int integer = 0;        ///< of an integer; of a choice its place in the list of choices
  bool boolean = false;   ///< of a boolean
  std::string text = {};  ///< of a text
  std::vector<std::string> texts = {};  ///< of a list of texts
  std::vector<double> list = {};        ///< of a grid with one dimension
};

/// Identity of a settings struct.
template <class Settings>
inline constexpr char kOwner = 0;

/// The field of a settings struct that holds the value of a key; `into` makes one. Default: none.
struct Target {
  const void* owner = nullptr;                               ///< &kOwner of the struct; null: none
  bool (*takes)(OptionType) = nullptr;                       ///< whether the field has this type
  void (*store)(const KeyValue&, void* settings) = nullptr;  ///< settings: of the struct `owner`
  std::string* (*text)(void* settings) = nullptr;            ///< the field; null: it is no text
  void (*copy)(const void* from, void* to) = nullptr;        ///< the field alone
  bool (*same)(const void* a, const void* b) = nullptr;      ///< whether the fields are equal
  double (*converted)(double) = nullptr;  ///< unit of the key to unit of the field

  explicit operator bool() const { return owner != nullptr; }

  /// The same field in another unit than the key's.
  constexpr Target in(double (*unit)(double)) const {
    Target out = *this;
    out.converted = unit;
    return out;
  }
};

namespace target_detail {

template <class Struct, class Field>
Struct struct_of(Field Struct::*);

/// object.*first.*second and so on.
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
          .takes = takes<Field>,
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

/// Units of fields, for Target::in.
inline double radians(double degrees) {
  return degrees * 3.14159265358979323846 / 180;
}
inline double microseconds(double seconds) {
  return 1e6 * seconds;
}

}  // namespace framewatch::daemon
