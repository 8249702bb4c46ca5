// Memory image files: what is written comes back, what was changed is refused.
#include "algorithm/storage/image_file.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <tuple>

#include "algorithm/storage/image_file_fields.h"
#include "tests/algorithm/storage/packed_scenes.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

void check_same(const RecordArray& a, const RecordArray& b) {
  CHECK(a.region == b.region);
  CHECK(a.base == b.base);
  CHECK(a.record_bytes == b.record_bytes);
  CHECK(a.count == b.count);
}

void check_same_table(const VoxelTableLayout& a, const VoxelTableLayout& b) {
  check_same(a.nodes, b.nodes);
  check_same(a.voxels, b.voxels);
  CHECK(a.frame.voxel_size == b.frame.voxel_size);
  CHECK(a.frame.origin_cell == b.frame.origin_cell);
  CHECK(a.frame.levels == b.frame.levels);
}
void check_same_table(const ChunkTableLayout& a, const ChunkTableLayout& b) {
  check_same(a.nodes, b.nodes);
  CHECK(a.chunk_count == b.chunk_count);
}
void check_same_table(const NoTableLayout&, const NoTableLayout&) {}
template <class A, class B>
void check_same_table(const A&, const B&) {
  FAIL("tables of different orders");
}

void check_same(const SceneLayout& a, const SceneLayout& b) {
  REQUIRE(a.regions.size() == b.regions.size());
  for (std::size_t id = 0; id < a.regions.size(); ++id) {
    const Region &ours = a.regions[static_cast<RegionId>(id)],
                 &theirs = b.regions[static_cast<RegionId>(id)];
    CHECK(ours.name == theirs.name);
    CHECK(ours.base == theirs.base);
    CHECK(ours.bytes == theirs.bytes);
  }
  check_same(a.first_halves, b.first_halves);
  check_same(a.second_halves, b.second_halves);
  CHECK(a.stored_bytes == b.stored_bytes);
  CHECK(a.second_half.encoding == b.second_half.encoding);
  CHECK(a.second_half.sh_degree == b.second_half.sh_degree);
  CHECK(a.second_half.entries == b.second_half.entries);
  REQUIRE(a.order() == b.order());
  std::visit([](const auto& ours, const auto& theirs) { check_same_table(ours, theirs); }, a.table,
             b.table);
}

void check_same(const StorageConfig& a, const StorageConfig& b) {
  CHECK(a.order == b.order);
  CHECK(a.encoding == b.encoding);
  CHECK(a.voxel_size == b.voxel_size);
  CHECK(a.chunk_gaussians == b.chunk_gaussians);
  CHECK(a.sequence == b.sequence);
  CHECK(a.store_invisible == b.store_invisible);
  CHECK(a.sh_tolerance == b.sh_tolerance);
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    CHECK(a.vq.entries(static_cast<Codebook>(id)) == b.vq.entries(static_cast<Codebook>(id)));
  }
  CHECK(a.vq.iterations == b.vq.iterations);
  CHECK(a.vq.seed == b.vq.seed);
}

void check_same(const PackedFacts& a, const PackedFacts& b) {
  CHECK(a.name == b.name);
  CHECK(a.gaussians == b.gaussians);
  CHECK(a.dropped_invalid == b.dropped_invalid);
  CHECK(a.sh_bands_left_out == b.sh_bands_left_out);
}

void write(const std::string& path, const Packing& packing) {
  write_image_file(path, packing.facts, packing.stored.storage, packing.stored.image);
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
  write(scratch.path("a.sgs"), packing);
  return bytes_of(scratch.path("a.sgs"));
}

TEST_CASE("image file: every encoding in every order comes back") {
  const ScratchFolder scratch;
  const std::string path = scratch.path("scene.sgs");
  for (const StorageOrder order : kStorageOrders) {
    for (const SecondHalfEncoding encoding : kEncodings) {
      for (int degree = 0; degree <= 3; ++degree) {
        CAPTURE(static_cast<int>(order), static_cast<int>(encoding), degree);
        Packing packing = make_packing(cut_object(300, degree), encoding, order);
        packing.stored.storage.vq.seed = ~std::uint64_t{0};
        packing.stored.storage.store_invisible = degree == 2;
        if (order == StorageOrder::kFile && degree % 2 == 0) {
          packing.stored.storage.sequence = FileSequence::kSpatial;
        }
        packing.stored.storage.sh_tolerance = 0.01 * degree;
        packing.facts.sh_bands_left_out = 3 - degree;
        write(path, packing);
        const PackedScene back = read_image_file(path);
        check_same(back.facts, packing.facts);
        check_same(back.storage, packing.stored.storage);
        check_same(back.image.layout, packing.stored.image.layout);
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
      write(scratch.path("a.sgs"), packing);
      const PackedScene back = read_image_file(scratch.path("a.sgs"));
      CHECK(back.facts.name == std::string(kMostNameBytes, 'n'));
      CHECK(back.image.bytes.empty());
      check_same(back.image.layout, packing.stored.image.layout);
    }
  }
}

TEST_CASE("image file: the first bytes are as documented") {
  const ScratchFolder scratch;
  const std::string bytes = small_file(scratch);
  CHECK(bytes.substr(0, 8) == "\x89SGS\r\n\x1a\n");
  CHECK(bytes.substr(8, 4) == std::string("\5\0\0\0", 4));
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
  bytes[8] = 6;
  CHECK_THAT(refusal_of(scratch.write("b.sgs", bytes)),
             Contains("byte 8: version 6, expected 5: made by a newer program"));
  bytes[8] = 4;
  CHECK_THAT(refusal_of(scratch.write("b.sgs", bytes)),
             Contains("version 4, expected 5: pack the scene again"));
  refusal_of(scratch.path("not_there.sgs"));
  refusal_of(scratch.path(""));
}

// Writes the header of a file anew, with a right length and checksum.
void rewrite(const std::string& path, std::string bytes) {
  bytes.resize(bytes.size() - kChecksumBytes);
  const std::uint64_t length = bytes.size() + kChecksumBytes;
  std::memcpy(bytes.data() + kLengthAt, &length, sizeof length);
  const std::uint32_t checksum = checksum_of(0, bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST_CASE("image file: a header whose numbers do not fit, with a right checksum, is refused") {
  const ScratchFolder scratch;
  const std::string path = scratch.path("a.sgs");
  const ActivatedCloud cloud = cut_object(60, 1);
  constexpr StorageOrder kVoxels = StorageOrder::kVoxels, kChunks = StorageOrder::kChunks;
  constexpr StorageOrder kFile = StorageOrder::kFile;
  using H = ImageFileHeader;
  const auto voxels = [](H& h) -> VoxelTableLayout& { return std::get<VoxelTableLayout>(h.table); };
  const auto chunks = [](H& h) -> ChunkTableLayout& { return std::get<ChunkTableLayout>(h.table); };
  struct Change {
    StorageOrder order;
    const char* says;
    std::function<void(H&)> make;
  };
  const auto put = [](std::string& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
    std::memcpy(bytes.data() + at, &value, size);
  };
  const std::vector<Change> changes = {
      {kChunks, "encoding: got 4", [](H& h) { h.storage.encoding = SecondHalfEncoding(4); }},
      {kChunks, "SH degree: got 4", [](H& h) { h.format.sh_degree = 4; }},
      {kChunks, "SH degree: got -1", [](H& h) { h.format.sh_degree = -1; }},
      {kChunks, "region", [](H& h) { h.format.sh_degree = 2; }},
      {kChunks, "stored Gaussians: got", [](H& h) { h.facts.gaussians = 5; }},
      {kChunks, "Gaussians in the scene: got", [](H& h) { h.facts.gaussians = 1ULL << 32; }},
      {kChunks, "chunk_gaussians: got 0", [](H& h) { h.storage.chunk_gaussians = 0; }},
      {kChunks, "chunk_gaussians: got 65536", [](H& h) { h.storage.chunk_gaussians = 65536; }},
      {kChunks, "region", [](H& h) { ++h.stored; }},
      {kChunks, "region chunk_table", [&](H& h) { chunks(h).nodes.count = 0xffffffff; }},
      {kChunks, "codebook scale: got 0", [](H& h) { h.format.entries[0] = 0; }},
      {kChunks, "codebook sh: got", [](H& h) { h.storage.vq.sh_entries = 1; }},
      {kChunks, "got 65537", [](H& h) { h.format.entries[1] = 65537; }},
      {kChunks, "codebook scale: got", [](H& h) { h.storage.encoding = SecondHalfEncoding::kRaw; }},
      {kChunks, "vq.iterations: got 1001", [](H& h) { h.storage.vq.iterations = 1001; }},
      {kChunks, "vq.dc_entries: got 0", [](H& h) { h.storage.vq.dc_entries = 0; }},
      {kChunks, "region chunk_table", [](H& h) { h.regions[3].base += 4096; }},
      {kChunks, "region first_halves", [](H& h) { h.regions[0].bytes = 1ULL << 60; }},
      {kVoxels, "voxel_size: got 0", [](H& h) { h.storage.voxel_size = 0; }},
      {kVoxels, "voxel_size: got nan", [](H& h) { h.storage.voxel_size = NAN; }},
      {kVoxels, "voxel_size: got inf", [](H& h) { h.storage.voxel_size = INFINITY; }},
      {kVoxels, "voxel_size: got 1e+60", [](H& h) { h.storage.voxel_size = 1e60; }},
      {kVoxels, "voxel_size: got 1e-60", [](H& h) { h.storage.voxel_size = 1e-60; }},
      {kVoxels, "voxel levels: got 11", [&](H& h) { voxels(h).frame.levels = 11; }},
      {kVoxels, "voxel levels: got 0", [&](H& h) { voxels(h).frame.levels = 0; }},
      {kVoxels, "first cell, y", [&](H& h) { voxels(h).frame.origin_cell.y = -2000000000; }},
      {kVoxels, "region voxel_table", [&](H& h) { ++voxels(h).nodes.count; }},
      {kVoxels, "region voxel_table", [&](H& h) { ++voxels(h).voxels.count; }},
      {kVoxels, "region voxel_table", [](H& h) { h.regions[0].base = 1; }},
      {kFile, "region first_halves", [](H& h) { ++h.stored; }},
      {kFile, "sequence: got 2", [](H& h) { h.storage.sequence = FileSequence(2); }},
      {kFile, "region codebooks", [](H& h) { h.regions[2].bytes += 4; }},
  };
  for (const Change& change : changes) {
    const Packing packing = make_packing(cloud, SecondHalfEncoding::kVq, change.order);
    ImageFileHeader header =
        header_of(packing.facts, packing.stored.storage, packing.stored.image.layout);
    change.make(header);
    INFO(change.says);
    write_image_file(path, header, packing.stored.image.bytes);
    CHECK_THAT(refusal_of(path), Contains(change.says));
  }
  const std::string bytes = small_file(scratch);
  for (const auto& [at, value, says] :
       {std::tuple<std::size_t, std::uint64_t, const char*>{kFieldsAt, 3, "storage order: got 3"},
        {kFieldsAt, 0, "a header of"},  // by chunks it is shorter than by voxels
        {kHeaderBytesAt, 24, "a header of 24 bytes"},
        {kHeaderBytesAt, 1000, "a header of 1000 bytes"},
        {kHeaderBytesAt, 0xffffffff, "a header of 4294967295 bytes"}}) {
    std::string changed = bytes;
    put(changed, at, value, 4);
    INFO(says);
    rewrite(path, changed);
    CHECK_THAT(refusal_of(path), Contains(says));
  }
}

TEST_CASE("image file: an image of another size than its header says is refused") {
  const ScratchFolder scratch;
  Packing packing = make_packing(cut_object(8, 0), SecondHalfEncoding::kRaw, StorageOrder::kVoxels);
  packing.stored.image.bytes.resize(packing.stored.image.bytes.size() - 1);
  write(scratch.path("a.sgs"), packing);
  CHECK_THAT(refusal_of(scratch.path("a.sgs")), Contains("an image of"));
}

TEST_CASE("image file: what cannot be written leaves nothing and keeps what was there") {
  const ScratchFolder scratch;
  const std::string bytes = small_file(scratch);
  const PackedScene packed = read_image_file(scratch.path("a.sgs"));
  CHECK_THROWS_AS(
      write_image_file(scratch.path("a.sgs/b.sgs"), packed.facts, packed.storage, packed.image),
      InputError);
  CHECK(scratch.file_count() == 1);
  write_image_file(scratch.path("a.sgs"), packed.facts, packed.storage, packed.image);
  CHECK(scratch.file_count() == 1);
  CHECK(bytes_of(scratch.path("a.sgs")) == bytes);
}

}  // namespace
}  // namespace sgs::test
