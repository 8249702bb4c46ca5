// Sources as the technology table and the memspec state them.
#include "testbench/streaminggs/report/memory_interface.h"

#include <fmt/format.h>

#include "modules/dram/memspec.h"

namespace sgs {
namespace {

constexpr const char* kIoKey = "io_pj_per_bit";

std::string source_of(const char* key, const Memspec& device) {
  const auto own = device.sources.find(key);
  return own != device.sources.end() ? own->second : device.sources.at(kDefaultSource);
}

}  // namespace

std::string MemoryInterface::whose() const {
  if (area_known) return area_of;
  return fmt::format("{}, estimated from {}", memspec,
                     area_of.empty() ? "those of the technology table" : area_of);
}

std::string MemoryInterface::in_words() const {
  const std::string whose = area_of.empty() ? "those of the technology table" : area_of + "'s";
  return fmt::format("{}: PHY and controller {}; I/O {:g} ({:g} .. {:g}) pJ/bit: {}", memspec,
                     area_known
                         ? "by the technology table"
                         : fmt::format("are not known, {} are counted by peak bandwidth", whose),
                     io_pj_per_bit, io_pj_per_bit_low, io_pj_per_bit_high, io_source);
}

MemoryInterface memory_interface_of(const DramConfig& dram, const Technology& technology) {
  const Memspec device = load_memspec(dram.memspec);
  const MemoryInterfaceCost& cost = technology.memory_interface;
  const IoEnergy io = dram.io_pj_per_bit_of(device);
  return {device.name,
          cost.memspec,
          !cost.memspec.empty() && device.name.rfind(cost.memspec, 0) == 0,
          cost.source,
          io.middle,
          io.low,
          io.high,
          dram.io_pj_per_bit ? std::string("dram.") + kIoKey : source_of(kIoKey, device)};
}

}  // namespace sgs
