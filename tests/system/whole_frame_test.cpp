// Whole frames of built-in scenes through the command: right and accounted for, whatever the order,
// the timing and the stalls.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Arguments = std::vector<std::string>;

// Room for groups of any size, and for ordering tables of any number of voxels.
const Arguments kRoomy = {"--set", "sram.shared_bytes=1073741824",
                          "--set", "vsu.table_bytes=67108864",
                          "--set", "sram.input_bytes=1073741824"};

Arguments join(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST_CASE("whole frame: the same pixels with and without stalls, accurate and fast") {
  for (const char* order : {"paper", "exact"}) {
    for (const char* scene : {"builtin:object?n=3000", "builtin:outdoor?n=3000"}) {
      INFO(order << " " << scene);
      const Arguments common = {scene,      "--view", "all",   "--size",     "96x54",
                                "--config", order,    "--set", "group_px=32"};
      const Simulation plain(common);
      plain.check();
      for (const Arguments& variant :
           {Arguments{"--timing", "fast"}, Arguments{"--stalls", "0.1"},
            Arguments{"--stalls", "0.3", "--seed", "2"},
            Arguments{"--stalls", "0.1", "--timing", "fast", "--seed", "3"}}) {
        const Simulation other(join(common, variant));
        other.check();
        REQUIRE(other.views().size() == plain.views().size());
        bool slower = false;
        for (std::size_t v = 0; v < plain.views().size(); ++v) {
          CHECK(other.frame(v) == plain.frame(v));
          slower =
              slower || other.views()[v]["frame"]["cycles"] > plain.views()[v]["frame"]["cycles"];
        }
        if (variant[0] == "--stalls") CHECK(slower);
      }
    }
  }
}

TEST_CASE("whole frame: equal seeds give equal cycles") {
  const Arguments arguments = {"builtin:object?n=3000", "--size", "64x36", "--stalls", "0.2"};
  CHECK(Simulation(arguments).views()[0]["frame"]["cycles"] ==
        Simulation(arguments).views()[0]["frame"]["cycles"]);
}

TEST_CASE("whole frame: groups of 4 to 128 px, most of them no divisor of the frame") {
  for (const char* order : {"paper", "exact"}) {
    for (const char* group : {"4", "12", "16", "28", "64", "128"}) {
      INFO(order << " " << group);
      Simulation(join({"builtin:object?n=2000", "--size", "67x45", "--config", order, "--set",
                       std::string("group_px=") + group},
                      kRoomy))
          .check();
    }
  }
}

TEST_CASE("whole frame: frames of one pixel, one row and one column") {
  for (const char* order : {"paper", "exact"}) {
    for (const char* size : {"1x1", "200x1", "1x200", "3x5"}) {
      INFO(order << " " << size);
      Simulation({"builtin:object?n=2000", "--size", size, "--config", order}).check();
    }
  }
}

TEST_CASE("whole frame: voxels and chunks from tiny to all") {
  for (const char* size : {"0.02", "0.1", "0.7", "1000"}) {
    INFO(size);
    Simulation(join({"builtin:object?n=1500", "--size", "48x27", "--config", "paper", "--set",
                     std::string("voxel_size=") + size},
                    kRoomy))
        .check();
  }
  for (const char* chunk : {"1", "7", "64"}) {
    INFO(chunk);
    Simulation(join({"builtin:object?n=1500", "--size", "48x27", "--config", "exact", "--set",
                     std::string("chunk_gaussians=") + chunk},
                    kRoomy))
        .check();
  }
}

TEST_CASE("whole frame: other numbers of units, ports and memory channels") {
  for (const char* order : {"paper", "exact"}) {
    for (const Arguments& variant :
         {Arguments{"--set", "hfus=1", "--set", "sorting_units=1"},
          Arguments{"--set", "hfus=3", "--set", "sorting_units=5"},
          Arguments{"--set", "memory_port.max_outstanding=1", "--set", "dram.channels=1"},
          Arguments{"--set", "clock_mhz=733"},
          Arguments{"--set", "hfu.cfus=1", "--set", "hfu.second_half_slots=1", "--set",
                    "hfu.candidate_fifo_entries=1"},
          Arguments{"--set", "hfu.coarse_filter=false"}}) {
      INFO(order << " " << variant[1]);
      Simulation(
          join(join({"builtin:object?n=1500", "--size", "48x27", "--config", order}, variant),
               kRoomy))
          .check();
    }
  }
}

TEST_CASE("whole frame: sampled rays, paper order") {
  Simulation({"builtin:object?n=3000", "--size", "64x36", "--config", "paper", "--set",
              "vsu.sample_step_voxels=0.5"})
      .check();
}

TEST_CASE("whole frame: eight bits are the floats, rounded") {
  const ScratchFolder scratch;
  const Outcome outcome =
      run_streaminggs({"simulate", "builtin:object?n=2000", "--size", "64x36", "--config", "paper",
                       "--set", "framebuffer=rgb8", "--out", scratch.path("out")});
  CHECK(outcome.status == 0);
  const auto report = nlohmann::json::parse(bytes_of(scratch.path("out/report.json")));
  CHECK(report["views"][0]["image"]["equals_streaming_renderer"] == true);
  CHECK(region_bytes(report["views"][0], "frame_buffer", "write") == 64 * 36 * 3);
}

TEST_CASE("whole frame: the golden image of `render` is the frame of `simulate`") {
  for (const std::string order : {"paper", "exact"}) {
    const std::string preset = order == "paper" ? "paper_no_vq" : order;
    const Simulation simulated({"builtin:object?n=3000", "--size", "100x60", "--config", preset,
                                "--set", "group_px=64", "--set", "sram.shared_bytes=1073741824"});
    const ScratchFolder scratch;
    // Exact order is the reference's, to the bit.
    const std::string ordering = order == "exact" ? "reference" : order;
    const Outcome rendered =
        run_streaminggs({"render", "builtin:object?n=3000", "--size", "100x60", "--ordering",
                         ordering, "--out", scratch.path("g.exr")});
    REQUIRE(rendered.status == 0);
    const std::string frame = simulated.folder() + "/out/view_0/frame.exr";
    CHECK(run_streaminggs({"compare", "--exact", frame, scratch.path("g.exr")}).status == 0);
    // And it is a picture: not the one of another view.
    const Outcome other = run_streaminggs({"render", "builtin:object?n=3000", "--size", "100x60",
                                           "--view", "1", "--out", scratch.path("h.exr")});
    REQUIRE(other.status == 0);
    CHECK(run_streaminggs({"compare", "--exact", frame, scratch.path("h.exr")}).status == 1);
  }
}

}  // namespace
}  // namespace sgs::test
