// Reading of memory image files.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "algorithm/input_error.h"
#include "algorithm/input_file.h"
#include "algorithm/memory/image_file.h"
#include "algorithm/memory/image_file_fields.h"

namespace sgs {
namespace {

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
    if constexpr (std::is_same_v<T, float>) {
      const auto word = static_cast<std::uint32_t>(bits);
      std::memcpy(&value, &word, sizeof value);
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
  if (file.size_bytes() < least_header_bytes() + kChecksumBytes) {
    refuse(file, file.size_bytes(), "the file ends in its header, expected the rest of it");
  }
  const std::uint64_t version = number_at(start.data() + kVersionAt, 4);
  if (version != kImageFileVersion) {
    refuse(file, kVersionAt,
           fmt::format("version {}, expected {}{}", version, kImageFileVersion,
                       version > kImageFileVersion ? ": made by a newer program" : ""));
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
void check_layout(const InputFile& file, const PackedFacts& facts, const MemoryLayout& layout) {
  const auto expect = [&](bool holds, const char* what, auto got, const std::string& expected) {
    if (holds) return;
    throw InputError(
        fmt::format("{}: header: {}: got {}, expected {}", file.path(), what, got, expected));
  };
  expect(layout.gaussian_count <= facts.gaussians, "stored Gaussians", layout.gaussian_count,
         fmt::format("at most {}, as the scene has", facts.gaussians));
  const bool by_chunks = layout.storage_order == StorageOrder::kChunks;
  const auto only = [&](bool allowed, const char* what, std::uint64_t got) {
    expect(allowed || got == 0, what, got, by_chunks ? "0 by chunks" : "0 by voxels");
  };
  only(by_chunks, "most Gaussians in a chunk", facts.chunk_gaussians);
  only(by_chunks, "chunk nodes", layout.chunk_node_count);
  only(by_chunks, "chunks", layout.chunk_count);
  only(!by_chunks, "voxel nodes", layout.node_count);
  only(!by_chunks, "voxels", layout.voxel_count);
  expect(by_chunks == (layout.voxel_frame.voxel_size == 0), "voxel size",
         layout.voxel_frame.voxel_size, by_chunks ? "0 by chunks" : "more than 0 by voxels");
  expect(!by_chunks || facts.chunk_gaussians > 0, "most Gaussians in a chunk", 0, "at least 1");
  const SecondHalfFormat& format = layout.second_half;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const auto codebook = static_cast<Codebook>(id);
    const bool there = format.quantised() && (codebook != Codebook::kSh || format.sh_degree > 0);
    const std::uint32_t least = there && layout.gaussian_count > 0 ? 1 : 0;
    const std::uint32_t most = there ? facts.vq.entries(codebook) : 0;
    expect(format.entries[id] >= least && format.entries[id] <= most,
           fmt::format("entries of codebook {}", kCodebookNames[id]).c_str(), format.entries[id],
           fmt::format("{} to {}", least, most));
  }
  MemoryLayout placed = layout;
  place_regions(placed, 0, 0);
  for (std::size_t region = 0; region < kFileRegions; ++region) {
    const RegionRange &got = layout.regions[region], &expected = placed.regions[region];
    expect(got.base == expected.base && got.bytes == expected.bytes,
           fmt::format("region {}", kRegionNames[region]).c_str(),
           fmt::format("{} bytes at {}", got.bytes, got.base),
           fmt::format("{} at {}", expected.bytes, expected.base));
  }
}

}  // namespace

PackedScene read_image_file(const std::string& path) {
  const InputFile file(path);
  PackedScene packed;
  packed.checksum = check_whole(file);
  std::uint8_t word[4];
  file.read_at(kHeaderBytesAt, word, sizeof word);
  const std::uint64_t header_bytes = number_at(word, sizeof word), least = least_header_bytes();
  if (header_bytes < least || header_bytes > least + kMostNameBytes ||
      header_bytes + kChecksumBytes > file.size_bytes()) {
    refuse(file, kHeaderBytesAt,
           fmt::format("a header of {} bytes, expected {} to {}", header_bytes, least,
                       least + kMostNameBytes));
  }
  std::vector<std::uint8_t> header(header_bytes);
  file.read_at(0, header.data(), header.size());
  FieldReader reader(path, header);
  visit_fields(reader, packed.facts, packed.image.layout);
  packed.facts.name.assign(header.begin() + static_cast<std::ptrdiff_t>(least), header.end());
  check_layout(file, packed.facts, packed.image.layout);
  place_regions(packed.image.layout, 0, 0);

  const std::uint64_t bytes = packed.image.layout[Region::kSpill].base;
  if (header_bytes + bytes + kChecksumBytes != file.size_bytes()) {
    refuse(file, header_bytes,
           fmt::format("an image of {} bytes, expected {}",
                       file.size_bytes() - kChecksumBytes - header_bytes, bytes));
  }
  packed.image.bytes.resize(bytes);
  file.read_at(header_bytes, packed.image.bytes.data(), bytes);
  return packed;
}

}  // namespace sgs
