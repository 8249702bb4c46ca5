// Entries of the folder, and what is left of it when it is full.
#include "testbench/streaminggs/run/codebook_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <system_error>

#include "algorithm/files/input_error.h"
#include "algorithm/memory/record_split.h"
#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/storage/image_file.h"
#include "modules/config/strict_json.h"
#include "modules/storage_keys.h"
#include "testbench/streaminggs/report/provenance.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

// An entry is called so, a digest behind it: told from packed scenes of the user by that.
const std::string kEntryPrefix = "codebooks-";

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string usual_folder() {
  if (std::string given = environment("STREAMINGGS_CACHE"); !given.empty()) return given;
  if (const std::string caches = environment("XDG_CACHE_HOME"); !caches.empty()) {
    return fs::path(caches) / "streaminggs";
  }
  const std::string home = environment("HOME");
  return home.empty() ? CodebookCache::kOff : (fs::path(home) / ".cache" / "streaminggs").string();
}

template <class T>
std::uint64_t hash_of(const std::vector<T>& values) {
  return xxh64(values.data(), values.size() * sizeof(T));
}

// Without extension.
std::string name_of(const ActivatedCloud& cloud, const VqConfig& config,
                    const std::vector<Camera>& weighing) {
  static_assert(sizeof(Gaussian<float>) == 11 * sizeof(float), "no byte is left undefined");
  std::string key = fmt::format("{:016x} {} {:016x} {:016x} {}\n", xxh64_of_file("/proc/self/exe"),
                                cloud.sh_degree, hash_of(cloud.gaussians), hash_of(cloud.sh_coeffs),
                                config_to_json(config));
  for (const Camera& camera : weighing) key += text_of(camera) + "\n";
  return fmt::format("{}{:016x}", kEntryPrefix, xxh64_of_text(key));
}

// Or the part file of one, which a killed process leaves.
bool is_entry(const std::string& file) {
  const std::size_t digest = kEntryPrefix.size(), extension = digest + 16;
  return file.rfind(kEntryPrefix, 0) == 0 &&
         file.find_first_not_of("0123456789abcdef", digest) == extension &&
         file.find(kImageFileExtension, extension) == extension;
}

void write_entry(const std::string& path, const ActivatedCloud& cloud, const VqConfig& config,
                 const QuantisedCloud& quantised) {
  StorageConfig storage;
  storage.order = StorageOrder::kFile;
  storage.sequence = FileSequence::kFile;
  storage.encoding = SecondHalfEncoding::kVq;
  storage.store_invisible = true;
  storage.vq = config;
  const PackedFacts facts{fs::path(path).stem().string(), cloud.size(), 0, 0};
  write_image_file(
      path, facts, storage,
      build_memory_image(encode_quantised(cloud, quantised, storage.encoding), NoTable{}));
}

// Throws InputError: damaged, or kept under another name.
QuantisedCloud read_entry(const std::string& path, const ActivatedCloud& cloud) {
  const PackedScene packed = read_image_file(path);
  const SceneLayout& layout = packed.image.layout;
  const SecondHalfFormat& format = layout.second_half;
  if (packed.facts.name != fs::path(path).stem().string() ||
      layout.order() != StorageOrder::kFile || format.encoding != SecondHalfEncoding::kVq ||
      layout.gaussian_count() != cloud.size() || format.sh_degree != cloud.sh_degree) {
    throw InputError(path + ": of something else, expected what it is named after");
  }
  const ActivatedCloud decoded = decode_image(packed.image, path);
  QuantisedCloud out;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const auto codebook = static_cast<Codebook>(id);
    out.codebooks[id].resize(std::size_t{format.entries[id]} *
                             codebook_words(codebook, format.sh_degree));
    std::memcpy(out.codebooks[id].data(),
                packed.image.at(layout.codebooks.base + format.entry(codebook, 0).begin),
                out.codebooks[id].size() * sizeof(float));
    out.indices[id].resize(cloud.size());
  }
  out.opacities.resize(cloud.size());
  for (std::uint32_t slot = 0; slot < cloud.size(); ++slot) {
    const SplitFirstHalf first =
        read_first_half(layout.split, packed.image.at(layout.first_halves.address(slot)));
    const CodebookIndices indices = read_indices(
        layout.split, format, first.carried, packed.image.at(layout.second_halves.address(slot)));
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      if (format.entries[id] > 0) out.indices[id][slot] = indices[id];
    }
    out.opacities[slot] =
        static_cast<std::uint8_t>(std::lround(decoded.gaussians[slot].opacity * 255.0F));
  }
  return out;
}

// The oldest go until all fit; `kept` stays whatever it takes. Another process may be faster.
void make_room(const fs::path& kept) {
  struct Entry {
    fs::file_time_type time;
    fs::path path;
    std::uint64_t bytes;
  };
  std::vector<Entry> entries;
  std::uint64_t bytes = 0;
  std::error_code gone;
  for (const fs::directory_entry& file : fs::directory_iterator(kept.parent_path())) {
    if (!is_entry(file.path().filename().string())) continue;
    const std::uint64_t of_file = file.file_size(gone);
    if (gone) continue;
    bytes += of_file;
    if (file.path() != kept) entries.push_back({file.last_write_time(gone), file.path(), of_file});
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (const Entry& entry : entries) {
    if (bytes <= CodebookCache::kMostBytes) return;
    fs::remove(entry.path, gone);
    bytes -= entry.bytes;
  }
}

}  // namespace

CodebookCache::CodebookCache(const std::string& folder)
    : folder_(folder.empty() ? usual_folder() : folder) {
  if (folder_ == kOff) folder_.clear();
}

QuantisedCloud CodebookCache::codebooks(const ActivatedCloud& cloud, const VqConfig& config,
                                        const std::vector<Camera>& weighing,
                                        const std::function<QuantisedCloud()>& make) const {
  if (folder_.empty()) return make();
  const fs::path path =
      fs::path(folder_) / (name_of(cloud, config, weighing) + kImageFileExtension);
  std::error_code unknown;
  if (fs::exists(path, unknown)) {
    try {
      QuantisedCloud kept = read_entry(path, cloud);
      fs::last_write_time(path, fs::file_time_type::clock::now(), unknown);  // used: not the oldest
      fmt::print("codebooks out of {}\n", path.string());
      return kept;
    } catch (const InputError& error) {
      fmt::print("codebooks are made anew: {}\n", error.what());
    }
  }
  QuantisedCloud made = make();
  try {
    fs::create_directories(folder_);
    write_entry(path, cloud, config, made);
    fmt::print("codebooks kept in {}\n", path.string());
    make_room(path);
  } catch (const std::exception& error) {
    fmt::print("codebooks are not kept: {}\n", error.what());
  }
  return made;
}

}  // namespace sgs
