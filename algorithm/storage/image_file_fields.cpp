// Headers of memory image files from layouts, and layouts from headers.
#include "algorithm/storage/image_file_fields.h"

#include <zlib.h>

#include <filesystem>

namespace sgs {
namespace {

struct FieldCounter {
  std::size_t bytes = 0;
  template <class T>
  void operator()(const char*, const T&, double, double) {
    bytes += field_bytes<T>();
  }
};

}  // namespace

ImageFileHeader empty_header(StorageOrder order) {
  ImageFileHeader header;
  header.storage.order = order;
  header.table = scheme_of(order).empty_table();
  const Regions regions = layout_of(header).regions;
  header.regions.assign(regions.begin(), regions.end());
  return header;
}

ImageFileHeader header_of(const PackedFacts& facts, const StorageConfig& storage,
                          const SceneLayout& layout) {
  ImageFileHeader header{facts,        storage, layout.second_half, layout.gaussian_count(),
                         layout.table, {}};
  header.regions.assign(layout.regions.begin(), layout.regions.end());
  return header;
}

SceneLayout layout_of(const ImageFileHeader& header) {
  SecondHalfFormat format = header.format;
  format.encoding = header.storage.encoding;
  return scheme_of(header.storage.order)
      .lay_out(format, header.stored, header.storage, header.table);
}

std::size_t least_header_bytes(StorageOrder order) {
  FieldCounter counter{kFieldsAt};
  ImageFileHeader header = empty_header(order);
  visit_fields(counter, header);
  return counter.bytes;
}

std::uint32_t checksum_of(std::uint32_t before, const void* bytes, std::size_t size) {
  if (size == 0) return before;  // zlib begins anew where there is no buffer
  return static_cast<std::uint32_t>(::crc32_z(before, static_cast<const Bytef*>(bytes), size));
}

bool is_image_file(const std::string& path) {
  return std::filesystem::path(path).extension() == kImageFileExtension;
}

}  // namespace sgs
