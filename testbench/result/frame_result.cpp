#include "testbench/result/frame_result.h"

#include <cereal/archives/binary.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>

namespace sgs {

template <class Archive>
void serialize(Archive& a, Remedy& r) {
  a(r.key, r.turn);
}
template <class Archive>
void serialize(Archive& a, WaitResult& r) {
  a(r.what, r.at, r.other, r.remedy, r.cycles);
}
template <class Archive>
void serialize(Archive& a, ActivityResult& r) {
  a(r.name, r.resource, r.meaning, r.busy_cycles, r.waits, r.remedy);
}
template <class Archive>
void serialize(Archive& a, CounterResult& r) {
  a(r.name, r.unit, r.meaning, r.value);
}
template <class Archive>
void serialize(Archive& a, UnitResult& r) {
  a(r.name, r.activities, r.counters, r.may_help, r.charged);
}
template <class Archive>
void serialize(Archive& a, Operations& r) {
  a(r.component, r.kind, r.count);
}
template <class Archive>
void serialize(Archive& a, Parts& r) {
  a(r.component, r.kind, r.count, r.per_cycle);
}
template <class Archive>
void serialize(Archive& a, LeftOut& r) {
  a(r.what, r.why, r.count, r.saves);
}
template <class Archive>
void serialize(Archive& a, SramShape& r) {
  a(r.width_bits, r.ports, r.banks);
}
template <class Archive>
void serialize(Archive& a, SramPeak& r) {
  a(r.reads, r.writes);
}
template <class Archive>
void serialize(Archive& a, SramUse& r) {
  a(r.name, r.memory, r.bytes, r.arithmetic, r.count, r.shape, r.peak);
}
template <class Archive>
void serialize(Archive& a, OwnerResult& r) {
  a(r.owner, r.parts, r.sram_uses);
}
template <class Archive>
void serialize(Archive& a, SramAccesses& r) {
  a(r.use, r.reads, r.writes, r.seen);
}
template <class Archive>
void serialize(Archive& a, BesideLanes& r) {
  a(r.kind, r.operations, r.built_for);
}
template <class Archive>
void serialize(Archive& a, BetweenLanes& r) {
  a(r.registers, r.multiplexers, r.written, r.selected);
}
template <class Archive>
void serialize(Archive& a, DatapathLoop& r) {
  a(r.arrival, r.end);
}
template <class Archive>
void serialize(Archive& a, Datapath& r) {
  a(r.name, r.component, r.lane, r.lanes_of, r.lanes, r.copies, r.used_macs, r.counted_macs,
    r.published_macs, r.counts, r.beside, r.between, r.set_bits, r.depth_cycles, r.loops);
}
template <class Archive>
void serialize(Archive& a, DatapathResult& r) {
  a(r.datapath, r.items, r.busiest_cycles);
}
template <class Archive>
void serialize(Archive& a, PartValues& r) {
  a(r.name, r.unit, r.meaning, r.values);
}
template <class Archive>
void serialize(Archive& a, MachineResult& r) {
  a(r.units, r.operations, r.parts, r.left_out, r.sram_uses, r.owners, r.sram_available,
    r.sram_accesses, r.datapaths, r.by_part);
}
template <class Archive>
void serialize(Archive& a, RegionTraffic& r) {
  a(r.region, r.requester, r.read_bytes, r.written_bytes);
}
template <class Archive>
void serialize(Archive& a, MemoryState& r) {
  a(r.name, r.time_s, r.energy_j);
}
template <class Archive>
void serialize(Archive& a, MemoryResult& r) {
  a(r.bytes, r.bus_bytes, r.traffic, r.bus_bytes_by_region, r.transactions, r.row_hits,
    r.row_misses, r.row_conflicts, r.refreshes, r.bandwidth_gb_s, r.busy_bandwidth_gb_s,
    r.peak_gb_s, r.read_latency_mean_ns, r.read_latency_p50_ns, r.read_latency_p99_ns, r.channels,
    r.write_queue_entries, r.bus_utilisation, r.remedy, r.energy_j, r.energy_least_j,
    r.energy_most_j, r.energy_not_stated, r.energy_by_current_set_j, r.energy_by_region_j, r.states,
    r.commands);
}
template <class Archive>
void serialize(Archive& a, StreamedFrame& r) {
  a(r.pose_s, r.begun_s, r.drawn_s, r.shown_s, r.buffer_wait_s);
}
template <class Archive>
void serialize(Archive& a, FrameResult& r);
template <class Archive>
void serialize(Archive& a, StreamResult& r) {
  a(r.frames, r.pictures, r.repeated, r.rows_late, r.first_and_last_shown);
}
template <class Archive>
void serialize(Archive& a, FrameResult& r) {
  a(r.cycles, r.rest_cycles, r.clock_mhz, r.drained, r.machine, r.memory, r.frame, r.right_frame,
    r.stream, r.wall_s);
}

double MemoryResult::time_in_s(const std::string& state) const {
  double sum = 0;
  for (const MemoryState& of : states) sum += of.name == state ? of.time_s : 0;
  return sum;
}

std::string to_wire(const FrameResult& result) {
  std::ostringstream out;
  cereal::BinaryOutputArchive archive(out);
  archive(result);
  return out.str();
}

FrameResult from_wire(const std::string& bytes) {
  std::istringstream in(bytes);
  cereal::BinaryInputArchive archive(in);
  FrameResult result;
  archive(result);
  return result;
}

}  // namespace sgs
