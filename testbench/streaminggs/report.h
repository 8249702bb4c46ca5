// The report of one simulated view, and of all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "algorithm/memory/memory_image.h"
#include "algorithm/render/streaming_result.h"
#include "testbench/streaminggs/frame_run.h"

namespace sgs {

// What a view's report is made of.
struct ViewFacts {
  std::string scene;
  int view = 0;
  Image frame;              // as read back from the modelled DRAM
  Image reference;          // of the scene as given
  Image decoded_reference;  // of the scene as encoded
  StreamingResult golden;
  bool equals_golden = false;  // bytes of the frame buffer against the streaming renderer's
  FrameRun run;
  std::uint64_t image_hash = 0;  // of the bytes loaded into the memory
  MemoryLayout layout;
  std::uint64_t gaussians = 0;  // in the scene
  std::uint64_t dropped_invalid = 0;
  FrameFormat frame_format = FrameFormat::kRgb8;
};

// report.json of a view (README, "What the report says").
nlohmann::ordered_json view_report(const ViewFacts& facts, const AcceleratorConfig& config);

// A line of the table on the terminal, and its head.
void print_table_head();
void print_table_line(const nlohmann::ordered_json& report);
// What stands below the table for a view: bytes by region, binding unit.
void print_details(const nlohmann::ordered_json& report);

}  // namespace sgs
