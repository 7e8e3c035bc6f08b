#include "drivers/formats/mat_variables.h"

#include <matio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include <fmt/core.h>

#include "drivers/files/input_file.h"
#include "drivers/formats/hdf5_guard.h"
#include "drivers/formats/mat_layout.h"
#include "drivers/formats/mat_signature.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kMaxVariables = 10'000;
constexpr int kDeepestStruct = 8;

struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};

const char* class_name(const matvar_t& v) {
  constexpr std::array kNames = {"empty",  "cell",   "struct", "object", "char",     "sparse",
                                 "double", "single", "int8",   "uint8",  "int16",    "uint16",
                                 "int32",  "uint32", "int64",  "uint64", "function", "object"};
  if (v.isLogical != 0) return "logical";
  const auto index = static_cast<std::size_t>(v.class_type);
  return index < kNames.size() ? kNames[index] : "unknown";
}

bool has_numbers(const matvar_t& v) {
  return v.class_type >= MAT_C_DOUBLE && v.class_type <= MAT_C_UINT64 && v.isLogical == 0;
}

std::string shape_of(const matvar_t& v) {
  std::string out;
  for (int i = 0; i < v.rank; ++i) out += fmt::format("{}{}", i > 0 ? " x " : "", v.dims[i]);
  return fmt::format("{} {}{}", out, v.isComplex != 0 ? "complex " : "", class_name(v));
}

/// Elements; the largest number where they cannot be counted.
std::size_t elements_of(const matvar_t& v) {
  std::size_t count = 1;
  for (int i = 0; i < v.rank; ++i)
    if (__builtin_mul_overflow(count, v.dims[i], &count))
      return std::numeric_limits<std::size_t>::max();
  return count;
}

/// Of a variable with all that is in it.
std::size_t all_elements_of(const matvar_t& v) {
  if ((v.class_type != MAT_C_STRUCT && v.class_type != MAT_C_CELL) || v.data == nullptr)
    return elements_of(v);
  const auto* const inside = static_cast<matvar_t* const*>(v.data);
  std::size_t sum = 0;
  for (std::size_t i = 0; i < v.nbytes / sizeof(matvar_t*); ++i)
    if (inside[i] != nullptr && __builtin_add_overflow(sum, all_elements_of(*inside[i]), &sum))
      return std::numeric_limits<std::size_t>::max();
  return sum;
}

}  // namespace

struct MatFileReader::State {
  InputFile input;
  std::unique_ptr<mat_t, CloseMat> file;
  std::vector<std::unique_ptr<matvar_t, FreeVariable>> tops;
  std::vector<bool> read;
  std::size_t values = 0;  ///< that were read
  std::size_t told = 0;    ///< variables, as the file says

  /// False where structs are too deep or too many.
  bool list(matvar_t* v, const std::string& name, int depth, std::vector<MatVariable>& out) const {
    if (v == nullptr) return true;
    if (depth > kDeepestStruct || out.size() >= kMaxVariables) return false;
    // Of a damaged struct libmatio has names and no fields.
    const bool has_fields = v->class_type == MAT_C_STRUCT && v->data != nullptr;
    if (has_fields && elements_of(*v) == 1) {
      char* const* const fields = Mat_VarGetStructFieldnames(v);
      const std::size_t count =
          std::min<std::size_t>(Mat_VarGetNumberOfFields(v), v->nbytes / sizeof(matvar_t*));
      for (std::size_t i = 0; fields != nullptr && i < count; ++i)
        if (!list(Mat_VarGetStructFieldByIndex(v, i, 0), fmt::format("{}.{}", name, fields[i]),
                  depth + 1, out))
          return false;
      return true;
    }
    MatVariable& added = out.emplace_back();
    added.name = name;
    added.shape = shape_of(*v);
    added.top = tops.size() - 1;
    added.holder = v;
    const std::size_t count = elements_of(*v);
    if (v->rank == 2) added.rows = v->dims[0], added.columns = v->dims[1];
    added.is_numbers = has_numbers(*v) && v->isComplex == 0 && v->rank == 2 && count > 0;
    added.may_be_meant =
        !added.is_numbers && count > 1 && (has_numbers(*v) || v->class_type == MAT_C_SPARSE);
    return true;
  }
};

MatFileReader::MatFileReader(FileProblems& problems) : state_(std::make_unique<State>()) {
  if (!state_->input.open(problems.path())) {
    problems.add(0, "cannot be opened: " + state_->input.error());
    return;
  }
  std::string head(kMatHeaderBytes, '\0');
  if (state_->input.read(head.data(), std::ssize(head), 0) != std::ssize(head) ||
      mat_level(head) == MatLevel::none) {
    problems.add(0, head.starts_with("\x1f\x8b")
                        ? "a MATLAB file is compressed in itself: unpack it first (gunzip)"
                        : "is no MATLAB file of level 5 or 7.3 (save it with -v7)");
    return;
  }
  const bool is_hdf5 = mat_level(head) == MatLevel::level_7_3;
  const auto count = is_hdf5 ? 0 : count_in_level_5(state_->input, head[126] == 'M');
  if (!count) {
    problems.add(0, "is damaged or cut off, or unpacks to too much");
    return;
  }
  const auto name = fmt::format("/proc/self/fd/{}", state_->input.descriptor());
  if (is_hdf5 && !hdf5_is_of_one_file(name)) {
    problems.add(0, "is damaged, or wants other files opened, which is not done");
    return;
  }
  state_->file.reset(Mat_Open(name.c_str(), MAT_ACC_RDONLY));
  if (!state_->file) {
    problems.add(0, "cannot be read as a MATLAB file: its header is damaged");
    return;
  }
  state_->told = *count;
  if (is_hdf5) (void)Mat_GetDir(state_->file.get(), &state_->told);
}

MatFileReader::~MatFileReader() = default;

std::optional<std::vector<MatVariable>> MatFileReader::variables(FileProblems& problems) {
  std::vector<MatVariable> out;
  if (!state_->file) return std::nullopt;
  while (matvar_t* const v = Mat_VarReadNextInfo(state_->file.get())) {
    state_->tops.emplace_back(v);
    if (state_->list(v, v->name != nullptr ? v->name : "?", 1, out)) continue;
    problems.add(0, fmt::format("more than {} variables, or structs in one another deeper than {}",
                                kMaxVariables, kDeepestStruct));
    return std::nullopt;
  }
  if (state_->tops.size() < state_->told) {
    problems.add(0, fmt::format("is damaged: {} of its {} variables can be read",
                                state_->tops.size(), state_->told));
    return std::nullopt;
  }
  state_->read.resize(state_->tops.size());
  return out;
}

bool MatFileReader::load(const MatVariable& variable, FileProblems& problems) {
  matvar_t* const top = state_->tops[variable.top].get();
  const auto most = static_cast<std::size_t>(std::min<std::int64_t>(
      static_cast<std::int64_t>(RecordBuilder::kMaxValues), unpack_limit(state_->input.size())));
  const bool first = !state_->read[variable.top];
  if (first && (__builtin_add_overflow(state_->values, all_elements_of(*top), &state_->values) ||
                state_->values > most)) {
    problems.add(0,
                 fmt::format("{}: {}: more than {} values, which is the most that a file of this "
                             "size may hold",
                             show_text(variable.name), variable.shape, most));
    return false;
  }
  state_->read[variable.top] = true;
  const matvar_t& v = *variable.holder;
  const bool good = (!first || Mat_VarReadDataAll(state_->file.get(), top) == 0) &&
                    v.data != nullptr && v.data_size > 0 && has_numbers(v) &&
                    v.nbytes / static_cast<std::size_t>(v.data_size) >= elements_of(v);
  if (!good)
    problems.add(0, fmt::format("{}: its values are damaged or cut off", show_text(variable.name)));
  return good;
}

double MatFileReader::number(const MatVariable& variable, std::size_t index) {
  const matvar_t& v = *variable.holder;
  const auto at = [&]<typename Number>(Number /*kind*/) {
    return static_cast<double>(static_cast<const Number*>(v.data)[index]);
  };
  switch (v.class_type) {
    case MAT_C_DOUBLE:
      return at(double{});
    case MAT_C_SINGLE:
      return at(float{});
    case MAT_C_INT8:
      return at(std::int8_t{});
    case MAT_C_UINT8:
      return at(std::uint8_t{});
    case MAT_C_INT16:
      return at(std::int16_t{});
    case MAT_C_UINT16:
      return at(std::uint16_t{});
    case MAT_C_INT32:
      return at(std::int32_t{});
    case MAT_C_UINT32:
      return at(std::uint32_t{});
    case MAT_C_INT64:
      return at(std::int64_t{});
    default:
      return at(std::uint64_t{});
  }
}

}  // namespace framewatch::drivers
