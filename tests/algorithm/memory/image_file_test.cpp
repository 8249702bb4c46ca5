// Memory image files: what is written comes back, what was changed is refused.
#include "algorithm/memory/image_file.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <functional>

#include "tests/algorithm/memory/packed_scenes.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

constexpr std::size_t kFixedHeader = 24;

void check_same_layout(const MemoryLayout& a, const MemoryLayout& b) {
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    CHECK(a.regions[region].base == b.regions[region].base);
    CHECK(a.regions[region].bytes == b.regions[region].bytes);
  }
  CHECK(a.storage_order == b.storage_order);
  CHECK(a.voxel_frame.voxel_size == b.voxel_frame.voxel_size);
  CHECK(a.voxel_frame.origin_cell == b.voxel_frame.origin_cell);
  CHECK(a.voxel_frame.levels == b.voxel_frame.levels);
  CHECK(a.node_count == b.node_count);
  CHECK(a.voxel_count == b.voxel_count);
  CHECK(a.chunk_node_count == b.chunk_node_count);
  CHECK(a.chunk_count == b.chunk_count);
  CHECK(a.gaussian_count == b.gaussian_count);
  CHECK(a.second_half.encoding == b.second_half.encoding);
  CHECK(a.second_half.sh_degree == b.second_half.sh_degree);
  CHECK(a.second_half.entries == b.second_half.entries);
}

void check_same_facts(const PackedFacts& a, const PackedFacts& b) {
  CHECK(a.name == b.name);
  CHECK(a.gaussians == b.gaussians);
  CHECK(a.dropped_invalid == b.dropped_invalid);
  CHECK(a.stored == b.stored);
  CHECK(a.chunk_gaussians == b.chunk_gaussians);
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    CHECK(a.vq.entries(static_cast<Codebook>(id)) == b.vq.entries(static_cast<Codebook>(id)));
  }
  CHECK(a.vq.iterations == b.vq.iterations);
  CHECK(a.vq.seed == b.vq.seed);
}

std::string refusal_of(const std::string& path) {
  const std::string message = input_error_of([&] { read_image_file(path); });
  CHECK_THAT(message, Contains(path));
  return message;
}

// A file of few Gaussians.
std::string small_file(const ScratchFolder& scratch) {
  const Packing packing =
      make_packing(cut_object(8, 1), SecondHalfEncoding::kVq, StorageOrder::kChunks);
  write_image_file(scratch.path("a.sgs"), packing.facts, packing.stored.image);
  return bytes_of(scratch.path("a.sgs"));
}

TEST_CASE("image file: every encoding in both orders comes back") {
  const ScratchFolder scratch;
  const std::string path = scratch.path("scene.sgs");
  for (const StorageOrder order : kStorageOrders) {
    for (const SecondHalfEncoding encoding : kEncodings) {
      for (int degree = 0; degree <= 3; ++degree) {
        CAPTURE(static_cast<int>(order), static_cast<int>(encoding), degree);
        Packing packing = make_packing(cut_object(300, degree), encoding, order);
        packing.facts.vq.seed = ~std::uint64_t{0};
        packing.facts.stored = degree == 2 ? Stored::kAll : Stored::kVisible;
        write_image_file(path, packing.facts, packing.stored.image);
        const PackedScene back = read_image_file(path);
        check_same_facts(back.facts, packing.facts);
        check_same_layout(back.image.layout, packing.stored.image.layout);
        CHECK(back.image.bytes == packing.stored.image.bytes);
      }
    }
  }
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("image file: an empty scene comes back, a long name is cut") {
  const ScratchFolder scratch;
  for (const StorageOrder order : kStorageOrders) {
    for (const SecondHalfEncoding encoding : kEncodings) {
      Packing packing = make_packing(ActivatedCloud{}, encoding, order);
      packing.facts.name = std::string(1000, 'n');
      write_image_file(scratch.path("a.sgs"), packing.facts, packing.stored.image);
      const PackedScene back = read_image_file(scratch.path("a.sgs"));
      CHECK(back.facts.name == std::string(kMostNameBytes, 'n'));
      CHECK(back.image.bytes.empty());
      check_same_layout(back.image.layout, packing.stored.image.layout);
    }
  }
}

TEST_CASE("image file: the first bytes are as documented") {
  const ScratchFolder scratch;
  const std::string bytes = small_file(scratch);
  CHECK(bytes.substr(0, 8) == "\x89SGS\r\n\x1a\n");
  CHECK(bytes.substr(8, 4) == std::string("\1\0\0\0", 4));
  std::uint64_t length = 0;
  std::uint32_t header_bytes = 0;
  std::memcpy(&header_bytes, bytes.data() + 12, 4);
  std::memcpy(&length, bytes.data() + 16, 8);
  CHECK(length == bytes.size());
  CHECK(bytes.substr(header_bytes - 6, 6) == "object");
}

TEST_CASE("image file: cut at any byte it is refused, and so is one with bytes behind") {
  const ScratchFolder scratch;
  const std::string path = scratch.path("a.sgs");
  const std::string bytes = small_file(scratch);
  std::filesystem::resize_file(path, bytes.size() + 1);
  CHECK_THAT(refusal_of(path), Contains("expected " + std::to_string(bytes.size())));
  for (std::size_t size = bytes.size(); size-- > 0;) {
    std::filesystem::resize_file(path, size);
    REQUIRE_THROWS_AS(read_image_file(path), InputError);
  }
}

TEST_CASE("image file: one flipped bit is refused wherever it is") {
  const ScratchFolder scratch;
  const std::string path = scratch.path("a.sgs");
  const std::string bytes = small_file(scratch);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto put = [&](std::size_t at, char byte) {
    file.seekp(static_cast<std::streamoff>(at));
    file.put(byte);
    file.flush();
  };
  constexpr std::size_t kHeader = 300;  // every bit; behind it one bit of each byte
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (std::size_t bit = 0; bit < 8; ++bit) {
      if (at >= kHeader && bit != at % 8) continue;
      put(at, static_cast<char>(bytes[at] ^ (1 << bit)));
      CAPTURE(at, bit);
      REQUIRE_THROWS_AS(read_image_file(path), InputError);
    }
    put(at, bytes[at]);
  }
  file.close();
  CHECK(read_image_file(path).facts.name == "object");
}

TEST_CASE("image file: foreign files, other versions, what is no file") {
  const ScratchFolder scratch;
  CHECK_THAT(refusal_of(scratch.write("a.sgs", "ply\nformat ascii 1.0\nend_header\n")),
             Contains("byte 0: not the magic number"));
  CHECK_THAT(refusal_of(scratch.write("empty.sgs", "")), Contains("not the magic number"));
  std::string bytes = small_file(scratch);
  bytes[8] = 2;
  CHECK_THAT(refusal_of(scratch.write("b.sgs", bytes)),
             Contains("byte 8: version 2, expected 1") && Contains("newer"));
  bytes[8] = 0;
  CHECK_THAT(refusal_of(scratch.write("b.sgs", bytes)), Contains("version 0, expected 1"));
  refusal_of(scratch.path("not_there.sgs"));
  refusal_of(scratch.path(""));
}

TEST_CASE("image file: the checksum's message says what was found") {
  const ScratchFolder scratch;
  std::string bytes = small_file(scratch);
  const std::uint32_t checksum = read_image_file(scratch.path("a.sgs")).checksum;
  std::uint32_t written = 0;
  std::memcpy(&written, bytes.data() + bytes.size() - 4, 4);
  CHECK(written == checksum);
  bytes[kFixedHeader] = static_cast<char>(bytes[kFixedHeader] ^ 1);
  CHECK_THAT(refusal_of(scratch.write("b.sgs", bytes)),
             Contains("byte " + std::to_string(bytes.size() - 4) + ": checksum"));
}

TEST_CASE("image file: a header whose numbers do not fit, with a right checksum, is refused") {
  const ScratchFolder scratch;
  const ActivatedCloud cloud = cut_object(60, 1);
  struct Change {
    StorageOrder order;
    const char* says;
    std::function<void(PackedFacts&, MemoryLayout&)> make;
  };
  using F = PackedFacts;
  using L = MemoryLayout;
  constexpr StorageOrder kVoxels = StorageOrder::kVoxels, kChunks = StorageOrder::kChunks;
  const std::vector<Change> changes = {
      {kChunks, "storage order: got 2", [](F&, L& l) { l.storage_order = StorageOrder(2); }},
      {kChunks, "encoding: got 4",
       [](F&, L& l) { l.second_half.encoding = SecondHalfEncoding(4); }},
      {kChunks, "SH degree: got 4", [](F&, L& l) { l.second_half.sh_degree = 4; }},
      {kChunks, "SH degree: got -1", [](F&, L& l) { l.second_half.sh_degree = -1; }},
      {kChunks, "region", [](F&, L& l) { l.second_half.sh_degree = 2; }},
      {kChunks, "stored Gaussians: got", [](F& f, L&) { f.gaussians = 5; }},
      {kChunks, "Gaussians in the scene: got", [](F& f, L&) { f.gaussians = 1ULL << 32; }},
      {kChunks, "expected 0 by chunks", [](F&, L& l) { l.voxel_count = 1; }},
      {kChunks, "voxel size", [](F&, L& l) { l.voxel_frame.voxel_size = 1; }},
      {kChunks, "at least 1", [](F& f, L&) { f.chunk_gaussians = 0; }},
      {kChunks, "got 65536", [](F& f, L&) { f.chunk_gaussians = 65536; }},
      {kChunks, "region", [](F&, L& l) { ++l.gaussian_count; }},
      {kChunks, "region", [](F&, L& l) { l.chunk_node_count = 0xffffffff; }},
      {kChunks, "codebook scale: got 0", [](F&, L& l) { l.second_half.entries[0] = 0; }},
      {kChunks, "codebook sh: got", [](F& f, L&) { f.vq.sh_entries = 1; }},
      {kChunks, "got 65537", [](F&, L& l) { l.second_half.entries[1] = 65537; }},
      {kChunks, "vq.iterations", [](F& f, L&) { f.vq.iterations = 1001; }},
      {kChunks, "region indices", [](F&, L& l) { l.regions[5].base += 4096; }},
      {kChunks, "region first_halves", [](F&, L& l) { l.regions[1].bytes = 1ULL << 60; }},
      {kVoxels, "expected 0 by voxels", [](F&, L& l) { l.chunk_count = 1; }},
      {kVoxels, "expected 0 by voxels", [](F& f, L&) { f.chunk_gaussians = 16; }},
      {kVoxels, "more than 0 by voxels", [](F&, L& l) { l.voxel_frame.voxel_size = 0; }},
      {kVoxels, "voxel size: got nan", [](F&, L& l) { l.voxel_frame.voxel_size = NAN; }},
      {kVoxels, "voxel size: got inf", [](F&, L& l) { l.voxel_frame.voxel_size = INFINITY; }},
      {kVoxels, "voxel levels: got 11", [](F&, L& l) { l.voxel_frame.levels = 11; }},
      {kVoxels, "voxel levels: got 0", [](F&, L& l) { l.voxel_frame.levels = 0; }},
      {kVoxels, "first cell, y", [](F&, L& l) { l.voxel_frame.origin_cell.y = -2000000000; }},
      {kVoxels, "region", [](F&, L& l) { ++l.node_count; }},
  };
  for (const Change& change : changes) {
    Packing packing = make_packing(cloud, SecondHalfEncoding::kVq, change.order);
    change.make(packing.facts, packing.stored.image.layout);
    INFO(change.says);
    write_image_file(scratch.path("a.sgs"), packing.facts, packing.stored.image);
    CHECK_THAT(refusal_of(scratch.path("a.sgs")), Contains(change.says));
  }
}

TEST_CASE("image file: an image of another size than its header says is refused") {
  const ScratchFolder scratch;
  Packing packing = make_packing(cut_object(8, 0), SecondHalfEncoding::kRaw, StorageOrder::kVoxels);
  packing.stored.image.bytes.resize(packing.stored.image.bytes.size() - 1);
  write_image_file(scratch.path("a.sgs"), packing.facts, packing.stored.image);
  CHECK_THAT(refusal_of(scratch.path("a.sgs")), Contains("an image of"));
}

TEST_CASE("image file: what cannot be written leaves nothing and keeps what was there") {
  const ScratchFolder scratch;
  const std::string bytes = small_file(scratch);
  const PackedScene packed = read_image_file(scratch.path("a.sgs"));
  CHECK_THROWS_AS(write_image_file(scratch.path("no/folder.sgs"), packed.facts, packed.image),
                  InputError);
  CHECK(scratch.file_count() == 1);
  write_image_file(scratch.path("a.sgs"), packed.facts, packed.image);
  CHECK(scratch.file_count() == 1);
  CHECK(bytes_of(scratch.path("a.sgs")) == bytes);
}

TEST_CASE("image file: known by its extension") {
  CHECK(is_image_file("a/b.sgs"));
  CHECK_FALSE(is_image_file("a/b.ply"));
  CHECK_FALSE(is_image_file("builtin:object?n=1.sgsx"));
  CHECK_FALSE(is_image_file(".sgs/scene"));
}

}  // namespace
}  // namespace sgs::test
