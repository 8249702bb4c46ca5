// Runs the `streaminggs` executable as a user would, and judges the reports of its simulations.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace sgs::test {

struct Outcome {
  int status = 0;  // exit status; 128 + signal where it was killed
  std::string out, err;
};

Outcome run_streaminggs(const std::vector<std::string>& arguments);

// One `streaminggs simulate` with `framebuffer: rgb32f`, so that frames can be compared to the bit.
class Simulation {
 public:
  // arguments: SCENE and options; --out is added. Fails the test when the exit status is not 0.
  explicit Simulation(const std::vector<std::string>& arguments);

  const std::vector<nlohmann::json>& views() const { return views_; }
  // The frame of one of the views as written, byte by byte.
  std::string frame(std::size_t view) const;
  std::string folder() const { return out_.path(""); }

  // Everything that holds for any frame, of every view: it equals the streaming renderer's (and, in
  // exact order, the reference picture of what second halves decode to), nothing is left over,
  // accounts add up, bytes are visits times sizes, and no resource does more than the frame has
  // cycles for.
  void check() const;

 private:
  ScratchFolder out_;
  std::vector<nlohmann::json> views_;
};

// Sum of a counter over all units of a view that have it.
std::uint64_t total(const nlohmann::json& view, const std::string& counter);

// Bytes asked for in a region, by all requesters; direction: "read" or "write".
std::uint64_t region_bytes(const nlohmann::json& view, const std::string& region,
                           const std::string& direction);

}  // namespace sgs::test
