// A platform that is not this project's: its bus and its memory draw a frame with the exact
// machine. Whatever takes TLM-2.0 transactions in four phases, or blocking ones, can stand in their
// place.
#include <fmt/format.h>
#include <tlm_utils/simple_target_socket.h>

#include <cmath>
#include <cstring>
#include <systemc>
#include <tlm>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/storage/stored_scene.h"
#include "modules/config/strict_json.h"
#include "modules/machines.h"
#include "tlm/time_resolution.h"

// One target socket for each requester of the machine. A transfer takes the bus for its bytes, at
// 16 B a nanosecond, and the memory answers 50 ns later.
struct BusWithMemory : sc_core::sc_module {
  using Socket = tlm_utils::simple_target_socket_tagged<BusWithMemory>;
  sc_core::sc_vector<Socket> from;
  std::vector<unsigned char> bytes;
  sc_core::sc_time free_from;

  BusWithMemory(const sc_core::sc_module_name& name, std::size_t initiators, std::size_t size)
      : sc_module(name), from("from", initiators), bytes(size) {
    for (std::size_t i = 0; i < initiators; ++i) {
      from[i].register_b_transport(this, &BusWithMemory::b_transport, static_cast<int>(i));
    }
  }

  void b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
    const std::uint64_t address = payload.get_address(), length = payload.get_data_length();
    if (address > bytes.size() || length > bytes.size() - address) {
      payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
      return;
    }
    const sc_core::sc_time asked = sc_core::sc_time_stamp() + delay;
    free_from = std::max(free_from, asked) + sc_core::sc_time(length / 16.0, sc_core::SC_NS);
    const sc_core::sc_time answer = free_from + sc_core::sc_time(50, sc_core::SC_NS);
    sc_core::wait(answer - sc_core::sc_time_stamp());
    delay = sc_core::SC_ZERO_TIME;
    unsigned char *memory = bytes.data() + address, *data = payload.get_data_ptr();
    payload.is_read() ? std::memcpy(data, memory, length) : std::memcpy(memory, data, length);
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  }
};

// Prints the counters that units publish: one of many ways to look at a data sheet.
struct PrintedCounters : sgs::DataSheet {
  std::string name;
  void unit(const sc_core::sc_object& unit) override { name = unit.name(); }
  void counter(const char* counter, const char* unit, const char*, std::uint64_t value) override {
    fmt::print("  {:32} {:24} {:10} {}\n", name, counter, value, unit);
  }
};

// A helix of Gaussians around the y axis.
sgs::GaussianCloud helix(std::size_t count) {
  sgs::GaussianCloud cloud;
  cloud.resize(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const float turn = 0.05F * static_cast<float>(i), height = 2.0F * static_cast<float>(i) / count;
    cloud.means[i] = {std::cos(turn), height - 1, std::sin(turn)};
    cloud.log_scales[i] = glm::vec3(-3.5F, -3.0F, -4.0F);
    cloud.quats[i] = {1, 0.3F * std::sin(turn), 0, 0.2F};
    cloud.opacity_logits[i] = 2;
    cloud.sh_coeffs[i] = {std::cos(turn), height - 1, std::sin(turn)};
  }
  return cloud;
}

sgs::Camera camera_at(double distance) {
  sgs::Camera camera;
  camera.width = 160, camera.height = 120;
  camera.focal_x = camera.focal_y = 150;
  camera.position = {0, 0, -distance};
  return camera;
}

int sc_main(int, char*[]) {
  sgs::use_femtosecond_resolution();
  // The first kind is the exact machine. Its defaults, but for one key.
  const std::unique_ptr<sgs::MachineDesign> design = sgs::machine_kinds().front().design();
  sgs::ConfigDocument keys;
  keys.add_override("hfus=2");
  keys.read_into(*design);

  // The scene, stored as the machine reads it.
  sgs::StorageConfig storage;
  storage.order = design->storage_order();
  storage.chunk_gaussians = 16;
  std::vector<sgs::AutoChoice> chosen;
  design->resolve(storage, chosen);
  const sgs::StoredScene scene = sgs::store_scene(activate(helix(2000)), storage, {});
  design->adapt(scene.image.layout.second_half, chosen);

  const sgs::FrameJob job = design->job(scene, camera_at(4));
  const std::unique_ptr<sgs::Machine> machine = design->build("accelerator", job, {});
  const sgs::RegionSpan frame = job.frame_buffer;
  BusWithMemory platform("platform", machine->memory.size(), frame.base + frame.bytes);
  std::memcpy(platform.bytes.data(), scene.image.bytes.data(), scene.image.bytes.size());
  for (std::size_t i = 0; i < machine->memory.size(); ++i)
    machine->memory[i].bind(platform.from[i]);
  sc_core::sc_start();

  // Bit for bit the picture of the golden renderer.
  sgs::DataSheet nobody;
  const sgs::Image golden = design->golden(scene, job, nobody).image;
  const std::vector<std::byte> expected = encode_frame(job.frame_format, golden);
  const bool equal =
      std::memcmp(expected.data(), platform.bytes.data() + frame.base, expected.size()) == 0;
  PrintedCounters sheet;
  machine->publish(sheet);
  fmt::print("{} cycles, frame {}\n", machine->clock().now_cycles(),
             machine->done() && equal ? "equal to the golden picture" : "NOT equal");
  return machine->done() && equal ? 0 : 1;
}
