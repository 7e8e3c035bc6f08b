// SPDX-License-Identifier: MIT
#include "drivers/formats/mat_variables.h"

#include <hdf5.h>
#include <matio.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/input_file.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

constexpr std::uint32_t kMatrix = 14, kCompressed = 15;
constexpr std::uint32_t kObjectClass = 3, kSparseClass = 5, kFunctionClass = 16, kOpaqueClass = 17;
constexpr int kDeepestArray = 16;
constexpr std::int64_t kMaxInflated = std::int64_t{1} << 29;
constexpr std::int64_t kInflateBytes = 1 << 16;

/// Reads bytes of a file, or of an element that is unpacked. Returns false beyond its end. Offsets
/// ascend from call to call, but for the eight bytes of a tag.
using ReadAt = std::function<bool(void* to, std::int64_t bytes, std::int64_t at)>;

struct MatElement {
  std::uint32_t type = 0;
  std::int64_t content = 0, bytes = 0;  ///< offset and size of the content, without the padding
  std::int64_t next = 0;                ///< offset of the next element
};

class MatLayout {
 public:
  MatLayout(ReadAt read, bool big_endian) : read_(std::move(read)), big_endian_(big_endian) {}

  std::optional<MatElement> element(std::int64_t at, std::int64_t end) const {
    const auto first = number(at), second = number(at + 4);
    if (at + 8 > end || !first || !second) return std::nullopt;
    MatElement out{*first, at + 8, *second, 0};
    if ((*first >> 16) != 0) out = {*first & 0xffff, at + 4, *first >> 16, at + 8};
    const bool small = out.next != 0;
    if (small && out.bytes > 4) return std::nullopt;
    if (!small) out.next = out.content + (out.type == kCompressed ? out.bytes : padded(out.bytes));
    if (out.next > end) return std::nullopt;
    return out;
  }

  /// Checks the flags, dimensions and parts of a matrix.
  bool is_sound(const MatElement& matrix, int depth) const {
    if (matrix.bytes == 0) return true;
    if (depth > kDeepestArray) return false;
    const std::int64_t end = matrix.content + matrix.bytes;
    const auto flags = element(matrix.content, end);
    const auto kind = flags && flags->bytes == 8 ? number(flags->content) : std::nullopt;
    if (!kind) return false;
    const std::uint32_t type = *kind & 0xff;
    const bool opaque = type == kOpaqueClass || type == kFunctionClass || type == kObjectClass;
    std::int64_t at = flags->next;
    for (int i = 0; at < end; ++i) {
      const auto part = element(at, end);
      if (!part) return false;
      if (i == 0 && !opaque && type != kSparseClass && !fits(*part, matrix.bytes)) return false;
      if (part->type == kMatrix && !is_sound(*part, depth + 1)) return false;
      at = part->next;
    }
    return true;
  }

 private:
  static std::int64_t padded(std::int64_t bytes) { return (bytes + 7) / 8 * 8; }

  std::optional<std::uint32_t> number(std::int64_t at) const {
    std::array<std::uint8_t, 4> bytes{};
    if (!read_(bytes.data(), 4, at)) return std::nullopt;
    if (!big_endian_) std::reverse(bytes.begin(), bytes.end());
    std::uint32_t out = 0;
    for (const std::uint8_t byte : bytes) out = out << 8 | byte;
    return out;
  }

  /// Returns true if an array with these dimensions has no more values than bytes.
  bool fits(const MatElement& dimensions, std::int64_t bytes) const {
    std::int64_t count = 1;
    for (std::int64_t at = 0; at < dimensions.bytes; at += 4) {
      const auto size = number(dimensions.content + at);
      if (!size || at > 4 * 32) return false;
      if (__builtin_mul_overflow(count, std::int64_t{*size}, &count)) return false;
    }
    return count <= bytes;
  }

  ReadAt read_;
  bool big_endian_;
};

/// Unpacks a compressed element piece by piece, so that a check of it needs little memory.
class Inflater {
 public:
  Inflater(InputFile& input, const MatElement& packed)
      : input_(input), packed_(packed), most_(std::min(kMaxInflated, unpack_limit(input.size()))) {
    good_ = inflateInit(&stream_) == Z_OK;
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Reads as ReadAt does. `at` must not lie before the window of the last kInflateBytes.
  bool read(void* to, std::int64_t bytes, std::int64_t at) {
    while (good_ && at + bytes > begin_ + std::ssize(window_)) fill();
    if (at < begin_ || at + bytes > begin_ + std::ssize(window_)) return false;
    std::memcpy(to, window_.data() + (at - begin_), static_cast<std::size_t>(bytes));
    return true;
  }

  /// Unpacks the rest. Returns the unpacked bytes; nullopt when they are damaged or too many.
  std::optional<std::int64_t> finish() {
    while (good_) fill();
    if (code_ != Z_STREAM_END) return std::nullopt;
    return begin_ + std::ssize(window_);
  }

 private:
  /// Moves the window on. Sets good_ to false at the end and on damage.
  void fill() {
    constexpr std::int64_t kKept = 64;
    const std::int64_t drop = std::max<std::int64_t>(0, std::ssize(window_) - kKept);
    window_.erase(0, static_cast<std::size_t>(drop));
    begin_ += drop;
    const std::size_t kept = window_.size();
    window_.resize(kept + static_cast<std::size_t>(kInflateBytes));
    stream_.next_out = reinterpret_cast<Bytef*>(window_.data() + kept);
    stream_.avail_out = static_cast<uInt>(kInflateBytes);
    while (code_ == Z_OK && stream_.avail_out > 0) {
      if (stream_.avail_in == 0 && !read_packed()) break;
      code_ = inflate(&stream_, Z_NO_FLUSH);
    }
    window_.resize(window_.size() - stream_.avail_out);
    good_ = code_ == Z_OK && stream_.avail_out == 0 && begin_ + std::ssize(window_) <= most_;
  }

  bool read_packed() {
    const std::int64_t bytes = std::min(kInflateBytes, packed_.bytes - done_);
    from_.resize(static_cast<std::size_t>(bytes));
    if (bytes == 0 || input_.read(from_.data(), bytes, packed_.content + done_) != bytes)
      return false;
    done_ += bytes;
    stream_.next_in = reinterpret_cast<Bytef*>(from_.data());
    stream_.avail_in = static_cast<uInt>(bytes);
    return true;
  }

  InputFile& input_;
  MatElement packed_;
  std::int64_t most_, done_ = 0, begin_ = 0;  ///< begin_: offset of the window
  z_stream stream_{};
  std::string window_, from_;
  int code_ = Z_OK;
  bool good_ = false;
};

bool is_sound_unpacked(InputFile& input, const MatElement& packed, bool big_endian) {
  constexpr std::int64_t kTagBytes = 8;
  Inflater inflater(input, packed);
  const MatLayout layout(
      [&](void* to, std::int64_t bytes, std::int64_t at) { return inflater.read(to, bytes, at); },
      big_endian);
  const auto matrix = layout.element(0, kMaxInflated + kTagBytes);
  if (!matrix || matrix->type != kMatrix || !layout.is_sound(*matrix, 1)) return false;
  const auto unpacked = inflater.finish();
  return unpacked && matrix->next <= *unpacked;
}

/// Returns the number of variables of a MATLAB file of level 5. Returns nullopt when the file is
/// damaged or cut off: an element is longer than what holds it, or an array has more values than
/// bytes. Also refuses arrays nested more than 16 deep, and a compressed one that unpacks to more
/// than unpack_limit() or 512 MiB. Without these checks libmatio allocates what such numbers say,
/// and silently stops at the first variable that it cannot read.
std::optional<std::size_t> count_in_level_5(InputFile& input, bool big_endian) {
  const ReadAt read = [&](void* to, std::int64_t bytes, std::int64_t at) {
    return input.read(to, bytes, at) == bytes;
  };
  const MatLayout layout(read, big_endian);
  std::size_t count = 0;
  for (auto at = static_cast<std::int64_t>(kMatHeaderBytes); at < input.size(); ++count) {
    const auto top = layout.element(at, input.size());
    if (!top) return std::nullopt;
    if (top->type == kCompressed) {
      if (!is_sound_unpacked(input, *top, big_endian)) return std::nullopt;
    } else if (top->type != kMatrix || !layout.is_sound(*top, 1)) {
      return std::nullopt;
    }
    at = top->next;
  }
  return count;
}

/// Owns a handle of the library and closes it.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (good()) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  hid_t id() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Checks a link for H5Lvisit(). Returns 0 to go on, and 1 to stop when the file refers to another
/// one.
herr_t check_link(hid_t group, const char* name, const H5L_info_t* link, void* /*unused*/) {
  if (link->type == H5L_TYPE_SOFT) return 0;
  if (link->type != H5L_TYPE_HARD) return 1;
  const Hdf5Handle object(H5Oopen(group, name, H5P_DEFAULT), &H5Oclose);
  if (!object.good()) return 1;
  if (H5Iget_type(object.id()) != H5I_DATASET) return 0;
  const Hdf5Handle made(H5Dget_create_plist(object.id()), &H5Pclose);
  if (!made.good()) return 1;
  return H5Pget_external_count(made.id()) != 0 || H5Pget_layout(made.id()) == H5D_VIRTUAL ? 1 : 0;
}

/// Returns true if an HDF5 file, which a MATLAB file of level 7.3 is, is complete in itself: no
/// link and no data set makes the library open another file. Returns false also when the file
/// cannot be read. Turns the library's messages off.
bool hdf5_is_of_one_file(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose);
  return file.good() &&
         H5Lvisit(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, &check_link, nullptr) == 0;
}

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

/// Returns the number of elements, or the largest std::size_t on overflow.
std::size_t elements_of(const matvar_t& v) {
  std::size_t count = 1;
  for (int i = 0; i < v.rank; ++i)
    if (__builtin_mul_overflow(count, v.dims[i], &count))
      return std::numeric_limits<std::size_t>::max();
  return count;
}

/// Returns the number of elements of a variable and of everything in it.
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

/// Returns true for a variable that MATLAB adds for tables, time stamps, strings and objects. It
/// has no name in level 5, and "#subsystem#" in 7.3.
bool is_own(const matvar_t& v) {
  return v.name == nullptr || v.name[0] == '\0' || v.name[0] == '#';
}

}  // namespace

MatLevel mat_level(std::string_view head) {
  if (head.size() < kMatHeaderBytes || !head.starts_with("MATLAB ")) return MatLevel::none;
  const std::string_view version = head.substr(124, 2), order = head.substr(126, 2);
  if ((order != "IM" && order != "MI") || version[order == "IM" ? 0 : 1] != 0)
    return MatLevel::none;
  const char high = version[order == "IM" ? 1 : 0];
  return high == 1 ? MatLevel::level_5 : high == 2 ? MatLevel::level_7_3 : MatLevel::none;
}

struct MatFileReader::State {
  InputFile input;
  std::unique_ptr<mat_t, CloseMat> file;
  std::vector<std::unique_ptr<matvar_t, FreeVariable>> tops;
  std::vector<bool> read;
  std::size_t values = 0;  ///< values read so far
  std::size_t stated = 0;  ///< number of variables that the file states

  /// Appends a variable, or the fields of a struct, to `out`. Returns false when structs are nested
  /// too deeply or there are too many variables.
  bool list(matvar_t* v, const std::string& name, int depth, std::vector<MatVariable>& out) const {
    if (v == nullptr) return true;
    if (depth > kDeepestStruct || out.size() >= kMaxVariables) return false;
    // libmatio gives names but no fields for a damaged struct.
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
    added.is_object = v->class_type == MAT_C_OBJECT || v->class_type == MAT_C_OPAQUE;
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
                        ? "is a MATLAB file within a gzip file: unpack it first (gunzip)"
                        : "is not a MATLAB file of level 5 or 7.3 (save it with -v7)");
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
    problems.add(0, "is damaged, or refers to other files, which are never opened");
    return;
  }
  state_->file.reset(Mat_Open(name.c_str(), MAT_ACC_RDONLY));
  if (!state_->file) {
    problems.add(0, "cannot be read as a MATLAB file: its header is damaged");
    return;
  }
  state_->stated = *count;
  if (is_hdf5) (void)Mat_GetDir(state_->file.get(), &state_->stated);
}

MatFileReader::~MatFileReader() = default;

std::optional<std::vector<MatVariable>> MatFileReader::variables(FileProblems& problems) {
  std::vector<MatVariable> out;
  if (!state_->file) return std::nullopt;
  while (matvar_t* const v = Mat_VarReadNextInfo(state_->file.get())) {
    state_->tops.emplace_back(v);
    if (is_own(*v)) continue;
    if (state_->list(v, v->name, 1, out)) continue;
    problems.add(0, fmt::format("more than {} variables, or structs nested more than {} deep",
                                kMaxVariables, kDeepestStruct));
    return std::nullopt;
  }
  if (state_->tops.size() < state_->stated)
    return problems.add(0, fmt::format("is damaged: {} of its {} variables can be read",
                                       state_->tops.size(), state_->stated));
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
    problems.add(0, fmt::format("{}: {}: more than {} values, the limit for a file of this size",
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
