// Sections of the memory: its traffic, and what its interface rests on.
#include "testbench/streaminggs/report/report_sections.h"

namespace sgs {
namespace {

void visit_traffic(ReportVisitor& r, const MemoryResult& m) {
  r.object("bytes_by_region", [&] {
    r.each(m.traffic, [&](const RegionTraffic& t) {
      r.object({"REGION", t.region}, [&] {
        r.object({"REQUESTER", t.requester}, [&] {
          if (r.has(t.read_bytes > 0)) {
            r("read", "B", "Bytes requested by reads; none where it is 0.", t.read_bytes);
          }
          if (r.has(t.written_bytes > 0)) {
            r("write", "B", "Bytes requested by writes; none where it is 0.", t.written_bytes);
          }
        });
      });
    });
  });
  r.object("bus_bytes_by_region", [&] {
    r.each(m.bus_bytes_by_region, [&](const auto& region_and_bytes) {
      r({"REGION", region_and_bytes.first}, "B", "Bytes on the bus for this region.",
        region_and_bytes.second);
    });
  });
}

}  // namespace

void visit_dram(ReportVisitor& r, const MemoryResult& m) {
  r("bytes", "B", "Bytes that units requested.", m.bytes);
  r("bus_bytes", "B",
    "Bytes on the bus, in whole bursts. Fewer than requested where the write queue answers reads.",
    m.bus_bytes);
  visit_traffic(r, m);
  r("transactions", "", "TLM-2.0 transactions of the units.", m.transactions);
  r("row_hits", "bursts", "Bursts that found their row open.", m.row_hits);
  r("row_misses", "bursts", "Bursts that found their bank closed.", m.row_misses);
  r("row_conflicts", "bursts", "Bursts that found another row open.", m.row_conflicts);
  r("refreshes", "commands", "Refresh commands, of all banks or of one.", m.refreshes);
  r("bandwidth_gb_s", "10^9 B/s", "`dram.bytes` over the frame time.", m.bandwidth_gb_s);
  r("busy_bandwidth_gb_s", "10^9 B/s",
    "`dram.bytes` over the time in which the controller has a request.", m.busy_bandwidth_gb_s);
  r("peak_gb_s", "10^9 B/s", "Width times data rate of all channels.", m.peak_gb_s);
  r("of_peak", "0..1", "`dram.bandwidth_gb_s` over `dram.peak_gb_s`.",
    m.bandwidth_gb_s / m.peak_gb_s);
  r("read_latency_mean_ns", "ns",
    "Mean time of a read, from its arrival at the controller to its last datum.",
    m.read_latency_mean_ns);
  r("read_latency_p50_ns", "ns", "Median of the same time.", m.read_latency_p50_ns);
  r("read_latency_p99_ns", "ns", "Time that 99 of 100 reads do not exceed.", m.read_latency_p99_ns);
}

void visit_memory_interface(ReportVisitor& r, const MemoryInterface& interface) {
  r("memspec", "", "Name of the memory: its memspec's.", interface.memspec);
  r("area_of", "",
    "Memory whose PHY and controller are counted: how the names of its memspecs begin.",
    interface.area_of);
  r("area_known", "bool", "That is this memory: area and power of its interface are known.",
    interface.area_known);
  r("area_source", "", "Source of area and power of PHY and controller, by the technology table.",
    interface.area_source);
  r("io_pj_per_bit", "pJ", "I/O energy of a transferred bit, part of `energy.dram_j`.",
    interface.io_pj_per_bit);
  r("io_source", "", "Source of that: the memspec's, or `dram.io_pj_per_bit` where that is given.",
    interface.io_source);
}

}  // namespace sgs
