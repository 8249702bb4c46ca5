// Request traces as text: requests to the memory, to be replayed by tb_dram --replay.
//
// One request a line, "ADDRESS R|W [NANOSECONDS [BYTES]]": address in decimal or 0x hexadecimal,
// the time not before which it is sent, not decreasing. Lines that begin with # are comments.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/files/output_file.h"

namespace sgs {

struct MemoryRequest {
  std::uint64_t address = 0;
  bool write = false;
  double not_before_ns = 0;  // 0: as soon as there is room
  std::uint32_t bytes = 0;   // 0: whoever sends it decides
};

// Throws InputError with file and line for a line that is no request.
std::vector<MemoryRequest> read_request_trace(const std::string& path);

class RequestTraceWriter {
 public:
  // Writes to `to`, which whoever made it commits.
  explicit RequestTraceWriter(OutputFile& to);

  void add(const MemoryRequest& request);

 private:
  OutputFile& to_;
};

}  // namespace sgs
