// Fetch unit of the toy machine: streams blocks of first halves from the memory and makes a colour
// of each. Timing: a block is asked for in one cycle; a Gaussian is added up in one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/frame_job.h"
#include "tests/testbench/toy_machine/toy_config.h"
#include "tests/testbench/toy_machine/toy_picture.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs::toy {

struct GroupColour {
  static constexpr std::uint32_t kSramBytes = 16;
  std::uint32_t group = 0;
  glm::vec3 colour{0};
};

class FetchUnit : public sc_core::sc_module {
 public:
  FifoOut<GroupColour> colours{"colours"};
  MemoryPort memory;

  SC_HAS_PROCESS(FetchUnit);
  FetchUnit(const sc_core::sc_module_name& name, const ToyConfig& config, const ClockDomain& clock,
            const FrameJob& job);

  static SramUses sram_uses(const ToyConfig& config);
  void publish(DataSheet& sheet);

 private:
  struct Fetched {
    static constexpr std::uint32_t kSramBytes = 12;  // group, first, count: slots are used in turn
    std::uint32_t group = 0;
    Block block;
    std::uint64_t ticket = 0;
    std::uint32_t slot = 0;  // of the buffer
  };

  void run_ask();  // thread
  void run_add();  // thread
  std::byte* slot(std::uint32_t number);

  const ToyConfig config_;
  const FrameJob& job_;
  Activity ask_, add_;
  std::vector<std::byte> buffer_;  // [buffer_blocks, block_gaussians] first halves
  TimedFifo<Fetched> fetched_;
  TimedFifo<std::uint32_t> free_slots_;
  struct Counters : CounterSet {
    Counter gaussians{*this, "gaussians", "Gaussians", "fetched and added up"};
  } counters_;
  std::uint32_t current_group_ = 0;  // for the waveform
};

}  // namespace sgs::toy
