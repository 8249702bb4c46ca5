// Every machine's way to the memory.
#include "modules/machine.h"

#include <cstddef>
#include <limits>

#include "algorithm/splat/view.h"
#include "modules/frame_job.h"

namespace sgs {
namespace {

// The memory ports of all units, in the order of their data sheets.
class Ports : public DataSheet {
 public:
  void port(MemoryPort& port, const char*) override { found.push_back(&port); }
  std::vector<MemoryPort*> found;
};

// "machine.hfu0.coarse.memory" -> "hfu0.coarse"; a unit with several ports keeps their names.
std::string requester_name(const MemoryPort& port, const Machine& machine) {
  std::string path = std::string(port.name()).substr(std::string(machine.name()).size() + 1);
  const std::string plain = ".memory";
  if (path.size() > plain.size() &&
      path.compare(path.size() - plain.size(), plain.size(), plain) == 0) {
    path.resize(path.size() - plain.size());
  }
  return path;
}

}  // namespace

void Machine::connect_memory(std::uint32_t frames) {
  Ports ports;
  publish(ports);
  const std::size_t units = ports.found.size(), count = units + (frames > 1 ? 1 : 0);
  memory.init(count);
  router_ = std::make_unique<Router>("router", instant_end_, static_cast<std::uint32_t>(count));
  for (std::size_t i = 0; i < units; ++i) {
    ports.found[i]->socket.bind(router_->from_initiators[i]);
    requesters_.push_back(requester_name(*ports.found[i], *this));
  }
  if (count > units) requesters_.emplace_back("display");
  // The memory says which addresses it has.
  router_->map(0, std::numeric_limits<std::uint64_t>::max(), memory);
}

void Machine::bind_display(MemoryPort& port) {
  port.socket.bind(router_->from_initiators[router_->from_initiators.size() - 1]);
}

void Machine::publish_poses(DataSheet& sheet, const FrameJob& job) const {
  if (job.frames() == 1) return;
  constexpr const char* kPoses = "poses";
  // What stands before the size, which all frames have in common.
  constexpr std::size_t kOneEye = offsetof(View<float>, width);
  constexpr std::size_t kPlace = sizeof(View<float>::eyes_apart) + sizeof(View<float>::to_eye);
  const double bits = 8.0 * static_cast<double>(kOneEye + (job.eyes > 1 ? kPlace : 0));
  sheet.part(kPoses, "register_bit", kFramesAtOnce * bits, 1);
  sheet.operations(kPoses, "register_bit", drawn_ * bits);
  sheet.part(kPoses, "select_bit", bits, 1);
  sheet.operations(kPoses, "select_bit", drawn_ * bits);
}

}  // namespace sgs
