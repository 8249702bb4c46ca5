// Writing of memory image files.
#include <fmt/format.h>
#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "algorithm/input_error.h"
#include "algorithm/memory/image_file.h"
#include "algorithm/memory/image_file_fields.h"
#include "algorithm/output_file.h"

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
    if constexpr (std::is_same_v<T, float>) {
      std::uint32_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      put(out, bits, sizeof bits);
    } else {
      put(out, static_cast<std::uint64_t>(value), field_bytes<T>());
    }
  }
};

struct FieldCounter {
  std::size_t bytes = 0;
  template <class T>
  void operator()(const char*, const T&, double, double) {
    bytes += field_bytes<T>();
  }
};

}  // namespace

std::size_t least_header_bytes() {
  FieldCounter counter{kFieldsAt};
  const PackedFacts facts;
  const MemoryLayout layout;
  visit_fields(counter, facts, layout);
  return counter.bytes;
}

std::uint32_t checksum_of(std::uint32_t before, const void* bytes, std::size_t size) {
  if (size == 0) return before;  // zlib begins anew where there is no buffer
  return static_cast<std::uint32_t>(::crc32_z(before, static_cast<const Bytef*>(bytes), size));
}

bool is_image_file(const std::string& path) {
  return std::filesystem::path(path).extension() == kImageFileExtension;
}

void write_image_file(const std::string& path, const PackedFacts& facts, const MemoryImage& image) {
  const std::string name = facts.name.substr(0, kMostNameBytes);
  const std::size_t header_bytes = least_header_bytes() + name.size();
  std::vector<std::uint8_t> header(kMagic.begin(), kMagic.end());
  put(header, kImageFileVersion, 4);
  put(header, header_bytes, 4);
  put(header, header_bytes + image.bytes.size() + kChecksumBytes, 8);
  FieldWriter writer{header};
  visit_fields(writer, facts, image.layout);
  header.insert(header.end(), name.begin(), name.end());
  std::vector<std::uint8_t> end;
  put(end,
      checksum_of(checksum_of(0, header.data(), header.size()), image.bytes.data(),
                  image.bytes.size()),
      kChecksumBytes);

  OutputFile output(path);
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      std::fopen(output.temporary_path().c_str(), "wb"), &std::fclose);
  if (!file) {
    throw InputError(fmt::format("{}: cannot be created ({}), expected a writable place", path,
                                 std::strerror(errno)));
  }
  const auto write = [&](const void* bytes, std::size_t size) {
    return size == 0 || std::fwrite(bytes, 1, size, file.get()) == size;
  };
  const bool written = write(header.data(), header.size()) &&
                       write(image.bytes.data(), image.bytes.size()) &&
                       write(end.data(), end.size());
  // Closing flushes: a full disk may show only here.
  if (std::fclose(file.release()) != 0 || !written) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  }
  output.commit();
}

}  // namespace sgs
