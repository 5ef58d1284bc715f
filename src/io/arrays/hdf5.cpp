// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "io/arrays/shared/array_matrix.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// The HDF5 library may be built without thread safety. Recursive because a rejected data set is
/// closed while it is being opened.
std::recursive_mutex hdf5_mutex;

class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// Suppresses error output of the library in its scope.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Returns the innermost message of the library's last error.
std::string last_words() {
  std::string words;
  const auto keep = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(data) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &words);
  return words.empty() ? "the HDF5 library gives no reason" : words;
}

std::optional<NpyType> number_type(hid_t type) {
  const std::size_t bytes = H5Tget_size(type);
  if (H5Tget_class(type) == H5T_FLOAT) {
    if (bytes == 2 || bytes == 4) return NpyType::float32;  // exact conversion by HDF5
    if (bytes == 8) return NpyType::float64;
    return {};
  }
  if (H5Tget_class(type) != H5T_INTEGER) return {};
  const bool with_sign = H5Tget_sign(type) == H5T_SGN_2;
  switch (bytes) {
    case 1:
      return with_sign ? NpyType::int8 : NpyType::uint8;
    case 2:
      return with_sign ? NpyType::int16 : NpyType::uint16;
    case 4:
      return with_sign ? NpyType::int32 : NpyType::uint32;
    case 8:
      return with_sign ? NpyType::int64 : NpyType::uint64;
    default:
      return {};
  }
}

hid_t native_type(NpyType type) {
  switch (type) {
    case NpyType::int8:
      return H5T_NATIVE_INT8;
    case NpyType::uint8:
      return H5T_NATIVE_UINT8;
    case NpyType::int16:
      return H5T_NATIVE_INT16;
    case NpyType::uint16:
      return H5T_NATIVE_UINT16;
    case NpyType::int32:
      return H5T_NATIVE_INT32;
    case NpyType::uint32:
      return H5T_NATIVE_UINT32;
    case NpyType::int64:
      return H5T_NATIVE_INT64;
    case NpyType::uint64:
      return H5T_NATIVE_UINT64;
    case NpyType::float32:
      return H5T_NATIVE_FLOAT;
    default:
      return H5T_NATIVE_DOUBLE;
  }
}

struct Listed {
  std::string name;
  NpyShape shape;
};

NpyShape shape_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const int axes = space < 0 ? 0 : H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> sizes(static_cast<std::size_t>(std::max(axes, 0)));
  if (!sizes.empty()) H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
  return {sizes.begin(), sizes.end()};
}

/// Lists numeric data sets with two to four axes. Links to other files are not followed.
std::vector<Listed> list_datasets(hid_t file) {
  std::vector<Listed> found;
  // The type of `info` is H5O_info_t in HDF5 1.10 and H5O_info1_t from 1.12 on.
  const auto look = [](hid_t root, const char* name, const auto* info, void* data) -> herr_t {
    constexpr std::size_t most = 1000;
    auto& list = *static_cast<std::vector<Listed>*>(data);
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Handle dataset(H5Dopen2(root, name, H5P_DEFAULT), H5Dclose);
    if (dataset < 0) return 0;
    const Handle type(H5Dget_type(dataset), H5Tclose);
    NpyShape shape = shape_of(dataset);
    if (number_type(type) && shape.size() >= 2 && shape.size() <= 4)
      list.push_back({name, std::move(shape)});
    return list.size() < most ? 0 : 1;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, look, &found, H5O_INFO_BASIC);
  return found;
}

std::string describe(const std::vector<Listed>& list) {
  if (list.empty()) return "no data set of numbers with two to four axes";
  constexpr std::size_t most = 8;
  std::vector<std::string> words;
  for (const Listed& one : list) {
    if (words.size() == most) {
      words.push_back(fmt::format("and {} more", list.size() - most));
      break;
    }
    words.push_back(fmt::format("{} {}", one.name, describe_shape(one.shape)));
  }
  return fmt::format("the data sets {}", fmt::join(words, ", "));
}

std::string chosen_name(const std::vector<Listed>& list, const std::string& asked,
                        const std::string& file) {
  if (asked.empty() && list.size() == 1) return list.front().name;
  const std::string wanted = asked.empty() ? "raw" : asked.substr(asked.front() == '/' ? 1 : 0);
  for (const Listed& one : list)
    if (one.name == wanted) return one.name;
  throw IoError(
      file,
      asked.empty()
          ? fmt::format("found {}; expected one called raw, or only one (--dataset selects one)",
                        describe(list))
          : fmt::format("there is no data set {} of frames; found {}", asked, describe(list)));
}

struct Dataset {
  std::string file;
  std::string name;
  Handle opened_file;
  Handle dataset;
  NpyType type;
  NpyShape shape;

  IoError error(const std::string& what) const {
    return IoError(file, fmt::format("data set {}: {}", name, what));
  }
  void read_items(std::size_t first, std::span<std::byte> into) const;
  void read_box(const std::vector<hsize_t>& start, const std::vector<hsize_t>& count,
                std::byte* into) const;
};

void Dataset::read_box(const std::vector<hsize_t>& start, const std::vector<hsize_t>& count,
                       std::byte* into) const {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                      H5Sclose);
  if (space < 0 || memory < 0 ||
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) <
          0 ||
      H5Dread(dataset, native_type(type), memory, space, H5P_DEFAULT, into) < 0)
    throw error(fmt::format("cannot be read: {}", last_words()));
}

/// Reads a few boxes: whole slices of the slowest axis that fits the range.
void Dataset::read_items(std::size_t first, std::span<std::byte> into) const {
  const std::lock_guard lock(hdf5_mutex);
  const Quiet quiet;
  const std::size_t axes = shape.size(), item = item_size(type);
  std::size_t left = into.size() / item;
  std::byte* to = into.data();
  while (left > 0) {
    std::vector<hsize_t> start(axes), count(axes, 1);
    std::size_t at = first, slice = 1, axis = axes - 1;
    for (std::size_t a = axes; a-- > 0; at /= shape[a]) start[a] = at % shape[a];
    while (axis > 0 && start[axis] == 0 && left >= slice * shape[axis]) {
      slice *= shape[axis];
      count[axis] = shape[axis];
      --axis;
    }
    count[axis] = std::min(left / slice, shape[axis] - static_cast<std::size_t>(start[axis]));
    read_box(start, count, to);
    const std::size_t items = count[axis] * slice;
    first += items;
    left -= items;
    to += items * item;
  }
}

/// Unpacked size [bytes]; 0 if the data set is contiguous.
std::uint64_t chunk_bytes(hid_t dataset, const NpyShape& shape, std::size_t item) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_layout(properties) != H5D_CHUNKED) return 0;
  std::vector<hsize_t> chunk(shape.size());
  if (H5Pget_chunk(properties, static_cast<int>(chunk.size()), chunk.data()) < 0) return 0;
  std::uint64_t bytes = item;
  for (const hsize_t size : chunk) bytes *= size;  // HDF5 limits chunks to 4 GB
  return bytes;
}

bool lies_elsewhere(hid_t dataset) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  return H5Pget_layout(properties) == H5D_VIRTUAL || H5Pget_external_count(properties) > 0;
}

Handle open_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw IoError(path.string(), "there is no such file");
  if (!std::filesystem::is_regular_file(path, ignored))
    throw IoError(path.string(), "found no file; expected an HDF5 file");
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (file < 0)
    throw IoError(path.string(), fmt::format("cannot be read as an HDF5 file: {}", last_words()));
  return file;
}

Handle open_dataset(hid_t file, const std::string& name, std::size_t cache_bytes) {
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  constexpr std::size_t slots = 12421;  // a prime, much larger than the number of chunks
  H5Pset_chunk_cache(access, slots, cache_bytes, H5D_CHUNK_CACHE_W0_DEFAULT);
  const auto refuse = [](const char*, const char*, const char*, const char*, unsigned*, hid_t,
                         void*) -> herr_t { return -1; };
  H5Pset_elink_cb(access, refuse, nullptr);
  return Handle(H5Dopen2(file, name.c_str(), access), H5Dclose);
}

}  // namespace

StoredArray stored_array(NpyReader reader) {
  const auto file = std::make_shared<NpyReader>(std::move(reader));
  return {file->type(), file->shape(),
          [file](std::size_t first, std::span<std::byte> into) { file->read_items(first, into); },
          0};
}

StoredArray open_hdf5(const std::filesystem::path& path, const std::string& dataset,
                      std::uint64_t max_bytes) {
  const std::lock_guard lock(hdf5_mutex);
  const Quiet quiet;
  Handle file = open_file(path);
  const std::string name = chosen_name(list_datasets(file), dataset, path.string());
  Handle opened = open_dataset(file, name, 0);
  const Handle stored_type(H5Dget_type(opened), H5Tclose);
  const std::optional<NpyType> type = number_type(stored_type);
  if (opened < 0 || !type)
    throw IoError(path.string(), fmt::format("data set {}: {}", name, last_words()));
  NpyShape shape = shape_of(opened);
  const std::uint64_t chunk = chunk_bytes(opened, shape, item_size(*type));
  constexpr std::uint64_t usual_cache = std::uint64_t{1} << 24;
  const std::uint64_t cache = chunk == 0 ? 0 : std::max(chunk, std::min(usual_cache, max_bytes));
  if (chunk > 0) opened = open_dataset(file, name, cache);
  const std::shared_ptr<const Dataset> found(
      new Dataset{path.string(), name, std::move(file), std::move(opened), *type, std::move(shape)},
      [](const Dataset* closed) {
        const std::lock_guard closing(hdf5_mutex);
        delete closed;
      });
  if (lies_elsewhere(found->dataset))
    throw found->error("found data stored in other files; expected it in this file");
  if (chunk > max_bytes)
    throw found->error(
        fmt::format("found chunks of {:.4g} MB; expected at most {:.4g} MB (--memory-mb allows "
                    "more)",
                    1e-6 * static_cast<double>(chunk), 1e-6 * static_cast<double>(max_bytes)));
  if (H5Dget_storage_size(found->dataset) == 0)
    throw found->error(
        fmt::format("found no data in {}; expected numbers", describe_shape(found->shape)));
  return {found->type, found->shape,
          [found](std::size_t first, std::span<std::byte> into) { found->read_items(first, into); },
          static_cast<std::size_t>(cache)};
}

}  // namespace tofsmith
