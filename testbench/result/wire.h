// A frame's result as bytes, from the process that simulates to the one that reports.
#pragma once

#include <string>

#include "testbench/result/frame_result.h"

namespace sgs {

std::string to_wire(const FrameResult& result);
// Reads the bytes that to_wire() made in the same build.
FrameResult from_wire(const std::string& bytes);

}  // namespace sgs
