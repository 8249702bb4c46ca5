// Request traces as text: requests to the memory, to be replayed by tb_dram --replay.
//
// One request a line, of one of three forms, which the first request decides. Lines that begin with
// # are comments; one before the first request that names columns must name ours in their order.
//   ours      ADDRESS R|W [NANOSECONDS [BYTES]]      address in decimal or 0x hexadecimal
//   DRAMSys   CYCLE: [(BYTES)] read|write 0xADDRESS [0xDATA]      .stl; data are not used
//   DRAMsim3  0xADDRESS READ|WRITE CYCLE
// The time is that not before which a request is sent, and does not decrease.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sgs {

struct MemoryRequest {
  std::uint64_t address = 0;
  bool write = false;
  double not_before_ns = 0;  // 0: as soon as there is room
  std::uint32_t bytes = 0;   // 0: whoever sends it decides
};

struct RequestTrace {
  std::string form;  // whose, or empty: ours
  std::vector<MemoryRequest> requests;
};

// Cycles of traces that have them are `cycle_ns` long. Throws InputError with file and line for a
// line that is no request of the form.
RequestTrace read_request_trace(const std::string& path, double cycle_ns);

}  // namespace sgs
