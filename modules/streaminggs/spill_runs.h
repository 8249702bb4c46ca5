// Sorted runs in the spill region of the DRAM: written block by block, read back with the next
// block on its way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "tlm/memory_access.h"

namespace sgs {

struct SpillRun {
  std::uint64_t address = 0;
  std::uint64_t entries = 0;
};

// Port, region and block size for spilled entries.
struct SpillPort {
  MemoryPort& port;
  Activity& activity;
  std::uint32_t block_entries;
  RegionId region;
};

// Codec: `Entry` is the entry of a run, bytes() its size in DRAM, encode(entry, bytes) and
// decode(bytes) go between the two.
template <class Codec>
class SpillWriter {
 public:
  SpillWriter(SpillPort to, std::uint64_t address, Codec codec)
      : to_(to), codec_(codec), run_{address, 0} {}

  void append(const typename Codec::Entry& entry) {
    block_.resize(block_.size() + codec_.bytes());
    codec_.encode(entry, block_.data() + block_.size() - codec_.bytes());
    ++run_.entries;
    if (block_.size() == std::size_t{to_.block_entries} * codec_.bytes()) flush();
  }

  // Sends what is left and returns the run; its bytes are in DRAM once the port is drained.
  SpillRun finish() {
    if (!block_.empty()) flush();
    return run_;
  }

 private:
  void flush() {
    start_write(to_.port, to_.activity, run_.address + written_, block_.data(),
                static_cast<std::uint32_t>(block_.size()), to_.region);
    written_ += block_.size();
    block_.clear();
  }

  SpillPort to_;
  Codec codec_;
  SpillRun run_;
  std::uint64_t written_ = 0;
  std::vector<std::byte> block_;
};

// A run whose entries come in the opposite order, the last one first: written from its back.
template <class Codec>
class ReverseSpillWriter {
 public:
  // run: its bytes are in DRAM once all entries are appended and the port is drained.
  ReverseSpillWriter(SpillPort to, const SpillRun& run, Codec codec)
      : to_(to), codec_(codec), run_(run), next_(run.entries) {}

  // Blocks lie as SpillReader reads them; each goes when its first entry has come.
  void append(const typename Codec::Entry& entry) {
    --next_;
    const std::size_t at = next_ % to_.block_entries * codec_.bytes();
    if (block_.empty()) block_.resize(at + codec_.bytes());
    codec_.encode(entry, block_.data() + at);
    if (at > 0) return;
    start_write(to_.port, to_.activity, run_.address + next_ * codec_.bytes(), block_.data(),
                static_cast<std::uint32_t>(block_.size()), to_.region);
    block_.clear();
  }

 private:
  SpillPort to_;
  Codec codec_;
  SpillRun run_;
  std::uint64_t next_;  // entries that are still to come
  std::vector<std::byte> block_;
};

template <class Codec>
class SpillReader {
 public:
  SpillReader(SpillPort from, const SpillRun& run, Codec codec)
      : from_(from), codec_(codec), run_(run) {
    for (Block& block : blocks_) {
      block.bytes.resize(std::size_t{from.block_entries} * codec_.bytes());
      request(block);
    }
    load();
  }

  bool exhausted() const { return left() == 0; }
  std::uint64_t left() const { return run_.entries - taken_; }  // entries not yet taken
  const typename Codec::Entry& front() const { return front_; }

  void pop() {
    ++taken_;
    if (exhausted()) return;
    if (taken_ % from_.block_entries == 0) {
      request(blocks_[current_]);
      current_ ^= 1U;
    }
    load();
  }

 private:
  struct Block {
    std::vector<std::byte> bytes;
    MemoryPort::Ticket ticket = 0;
  };

  void request(Block& block) {
    const std::uint64_t left = run_.entries - requested_;
    const auto count =
        static_cast<std::uint32_t>(left < from_.block_entries ? left : from_.block_entries);
    if (count == 0) return;
    block.ticket =
        start_read(from_.port, from_.activity, run_.address + requested_ * codec_.bytes(),
                   block.bytes.data(), count * codec_.bytes(), from_.region);
    requested_ += count;
  }

  void load() {
    Block& block = blocks_[current_];
    await(from_.port, from_.activity, block.ticket);
    front_ = codec_.decode(block.bytes.data() + taken_ % from_.block_entries * codec_.bytes());
  }

  SpillPort from_;
  Codec codec_;
  SpillRun run_;
  Block blocks_[2];
  std::uint32_t current_ = 0;
  std::uint64_t requested_ = 0, taken_ = 0;
  typename Codec::Entry front_{};
};

}  // namespace sgs
