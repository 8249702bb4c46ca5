// The counted filters as JSON.
#include "testbench/streaminggs/datapath.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "algorithm/splat/filter_work.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

Json counts_of(const OperationCounts& c) {
  return {{"multiplies", c.multiplies},
          {"adds", c.adds},
          {"fused", c.fused},
          {"divisions", c.divisions},
          {"divisors", c.divisors},
          {"square_roots", c.square_roots},
          {"logarithms", c.logarithms},
          {"exponentials", c.exponentials},
          {"comparisons", c.comparisons},
          {"roundings", c.roundings}};
}

Json cost_of(std::uint32_t macs, std::uint32_t lanes) {
  return {{"macs", macs}, {"interval_cycles", HfuConfig::lane_cycles(macs, lanes)}};
}

Json filter_of(const OperationCounts& counts, std::uint32_t paper_macs, std::uint32_t used_macs,
               std::uint32_t lanes) {
  return {{"counts", counts_of(counts)},
          {"counted", cost_of(folded_macs(counts), lanes)},
          {"paper", cost_of(paper_macs, lanes)},
          {"used", cost_of(used_macs, lanes)}};
}

}  // namespace

Json datapath_of(const HfuConfig& config, int sh_degree) {
  return {{"coarse", filter_of(coarse_work(longest_case()), kPaperCfuMacs, config.cfu_macs,
                               config.cfu_lanes)},
          {"fine", filter_of(fine_work(longest_case(), sh_degree).total(), kPaperFfuMacs,
                             config.ffu_macs, config.ffu_lanes)}};
}

void print_datapath(const Json& r) {
  const auto macs = [&](const char* filter, const char* whose) {
    return r["datapath"][filter][whose]["macs"].get<std::uint32_t>();
  };
  fmt::print(
      "  multiply-accumulates of a test, counted / the paper's / used: coarse {} / {} / {}, fine "
      "(SH degree {}) {} / {} / {}\n",
      macs("coarse", "counted"), macs("coarse", "paper"), macs("coarse", "used"),
      r["scene"]["sh_degree"].get<int>(), macs("fine", "counted"), macs("fine", "paper"),
      macs("fine", "used"));
}

}  // namespace sgs
