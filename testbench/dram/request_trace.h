// Request traces: one request a line, "ADDRESS R|W [NANOSECONDS]", addresses in decimal or 0x
// hexadecimal, times not decreasing; lines that begin with # are comments.
#pragma once

#include <string>
#include <vector>

#include "testbench/dram/request_generator.h"

namespace sgs {

// InputError with file and line for what is no request.
std::vector<MemoryRequest> read_request_trace(const std::string& path);

}  // namespace sgs
