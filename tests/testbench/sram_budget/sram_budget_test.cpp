// On-chip memory: what the units publish is what the configuration was checked with, every queue
// lies in it, and no machine takes more than stands there.
#include "testbench/result/sram_budget.h"

#include <catch2/catch.hpp>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "modules/machines.h"
#include "modules/streaminggs/exact_machine.h"
#include "testbench/builtin/open_scene.h"
#include "testbench/command_line/config_source.h"
#include "testbench/process/child_process.h"
#include "testbench/result/collect.h"
#include "testbench/result/frame_result.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "tlm/time_resolution.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;
using Settings = std::vector<std::string>;

// A machine, and what it is told of a scene.
struct Prepared {
  RunConfig config;
  FrameJob job;
};
Prepared prepared(const std::string& preset, const Settings& settings) {
  RunConfig config = read_run_config(ConfigSource{preset, settings}.document(), machine_kinds());
  config.storage.vq.iterations = 1;
  resolve(config);
  Scene scene = open_scene("builtin:object?n=64");
  const Camera camera = scaled_to(scene.cameras.front(), 40, 24);
  const PreparedScene stored = prepare(std::move(scene), config, {camera});
  FrameJob job = config.design->job(stored.stored, camera);
  return {std::move(config), std::move(job)};
}

// The data sheets of a machine, as it is built for a scene; budget checked.
MachineResult sheets_of(const std::string& preset, const Settings& settings) {
  const Prepared machine_and_job = prepared(preset, settings);
  return from_wire(in_child([&] {
           use_femtosecond_resolution();
           const auto machine =
               machine_and_job.config.design->build("accelerator", machine_and_job.job, {});
           check_sram_budget(*machine);
           FrameResult result;
           result.machine = collect(*machine);
           return to_wire(result);
         }))
      .machine;
}

std::uint64_t available(const MachineResult& machine, const std::string& memory) {
  for (const auto& [name, bytes] : machine.sram_available) {
    if (name == memory) return bytes;
  }
  return 0;
}

// A memory that is left open becomes as large as the check of the configuration says that it must
// be, before anything is built: so large is what the units then publish.
void check_sums(const std::string& preset, Settings settings) {
  const bool tiles = preset.rfind("gscore", 0) == 0;
  const std::vector<std::string> memories =
      tiles ? std::vector<std::string>{"buffer"} : std::vector<std::string>{"input", "shared"};
  for (const std::string& memory : memories) {
    settings.push_back("sram." + memory + "_bytes=0");
  }
  INFO(preset << " " << settings.front());
  const MachineResult machine = sheets_of(preset, settings);
  for (const std::string& memory : memories) {
    INFO(memory << ": " << sram_sum(machine.sram_uses, memory));
    CHECK(available(machine, memory) > 0);
    CHECK(sram_bytes(machine.sram_uses, memory) == available(machine, memory));
  }
}

TEST_CASE("sram budget: units publish what the configuration was checked with, queues included") {
  for (const char* preset :
       {"exact", "exact_fast", "exact_fp16", "exact_wide", "exact_half", "exact_vq",
        "exact_vq_packed", "paper", "paper_no_vq", "paper_no_cgf", "paper_no_vq_cgf", "paper_text",
        "paper_ideal", "gscore", "gscore_fp32_keys", "gscore_lossless", "gscore_lossless_boxes"}) {
    check_sums(preset, {});
  }
}

TEST_CASE("sram budget: the same for machines that are no preset") {
  check_sums("exact", {"hfus=3", "sorting_units=3", "group_width_px=72", "group_height_px=48"});
  check_sums("exact_vq", {"hfus=3", "sorting_units=3", "group_width_px=72", "group_height_px=48"});
  check_sums("paper", {"hfus=3", "sorting_units=3", "group_width_px=72", "group_height_px=48",
                       "fetch=split"});
  check_sums("paper_no_vq",
             {"hfus=1", "sorting_units=3", "group_width_px=72", "group_height_px=48"});
  check_sums("paper_no_vq",
             {"hfus=4", "sorting_units=8", "group_width_px=72", "group_height_px=48"});
  for (const char* preset : {"exact", "exact_vq", "paper", "paper_no_vq"}) {
    check_sums(preset, {"hfu.second_half_slots=5", "hfu.input_slots=3", "framebuffer=rgb32f",
                        "rendering.pixel_buffers=1"});
    check_sums(preset, {"memory_port.max_writes=7", "memory_port.max_transaction_bytes=64"});
  }
  check_sums("exact", {"merge.on_overflow=blend_early", "storage.chunk_gaussians=0"});
  check_sums("paper", {"vsu.groups_ahead=3", "sorting.spill_block_entries=2"});
  check_sums("gscore", {"ccus=3", "cores=5", "tiles.subtiles_across=4", "framebuffer=rgb32f"});
}

struct Message {
  static constexpr std::uint32_t kSramBytes = 20;
};

// A machine of one queue, whose data sheet is the test's. (A process has room for one.)
class Publisher : public Machine {
 public:
  explicit Publisher(const char* name) : Machine(name), fifo_("fifo", clock_, 10) {}
  const ClockDomain& clock() const override { return clock_; }
  void publish(DataSheet& sheet) override {
    sheet.unit(*this);
    says(sheet, fifo_);
  }
  std::function<void(DataSheet&, FifoChannel&)> says;

 private:
  const ClockDomain clock_{1000};
  TimedFifo<Message> fifo_;
};

TEST_CASE("sram budget: more than there is, and a queue in no use, are refused by name") {
  const SramUse fits = fifo_use<Message>("messages", "scratch", 10, "messages");
  CHECK(fits.total_bytes() == 200);
  Publisher machine("machine");
  machine.says = [&](DataSheet& sheet, FifoChannel& fifo) {
    sheet.sram(fits);
    sheet.queue(fifo, "messages");
    sheet.sram_available("scratch", 120);
    sheet.sram_available("scratch", 80);
  };
  CHECK_NOTHROW(check_sram_budget(machine));

  machine.says = [&](DataSheet& sheet, FifoChannel& fifo) {
    sheet.sram(fits);
    sheet.sram(fits);
    sheet.sram(sram_use("blocks", "scratch", {{3, "blocks"}, {13, "B"}}, {32}, kOneOfEach));
    sheet.queue(fifo, "messages");
    sheet.sram_available("scratch", 438);
  };
  CHECK_THROWS_AS(check_sram_budget(machine), InputError);
  CHECK_THROWS_WITH(
      check_sram_budget(machine),
      "on-chip memory scratch: 438 bytes are there, 439 are needed: messages 400 (2 x "
      "10 messages x 20 B) + blocks 39 (3 blocks x 13 B)");

  machine.says = [&](DataSheet& sheet, FifoChannel&) { sheet.sram(fits); };
  CHECK_THROWS_WITH(check_sram_budget(machine), Contains("0 bytes are there, 200 are needed"));

  machine.says = [&](DataSheet& sheet, FifoChannel& fifo) {
    sheet.sram(fits);
    sheet.queue(fifo, "others");
    sheet.sram_available("scratch", 1000);
  };
  CHECK_THROWS_AS(check_sram_budget(machine), std::logic_error);
  CHECK_THROWS_WITH(check_sram_budget(machine), Contains("machine") && Contains("\"others\""));

  machine.says = [&](DataSheet& sheet, FifoChannel& fifo) {
    sheet.sram(fits);
    sheet.queue(fifo, "messages");
    sheet.queue(fifo, "messages");
    sheet.sram_available("scratch", 1000);
  };
  CHECK_THROWS_WITH(check_sram_budget(machine), Contains("hold 400 B") && Contains("uses 200"));
}

TEST_CASE("sram budget: banks of few rows are registers and take nothing of it") {
  struct Row {
    SramPorts ports;
    std::uint64_t bytes;  // in two banks of 4 B
    std::uint64_t taken;
  };
  for (const Row& row :
       {Row{SramPorts::kOne, 32, 0}, Row{SramPorts::kOne, 33, 33},
        Row{SramPorts::kReadAndWrite, 72, 0}, Row{SramPorts::kReadAndWrite, 73, 73}}) {
    INFO(row.bytes);
    const SramUse use =
        sram_use("words", "scratch", {{row.bytes, "B"}}, {32, row.ports, 2}, kOneOfEach);
    CHECK(sram_bytes({use}, "scratch") == row.taken);
    CHECK(sram_sum({use}, "scratch").empty() == (row.taken == 0));
    CHECK(sram_bytes({use}, "other") == 0);
    Publisher machine("machine");
    machine.says = [&](DataSheet& sheet, FifoChannel&) { sheet.sram(use); };
    if (row.taken == 0) {
      CHECK_NOTHROW(check_sram_budget(machine));
    } else {
      CHECK_THROWS_AS(check_sram_budget(machine), InputError);
    }
  }
}

TEST_CASE("sram budget: what no unit takes is not built, and said so") {
  Publisher machine("machine");
  machine.says = [](DataSheet& sheet, FifoChannel&) {
    sheet.sram(sram_use("blocks", "scratch", {{1000, "B"}}, {32}, kOneOfEach));
    sheet.sram_available("scratch", 3072);
    sheet.sram_available("full", 0);
  };
  const MachineResult result = collect(machine);
  CHECK(result.parts.empty());
  REQUIRE(result.left_out.size() == 1);
  CHECK(result.left_out[0].what == "unused_sram_scratch");
  CHECK(result.left_out[0].count == 2072);
}

// Beside the on-chip memories: what they may put aside of has its place in DRAM.
TEST_CASE("sram budget: the spill region holds two runs of all keys, and every node and chunk") {
  // A key has 32 B, an entry of VSU's queues 16.
  CHECK(exact_spill_bytes(lay_out_chunks({}, 1000, 5, 40)) == 45 * 16 + 2 * 1000 * 32);
  CHECK(exact_spill_bytes(lay_out_chunks({}, 1, 1, 1)) == 2 * 16 + 2 * 32);
  const FrameJob job = prepared("exact", {}).job;
  const ChunkTableLayout& table = job.layout.chunk_table();
  CHECK(job.layout.gaussian_count() == 64);
  CHECK(table.chunk_count >= 1);
  CHECK(job.spill.bytes == (table.chunk_count + table.nodes.count) * 16 + 2 * 64 * 32);
}

}  // namespace
}  // namespace sgs::test
