// Writing of memory image files.
#include <fmt/format.h>

#include <cstring>
#include <type_traits>

#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/image_file_fields.h"

namespace sgs {
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
