// The adjacency table of a sampling VSU (StreamingGS, DAC 2025): lines of edges, each with its
// source as tag and the destinations as value. It is a cache of one way: a line that another needs
// the place of goes to DRAM, and comes back when its source is met again.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <systemc>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/order/ordering_table.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"

namespace sgs {

// A destination is the number of a voxel in the ordering table.
constexpr std::uint32_t kDestinationBytes = 2;
// Source, which of its lines, destinations in it, whether DRAM has them as they are.
constexpr std::uint32_t kAdjacencyTagBytes = 4;

class AdjacencyCache {
 public:
  explicit AdjacencyCache(const PaperVsuConfig& config, const RegionSpan& area)
      : destinations_(config.adjacency_destinations),
        area_(area),
        places_(config.adjacency_lines) {}

  static std::uint32_t line_bytes(const PaperVsuConfig& config) {
    return kDestinationBytes * config.adjacency_destinations;
  }
  // Room for the lines of all voxels that the ordering table holds.
  static std::uint64_t area_bytes(const PaperVsuConfig& config) {
    return OrderingTable::most_voxels(config.table_bytes) * kMostAdjacencyLines *
           apart_in_memory(line_bytes(config));
  }

  // Frees all places. Each is a tag to write, and so is one that is freed alone.
  void clear() { places_.assign(places_.size(), Place()); }
  // Frees the place of a line that is there and not used any more; its edges are forgotten.
  void free(std::uint32_t source, std::uint32_t line) { places_[place_of(source, line)] = {}; }

  // Whether a source's line 0, 1, ... is there.
  bool holds(std::uint32_t source, std::uint32_t line) const {
    const Place& place = places_[place_of(source, line)];
    return place.taken && place.source == source && place.line == line;
  }

  // Makes a line that is not there present: another may have to leave the place to it. values: what
  // is in the line; empty where it is new. Blocks the calling thread until it is there.
  void bring(std::uint32_t source, std::uint32_t line, const std::vector<std::uint32_t>& values,
             MemoryPort& port, Activity& activity) {
    Place& place = places_[place_of(source, line)];
    if (place.taken && place.changed) {
      pack(place.values, bytes_);
      ++lines_out_;
      start_write(port, activity, address(place.source, place.line), bytes_.data(), bytes(),
                  area_.region);
    }
    if (!values.empty()) read_back(source, line, values, port, activity);
    place = {true, false, source, line, values};
  }
  // Reads a line that is not there past the table, which keeps what it has.
  void read_back(std::uint32_t source, std::uint32_t line, const std::vector<std::uint32_t>& values,
                 MemoryPort& port, Activity& activity) {
    ++lines_back_;
    if (port.writing()) await_all(port, activity);  // it may be among them
    std::vector<std::byte> come(bytes()), expected;
    await(port, activity,
          start_read(port, activity, address(source, line), come.data(), bytes(), area_.region));
    pack(values, expected);
    if (come == expected) return;
    SC_REPORT_ERROR(
        "/sgs/vsu",
        fmt::format("line {} of voxel {} came back with other edges", line, source).c_str());
  }
  // What is in a line that is there from now on.
  void change(std::uint32_t source, std::uint32_t line, const std::vector<std::uint32_t>& values) {
    Place& place = places_[place_of(source, line)];
    place.values = values;
    place.changed = true;
  }

  std::uint64_t lines_out() const { return lines_out_; }
  std::uint64_t lines_back() const { return lines_back_; }

 private:
  struct Place {
    bool taken = false, changed = false;
    std::uint32_t source = 0, line = 0;
    std::vector<std::uint32_t> values;
  };

  // No line lies in more bursts than it has to.
  static std::uint64_t apart_in_memory(std::uint32_t bytes) {
    std::uint64_t apart = kDestinationBytes;
    while (apart < bytes) apart *= 2;
    return apart;
  }
  std::uint32_t bytes() const { return kDestinationBytes * destinations_; }
  // Second lines lie far from the first ones.
  std::size_t place_of(std::uint32_t source, std::uint32_t line) const {
    return (source + places_.size() / kMostAdjacencyLines * line) % places_.size();
  }
  std::uint64_t address(std::uint32_t source, std::uint32_t line) const {
    return area_.base +
           (std::uint64_t{source} * kMostAdjacencyLines + line) * apart_in_memory(bytes());
  }
  void pack(const std::vector<std::uint32_t>& values, std::vector<std::byte>& into) const {
    into.assign(bytes(), std::byte{0});
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto number = static_cast<std::uint16_t>(values[i]);
      std::memcpy(into.data() + i * kDestinationBytes, &number, kDestinationBytes);
    }
  }

  const std::uint32_t destinations_;
  const RegionSpan area_;
  std::vector<Place> places_;
  std::vector<std::byte> bytes_;  // of the line that leaves
  std::uint64_t lines_out_ = 0, lines_back_ = 0;
};

}  // namespace sgs
