// Machines on memories that are none of the project's: what is bound to their sockets is any
// TLM-2.0 target with the scene's bytes in it, and the frame read from it is the picture that the
// design says.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "modules/machines.h"
#include "testbench/builtin/open_scene.h"
#include "testbench/process/child_process.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "tests/testbench/other_memory/blocking_memory.h"
#include "tests/testbench/other_memory/prompt_memory.h"
#include "tlm/run_simulation.h"
#include "tlm/time_resolution.h"

namespace sgs::test {
namespace {

// One view of a built-in scene, ready for a machine.
struct Frame {
  explicit Frame(const std::vector<std::string>& settings) {
    ConfigDocument document;
    for (const std::string& setting : settings) document.add_override(setting);
    config = read_run_config(document, machine_kinds());
    resolve(config);
    Scene scene = open_scene("builtin:object?n=1500");
    const Camera camera = scaled_to(scene.cameras[1], 90, 60);
    prepared = prepare(std::move(scene), config, {camera});
    job = config.design->job(prepared.stored, camera);
  }

  std::string picture() const {
    DataSheet unread;
    const GoldenFrame golden = config.design->golden(prepared.stored, job, unread);
    return text_of(encode_frame(job.frame_format, golden.image));
  }

  static std::string text_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  RunConfig config;
  PreparedScene prepared;
  FrameJob job;
};

// Runs the frame on the memory that bind(machine, capacity) makes and binds, in a process of its
// own; returns the bytes of the frame buffer.
template <class Bind>
std::string run_on(const Frame& frame, Bind&& bind) {
  return in_child([&] {
    use_femtosecond_resolution();
    const auto machine = frame.config.design->build("accelerator", frame.job, {});
    const auto memory = bind(*machine, frame.job.layout.regions.total_bytes());
    const std::vector<std::byte>& image = frame.prepared.stored.image.bytes;
    std::copy(image.begin(), image.end(), memory->bytes.data());
    run_simulation();
    if (!machine->done()) throw std::runtime_error("the frame was not finished");
    const std::byte* from = memory->bytes.data() + frame.job.frame_buffer.base;
    return Frame::text_of({from, from + frame.job.frame_buffer.bytes});
  });
}

std::string run_on_blocking(const Frame& frame, double latency_ns) {
  return run_on(frame, [&](Machine& machine, std::uint64_t capacity) {
    auto memory = std::make_unique<BlockingMemory>("memory", machine.memory.size(), capacity,
                                                   sc_core::sc_time(latency_ns, sc_core::SC_NS));
    for (std::size_t i = 0; i < machine.memory.size(); ++i) {
      machine.memory[i].bind(memory->sockets[i]);
    }
    return memory;
  });
}

std::string run_on_prompt(const Frame& frame, double latency_ns) {
  return run_on(frame, [&](Machine& machine, std::uint64_t capacity) {
    auto memory = std::make_unique<PromptMemory>("memory", capacity,
                                                 sc_core::sc_time(latency_ns, sc_core::SC_NS));
    for (auto& socket : machine.memory) socket.bind(memory->socket);
    return memory;
  });
}

TEST_CASE("other memory: both machines render their picture on targets that know nothing of them") {
  const std::vector<std::string> plain = {"group_width_px=32", "group_height_px=32",
                                          "framebuffer=rgb32f"};
  const std::vector<std::string> quantised = {
      "group_width_px=32", "group_height_px=32", "storage.encoding=vq_packed",
      "storage.vq.iterations=2", "sram.codebook_bytes=256000"};
  const std::vector<std::string> preloaded = {
      "group_width_px=32",       "group_height_px=32",         "storage.encoding=vq",
      "storage.vq.iterations=2", "sram.codebook_bytes=256000", "codebook.preloaded=true"};
  const std::vector<std::string> narrow = {"group_width_px=32", "group_height_px=32",
                                           "memory_port.max_outstanding=1",
                                           "memory_port.max_transaction_bytes=32"};
  for (const char* machine : {"exact", "paper"}) {
    for (std::vector<std::string> settings : {plain, quantised, preloaded, narrow}) {
      INFO(machine << " " << settings.back());
      settings.push_back(std::string("machine=") + machine);
      const Frame frame(settings);
      const std::string picture = frame.picture();
      REQUIRE(picture.size() == frame.job.frame_buffer.bytes);
      CHECK(run_on_blocking(frame, 80) == picture);
      CHECK(run_on_blocking(frame, 0) == picture);
      CHECK(run_on_prompt(frame, 0) == picture);
      CHECK(run_on_prompt(frame, 37.5) == picture);
    }
  }
}

TEST_CASE("other memory: an address beyond it ends the run by name") {
  const Frame frame({"machine=exact", "group_width_px=32", "group_height_px=32"});
  const auto run = [&] {
    return in_child([&] {
      use_femtosecond_resolution();
      fail_child_on_sc_error();
      const auto machine = frame.config.design->build("accelerator", frame.job, {});
      PromptMemory memory("memory", 64, sc_core::SC_ZERO_TIME);
      for (auto& socket : machine->memory) socket.bind(memory.socket);
      run_simulation();
      return std::string("came to its end");
    });
  };
  CHECK_THROWS_WITH(run(), Catch::Matchers::Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

}  // namespace
}  // namespace sgs::test
