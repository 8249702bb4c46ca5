// Fields that writer and reader of memory image files share: where the header's fields lie, and
// their list; the numbers that one storage order alone has come from its scheme. Eight bytes for
// std::uint64_t and double, four for everything else (floating point as its bits, signed numbers as
// two's complement).
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "algorithm/storage/image_file.h"
#include "algorithm/storage/storage_scheme.h"

namespace sgs {

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'S', 'G', 'S', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kVersionAt = 8, kHeaderBytesAt = 12, kLengthAt = 16, kFieldsAt = 24;
constexpr std::size_t kChecksumBytes = 4;

template <class T>
constexpr std::size_t field_bytes() {
  return sizeof(T) == 8 ? 8 : 4;
}

// The contents of a header: all that a layout follows from, and the layout's regions once more,
// which must be the same.
struct ImageFileHeader {
  PackedFacts facts;
  StorageConfig storage;
  SecondHalfFormat format;   // format of storage.encoding
  std::uint32_t stored = 0;  // Gaussians
  TableLayout table;         // values that its layout follows from, as the order's scheme says
  std::vector<Region> regions;
};

// The header of a scene of nothing, with the regions that this order has.
ImageFileHeader empty_header(StorageOrder order);

ImageFileHeader header_of(const PackedFacts& facts, const StorageConfig& storage,
                          const SceneLayout& layout);

// The layout that follows from all but the regions.
SceneLayout layout_of(const ImageFileHeader& header);

constexpr double kMostStorageOrder = std::variant_size_v<TableLayout> - 1;  // voxels, chunks, file

// The fields of the storage order among the others.
template <class Fields>
class TableFieldsOf : public TableFields {
 public:
  explicit TableFieldsOf(Fields& fields) : fields_(fields) {}
  void operator()(const char* name, double& value, double lowest, double highest) override {
    fields_(name, value, lowest, highest);
  }
  void operator()(const char* name, int& value, double lowest, double highest) override {
    fields_(name, value, lowest, highest);
  }
  void operator()(const char* name, std::uint32_t& value, double lowest, double highest) override {
    fields_(name, value, lowest, highest);
  }

 private:
  Fields& fields_;
};

// Calls fields(name, value, lowest, highest) for each field in the order of the file. The first is
// the storage order, which decides what follows: a reader begins with empty_header().
template <class Fields>
void visit_fields(Fields& fields, ImageFileHeader& header) {
  constexpr double kWord = std::numeric_limits<std::uint32_t>::max();
  constexpr double kAny = static_cast<double>(std::numeric_limits<std::uint64_t>::max());
  constexpr double kMostDegree = 3, kMostIterations = 1000;
  StorageConfig& storage = header.storage;
  fields("storage order", storage.order, 0, kMostStorageOrder);
  fields("encoding", storage.encoding, 0, 3);  // as SecondHalfEncoding
  fields("store_invisible", storage.store_invisible, 0, 1);
  fields("sh_tolerance", storage.sh_tolerance, 0, 1);
  fields("vq.scale_entries", storage.vq.scale_entries, 1, kMaxCodebookEntries);
  fields("vq.rotation_entries", storage.vq.rotation_entries, 1, kMaxCodebookEntries);
  fields("vq.dc_entries", storage.vq.dc_entries, 1, kMaxCodebookEntries);
  fields("vq.sh_entries", storage.vq.sh_entries, 1, kMaxCodebookEntries);
  fields("vq.iterations", storage.vq.iterations, 0, kMostIterations);
  fields("vq.seed", storage.vq.seed, 0, kAny);
  fields("Gaussians in the scene", header.facts.gaussians, 0, kWord);  // slots have 32 bits
  fields("Gaussians dropped as invalid", header.facts.dropped_invalid, 0, kAny);
  fields("stored Gaussians", header.stored, 0, kWord);
  fields("SH degree", header.format.sh_degree, 0, kMostDegree);
  fields("SH bands left out", header.facts.sh_bands_left_out, 0, kMostDegree);
  for (auto& entries : header.format.entries) {
    fields("codebook entries", entries, 0, kMaxCodebookEntries);
  }
  TableFieldsOf<Fields> of_table(fields);
  scheme_of(storage.order).visit(of_table, storage, header.table);
  for (auto& region : header.regions) {
    fields(region.name.c_str(), region.base, 0, kAny);
    fields(region.name.c_str(), region.bytes, 0, kAny);
  }
}

// As image_file.h says; bytes: of the image.
void write_image_file(const std::string& path, const ImageFileHeader& header,
                      const std::vector<std::byte>& bytes);

// Bytes of a header in this order with an empty name.
std::size_t least_header_bytes(StorageOrder order);

// CRC-32 of bytes behind those whose checksum is `before`; 0 to begin with.
std::uint32_t checksum_of(std::uint32_t before, const void* bytes, std::size_t size);

}  // namespace sgs
