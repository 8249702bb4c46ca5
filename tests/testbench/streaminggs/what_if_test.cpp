// Gains of doubled resources: their order, and what is said of the resource that binding names.
#include "testbench/streaminggs/what_if/what_if.h"

#include <catch2/catch.hpp>

#include "testbench/streaminggs/report/frame_noise.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

Outcome outcome(std::uint64_t cycles, double mm2, const std::string& key = "") {
  Outcome out;
  out.cycles = cycles;
  out.mm2 = out.mm2_with_memory_interface = mm2;
  out.joules = 1;
  out.binding.unit = out.binding.holds = "unit";
  out.binding.utilisation = 0.7;
  out.binding.remedy = key;
  return out;
}

Doubling doubling(const char* key, const Outcome& outcome) {
  Doubling out(key, 1);
  out.outcome = outcome;
  return out;
}

Doubling refused(const char* key) {
  Doubling out(key, 1);
  out.refused = "too large";
  return out;
}

TEST_CASE("what-if: every remedy of the data sheets and the memory, once") {
  FrameResult frame;
  const WaitResult room{WaitFor::kRoom, "fifo", "", "entries", 5};
  const WaitResult input{WaitFor::kInput, "fifo", "", "", 5};
  frame.machine.units.push_back({"a", {{"x", "r", "", 1, {room, input}, "lanes"}}, {}});
  frame.machine.units.push_back({"b", {{"y", "r", "", 1, {room}, "lanes"}}, {}});
  frame.machine.units.back().may_help = {"lanes", "slots"};
  frame.memory.remedy = "channels";
  std::string keys;
  for (const Remedy& remedy : remedies_of(frame)) keys += remedy.key + " ";
  CHECK(keys == "lanes entries slots channels ");
}

TEST_CASE("what-if: more of it, or half the cycles") {
  CHECK(Doubling("lanes", 8).to == 16);
  CHECK(Doubling({"cycles_per_operation", Turn::kDown}, 2).to == 1);
  CHECK(Doubling({"cycles_per_operation", Turn::kDown}, 3).to == 2);  // in whole cycles
  CHECK(Doubling({"front_end_ns", Turn::kDown}, 2.5).to == 1.25);
}

TEST_CASE("what-if: what is saved is a change, and nothing has no sign") {
  for (const auto& [saved, says] : {std::pair{0.114, "-11.4 %"},
                                    {-0.5, "+50.0 %"},
                                    {0.0, "0.0 %"},
                                    {-0.0, "0.0 %"},
                                    {0.0004, "0.0 %"},
                                    {-0.0004, "0.0 %"},
                                    {0.0006, "-0.1 %"}}) {
    INFO(saved);
    CHECK(change_in_words(saved) == says);
  }
}

TEST_CASE("what-if: a gain over area, of no trifle of area, and what is noise") {
  const Outcome base = outcome(1000, 5);
  for (const auto& [mm2, saved, says] : {std::tuple{7.0, 0.5, "-25.0 %"},
                                         {7.0, -0.5, "+25.0 %"},
                                         {5.0, 0.5, "-"},
                                         {4.0, 0.5, "-"},
                                         {5.024, 0.5, "-"},
                                         {5.1, 0.5, "-500.0 %"}}) {
    INFO(mm2 << " mm2, " << saved);
    CHECK(saved_per_mm2(base, outcome(500, mm2), saved) == says);
  }
  Outcome alike = outcome(996, 7);
  CHECK(noise_in_words(base, alike) == "; time below the noise of a frame");
  alike.joules = 1.004;
  CHECK(noise_in_words(base, alike) == "; time and energy below the noise of a frame");
  CHECK(noise_in_words(base, base).empty());
  alike.cycles = base.cycles;
  CHECK(noise_in_words(base, alike).empty());  // of what was added, for certain
}

TEST_CASE("what-if: ranked by time saved, the smaller of equals first, the refused last") {
  const Outcome base = outcome(1000, 5);
  std::vector<Doubling> doublings = {refused("impossible"), doubling("slower", outcome(1100, 6)),
                                     doubling("large", outcome(800, 7)),
                                     doubling("small", outcome(800, 6)),
                                     doubling("best", outcome(500, 9))};
  rank(base, doublings);
  std::string order;
  for (const Doubling& d : doublings) order += d.key + " ";
  CHECK(order == "best small large slower impossible ");
  CHECK(time_saved(base, doublings[0].outcome) == Approx(0.5));
  CHECK(time_saved(base, doublings[3].outcome) == Approx(-0.1));
  CHECK(energy_saved(base, doublings[0].outcome) == Approx(0));
}

TEST_CASE("what-if: the verdict on what binding names") {
  const std::vector<Doubling> doublings = {
      doubling("lanes", outcome(500, 6)), doubling("entries", outcome(500, 7)),
      doubling("slots", outcome(510, 6)), doubling("channels", outcome(900, 5)), refused("banks")};
  struct Row {
    const char* named;
    const char* says;
  };
  for (const Row& row :
       {Row{"lanes", "binding names lanes, and it gains most: 50.0 %"},
        Row{"entries", "binding names entries, and it gains most: 50.0 %"},
        Row{"slots", "binding names slots, which gains 49.0 % of the time; lanes gains"},
        Row{"channels",
            "binding names channels, which gains 10.0 % of the time; "
            "lanes gains most: 50.0 %. With channels=2, unit "
            "holds the frame: unit works 70 %"},
        Row{"banks", "binding names banks, but 2 is refused; lanes gains most"},
        Row{"", "binding names unit, which no key doubles"}}) {
    INFO(row.named);
    const Outcome base = outcome(1000, 5, row.named);
    const std::string says = verdict(base, doublings);
    CHECK_THAT(says, Contains(row.says));
    CHECK(named_gains_most(base, doublings) == (says.find("and it gains most") != says.npos));
  }
  CHECK(verdict(outcome(1000, 5, "lanes"), {}) == "nothing could be doubled");
  CHECK(verdict(outcome(1000, 5, "lanes"), {doubling("lanes", outcome(996, 6))}) ==
        "nothing doubled gains more than the noise of a frame, 0.5 % of the time");
}

TEST_CASE("what-if: two gains that differ by the noise of a frame are one") {
  const std::vector<Doubling> doublings = {doubling("lanes", outcome(500, 6)),
                                           doubling("slots", outcome(504, 6))};
  CHECK(named_gains_most(outcome(1000, 5, "slots"), doublings));
  CHECK_FALSE(below_noise(0));
  CHECK(below_noise(-0.004));
  CHECK_FALSE(below_noise(0.005));
}

}  // namespace
}  // namespace sgs::test
