// Everything that a storage order says of itself: its keys and the choices they leave, how its
// table is made from a scene, stored, packed and believed again, and what reports and people are
// told. Another order is another scheme in a file of its own, a line in storage_scheme.cpp, and its
// record in ../memory/scene_layout.h; whoever stores, packs or reports asks the scheme.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// Values that a storage configuration may leave open (0), chosen by rules that say why.
template <class T>
struct Choice {
  T value;
  std::string why;  // a sentence with the numbers
};

// The same of a key below `storage`.
struct StorageChoice {
  const char* key;
  double value;
  std::string why;
};

// The voxel size in world units: by the inner extent of the scene (voxel_grid.h), or as it is said.
Choice<double> choose_voxel_size(const ActivatedCloud& cloud, VoxelRule rule = VoxelRule::kExtent);

// The most Gaussians in a chunk. run_bytes: what lies together in one row of one memory channel. A
// chunk's first halves fill it: smaller chunks cost more tree records than they save, larger ones
// stream Gaussians that the group does not need.
Choice<std::uint32_t> choose_chunk_gaussians(std::uint32_t run_bytes);

// The numbers of a packed scene's header that only its storage order has: counts their bytes,
// writes or reads them. A reader throws InputError for what is not between lowest and highest.
class TableFields {
 public:
  virtual ~TableFields() = default;
  virtual void operator()(const char* name, double& value, double lowest, double highest) = 0;
  virtual void operator()(const char* name, int& value, double lowest, double highest) = 0;
  virtual void operator()(const char* name, std::uint32_t& value, double lowest,
                          double highest) = 0;

  // A count of records or blocks takes four bytes in the file, whatever holds it in memory.
  template <class Count>
  void count(const char* name, Count& value) {
    auto word = static_cast<std::uint32_t>(value);
    (*this)(name, word, 0, UINT32_MAX);
    value = word;
  }
};

// A size among a configuration's storage keys that this order alone has; 0 leaves it open.
struct StorageSize {
  const char* key;
  std::variant<double StorageConfig::*, std::uint32_t StorageConfig::*> value;
  double most;
  const char* meaning;
};

// A number that a report states of a stored scene's table.
struct StorageFact {
  const char *key, *unit, *meaning;
  std::variant<std::uint64_t, double> value;
};

class StorageScheme {
 public:
  virtual ~StorageScheme() = default;

  // "chunks": what a scene is stored by.
  virtual const char* name() const = 0;

  // Configuration.
  virtual std::vector<StorageSize> sizes() const { return {}; }
  virtual bool has_sequence() const { return false; }    // StorageConfig::sequence
  virtual bool has_voxel_rule() const { return false; }  // StorageConfig::voxel_rule
  // Fill in the sizes that are open and follow from the memory (run_bytes: what lies together in
  // one row of one channel), or from the scene; return what they chose.
  virtual std::vector<StorageChoice> choose(StorageConfig&, std::uint32_t /*run_bytes*/) const {
    return {};
  }
  virtual std::vector<StorageChoice> choose(StorageConfig&, const ActivatedCloud&) const {
    return {};
  }
  // Throws InputError where a size is still open, or cannot be.
  virtual void check(const StorageConfig&) const {}

  // Making: the table of a cloud and its storage order, then the bytes of the scene in that order.
  // Throws InputError.
  virtual Arrangement<StoredTable> arrange(const ActivatedCloud& decoded,
                                           const StorageConfig&) const = 0;
  virtual MemoryImage image_of(const EncodedCloud& encoded, const StoredTable&) const = 0;
  // Restoring: the table of an image whose records are `decoded`, with nothing in it believed.
  // source: what errors name. Throws InputError.
  virtual StoredTable restore(const PackedScene& packed, const ActivatedCloud& decoded,
                              const std::string& source) const = 0;

  // Files. The numbers that a packed scene's header has of this order, in the order of the file;
  // `table` is of this order, and only what its layout follows from need be right in it.
  virtual TableLayout empty_table() const = 0;
  virtual void visit(TableFields& fields, StorageConfig& storage, TableLayout& table) const = 0;
  virtual SceneLayout lay_out(const SecondHalfFormat& format, std::uint32_t gaussians,
                              const StorageConfig& storage, const TableLayout& table) const = 0;

  // People and reports.
  virtual std::string in_words(const StorageConfig&) const = 0;  // "chunks of 16"
  // How many blocks the table divides the scene into, and each one's size; none without a table.
  virtual std::optional<std::uint64_t> blocks(const TableLayout&) const { return {}; }
  virtual std::string size_in_words(const StorageConfig&) const { return {}; }  // "at most 16 ..."
  virtual std::vector<StorageFact> facts(const TableLayout&) const { return {}; }
};

const StorageScheme& scheme_of(StorageOrder order);

inline Stored stored_of(const StorageConfig& config) {
  return config.store_invisible ? Stored::kAll : Stored::kVisible;
}

// The schemes there are.
const StorageScheme& voxel_scheme();
const StorageScheme& chunk_scheme();
const StorageScheme& file_scheme();

}  // namespace sgs
