// Reading of memory image files.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/image_file_fields.h"

namespace sgs {
namespace {

constexpr std::size_t kFirstFieldEnd = kFieldsAt + 4;  // end of the storage order

std::uint64_t number_at(const std::uint8_t* at, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t b = 0; b < bytes; ++b) value |= std::uint64_t{at[b]} << 8 * b;
  return value;
}

class FieldReader {
 public:
  FieldReader(const std::string& path, const std::vector<std::uint8_t>& header)
      : path_(path), header_(header) {}

  template <class T>
  void operator()(const char* name, T& value, double lowest, double highest) {
    const std::uint64_t bits = number_at(header_.data() + at_, field_bytes<T>());
    if constexpr (std::is_same_v<T, double>) {
      std::memcpy(&value, &bits, sizeof value);
      check(name, value, lowest, highest);
    } else if constexpr (std::is_same_v<T, int>) {
      value = static_cast<std::int32_t>(bits);
      check(name, value, lowest, highest);
    } else {
      check(name, bits, lowest, highest);
      value = static_cast<T>(bits);
    }
    at_ += field_bytes<T>();
  }

 private:
  template <class Number>
  void check(const char* name, Number value, double lowest, double highest) const {
    const auto number = static_cast<double>(value);
    if (number >= lowest && number <= highest) return;  // not where it is NaN
    throw InputError(fmt::format("{}: byte {}: {}: got {}, expected {} to {}", path_, at_, name,
                                 value, lowest, highest));
  }

  const std::string& path_;
  const std::vector<std::uint8_t>& header_;
  std::size_t at_ = kFieldsAt;
};

[[noreturn]] void refuse(const InputFile& file, std::size_t at, const std::string& what) {
  throw InputError(fmt::format("{}: byte {}: {}", file.path(), at, what));
}

// Magic, version, length and checksum; returns the checksum.
std::uint32_t check_whole(const InputFile& file) {
  std::array<std::uint8_t, kFieldsAt> start{};
  file.read_at(0, start.data(), std::min<std::uint64_t>(start.size(), file.size_bytes()));
  if (!std::equal(kMagic.begin(), kMagic.end(), start.begin())) {
    refuse(file, 0, "not the magic number of a memory image, expected a file made by pack");
  }
  if (file.size_bytes() < kFirstFieldEnd + kChecksumBytes) {
    refuse(file, file.size_bytes(), "the file ends in its header, expected the rest of it");
  }
  const std::uint64_t version = number_at(start.data() + kVersionAt, 4);
  if (version != kImageFileVersion) {
    refuse(file, kVersionAt,
           fmt::format(
               "version {}, expected {}: {}", version, kImageFileVersion,
               version > kImageFileVersion ? "made by a newer program" : "pack the scene again"));
  }
  const std::uint64_t length = number_at(start.data() + kLengthAt, 8);
  if (length != file.size_bytes()) {
    refuse(file, kLengthAt,
           fmt::format("the file has {} bytes, expected {}", file.size_bytes(), length));
  }
  std::vector<std::uint8_t> block(std::min<std::uint64_t>(length, 1 << 20));
  std::uint32_t checksum = 0;
  const std::uint64_t end = length - kChecksumBytes;
  for (std::uint64_t at = 0; at < end; at += block.size()) {
    const std::size_t size = std::min<std::uint64_t>(block.size(), end - at);
    file.read_at(at, block.data(), size);
    checksum = checksum_of(checksum, block.data(), size);
  }
  file.read_at(end, block.data(), kChecksumBytes);
  const auto expected = static_cast<std::uint32_t>(number_at(block.data(), kChecksumBytes));
  if (checksum != expected) {
    refuse(file, end,
           fmt::format("checksum: got {:08x}, expected {:08x}: the file was changed", checksum,
                       expected));
  }
  return checksum;
}

// Numbers that must fit each other.
void check_header(const InputFile& file, const ImageFileHeader& header, const Regions& regions) {
  const auto expect = [&](bool holds, const std::string& what, auto got,
                          const std::string& expected) {
    if (holds) return;
    throw InputError(
        fmt::format("{}: header: {}: got {}, expected {}", file.path(), what, got, expected));
  };
  expect(header.stored <= header.facts.gaussians, "stored Gaussians", header.stored,
         fmt::format("at most {}, as the scene has", header.facts.gaussians));
  const SecondHalfFormat widest = header.storage.widest_format(header.format.sh_degree);
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const std::uint32_t most = widest.entries[id], least = most > 0 && header.stored > 0 ? 1 : 0;
    const std::uint32_t entries = header.format.entries[id];
    expect(entries >= least && entries <= most,
           fmt::format("entries of codebook {}", kCodebookNames[id]), entries,
           fmt::format("{} to {}", least, most));
  }
  for (std::size_t id = 0; id < regions.size(); ++id) {
    const Region &got = header.regions[id], &expected = regions[static_cast<RegionId>(id)];
    expect(got.base == expected.base && got.bytes == expected.bytes, "region " + got.name,
           fmt::format("{} bytes at {}", got.bytes, got.base),
           fmt::format("{} at {}", expected.bytes, expected.base));
  }
}

// The header with its name; `end`: behind both.
ImageFileHeader read_header(const InputFile& file, std::size_t& end) {
  std::vector<std::uint8_t> bytes(kFirstFieldEnd);
  file.read_at(0, bytes.data(), bytes.size());
  StorageOrder order{};
  FieldReader(file.path(), bytes)("storage order", order, 0, kMostStorageOrder);

  end = number_at(bytes.data() + kHeaderBytesAt, 4);
  const std::size_t least = least_header_bytes(order);
  if (end < least || end > least + kMostNameBytes || end + kChecksumBytes > file.size_bytes()) {
    refuse(
        file, kHeaderBytesAt,
        fmt::format("a header of {} bytes, expected {} to {}", end, least, least + kMostNameBytes));
  }
  bytes.resize(end);
  file.read_at(0, bytes.data(), bytes.size());
  ImageFileHeader header = empty_header(order);
  FieldReader reader(file.path(), bytes);
  visit_fields(reader, header);
  header.facts.name.assign(bytes.begin() + static_cast<std::ptrdiff_t>(least), bytes.end());
  return header;
}

}  // namespace

PackedScene read_image_file(const std::string& path) {
  const InputFile file(path);
  PackedScene packed;
  packed.checksum = check_whole(file);
  std::size_t header_bytes = 0;
  ImageFileHeader header = read_header(file, header_bytes);
  packed.image.layout = layout_of(header);
  check_header(file, header, packed.image.layout.regions);

  const std::uint64_t bytes = packed.image.layout.stored_bytes;
  if (header_bytes + bytes + kChecksumBytes != file.size_bytes()) {
    refuse(file, header_bytes,
           fmt::format("an image of {} bytes, expected {}",
                       file.size_bytes() - kChecksumBytes - header_bytes, bytes));
  }
  packed.image.bytes.resize(bytes);
  file.read_at(header_bytes, packed.image.bytes.data(), bytes);
  packed.facts = std::move(header.facts);
  packed.storage = header.storage;
  return packed;
}

}  // namespace sgs
