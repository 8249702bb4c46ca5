// Headers of memory image files from layouts, layouts from headers, and the writing of the files.
#include "algorithm/storage/image_file_fields.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <type_traits>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/storage/image_file.h"

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

namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "the image's bytes are written as they lie in memory");

void put(std::vector<std::uint8_t>& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t b = 0; b < bytes; ++b) out.push_back(static_cast<std::uint8_t>(value >> 8 * b));
}

struct FieldWriter {
  std::vector<std::uint8_t>& out;

  template <class T>
  void operator()(const char*, const T& value, double, double) {
    if constexpr (std::is_same_v<T, double>) {
      std::uint64_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      put(out, bits, sizeof bits);
    } else {
      put(out, static_cast<std::uint64_t>(value), field_bytes<T>());
    }
  }
};

}  // namespace

void write_image_file(const std::string& path, const PackedFacts& facts,
                      const StorageConfig& storage, const MemoryImage& image) {
  write_image_file(path, header_of(facts, storage, image.layout), image.bytes);
}

void write_image_file(const std::string& path, const ImageFileHeader& header,
                      const std::vector<std::byte>& bytes) {
  const std::string name = header.facts.name.substr(0, kMostNameBytes);
  const std::size_t header_bytes = least_header_bytes(header.storage.order) + name.size();
  std::vector<std::uint8_t> start(kMagic.begin(), kMagic.end());
  put(start, kImageFileVersion, 4);
  put(start, header_bytes, 4);
  put(start, header_bytes + bytes.size() + kChecksumBytes, 8);
  FieldWriter writer{start};
  ImageFileHeader fields = header;  // visiting may write
  visit_fields(writer, fields);
  start.insert(start.end(), name.begin(), name.end());
  std::vector<std::uint8_t> end;
  put(end, checksum_of(checksum_of(0, start.data(), start.size()), bytes.data(), bytes.size()),
      kChecksumBytes);

  OutputFile output(path);
  output.write(start.data(), start.size());
  output.write(bytes.data(), bytes.size());
  output.write(end.data(), end.size());
  output.commit();
}

}  // namespace sgs
