// A visitor of the ports.
#include "testbench/result/memory_path.h"

#include <utility>

namespace sgs {
namespace {

class Paths : public DataSheet {
 public:
  void port(MemoryPort& port, const char*) override {
    constexpr double kDirections = 2, kByteBits = 8;
    const MemoryPortConfig& config = port.config();
    const double bits = kDirections * kByteBits * config.width_bytes;
    const double moved = kByteBits * static_cast<double>(port.bytes_read() + port.bytes_written());
    wide += bits;
    passed += moved;
    registers += bits * config.path_cycles;
    registered += moved * config.path_cycles;
  }
  double wide = 0, passed = 0;           // bits of all ports, and through them
  double registers = 0, registered = 0;  // the same of the stages
};

}  // namespace

void add_memory_path(Machine& machine, std::uint32_t channels, MachineResult& result) {
  constexpr const char* kComponent = "memory_path";
  Paths paths;
  machine.publish(paths);
  if (paths.wide == 0) return;
  OwnerResult owner{kComponent, {}, {}};
  if (paths.registers > 0) {
    owner.parts.push_back({kComponent, "register_bit", paths.registers, paths.registers});
    result.operations.push_back({kComponent, "register_bit", paths.registered});
  }
  // A bit passes one of its channels' multiplexers.
  owner.parts.push_back({kComponent, "crossbar_bit", channels * paths.wide, paths.wide});
  result.operations.push_back({kComponent, "crossbar_bit", paths.passed});
  result.parts.insert(result.parts.end(), owner.parts.begin(), owner.parts.end());
  result.owners.push_back(std::move(owner));
}

}  // namespace sgs
