// Look-ups in a report.
#include "tests/system/report_values.h"

#include <catch2/catch.hpp>

namespace sgs::test {

using Json = nlohmann::json;

std::uint64_t counter(const Json& view, const std::string& unit, const std::string& name) {
  INFO(unit << " " << name);
  REQUIRE(view["units"].contains(unit));
  REQUIRE(view["units"][unit]["counters"].contains(name));
  return view["units"][unit]["counters"][name];
}

std::uint64_t counter_of_all(const Json& view, const std::string& prefix, const std::string& name) {
  std::uint64_t sum = 0;
  bool any = false;
  for (const auto& [unit, of_unit] : view["units"].items()) {
    if (unit.rfind(prefix, 0) != 0) continue;
    sum += counter(view, unit, name);
    any = true;
  }
  INFO(prefix);
  REQUIRE(any);
  return sum;
}

std::uint64_t total(const Json& view, const std::string& name) {
  std::uint64_t sum = 0;
  for (const Json& unit : view["units"]) sum += unit["counters"].value(name, std::uint64_t{0});
  return sum;
}

namespace {

const Json& activity_of(const Json& view, const std::string& unit, const std::string& activity) {
  INFO(unit << " " << activity);
  REQUIRE(view["units"].contains(unit));
  REQUIRE(view["units"][unit]["activities"].contains(activity));
  return view["units"][unit]["activities"][activity];
}

}  // namespace

std::uint64_t cycles(const Json& view, const std::string& unit, const std::string& activity) {
  return activity_of(view, unit, activity)["busy_cycles"];
}

std::uint64_t waited_cycles(const Json& view, const std::string& unit, const std::string& activity,
                            const std::string& what) {
  return activity_of(view, unit, activity)["waited_cycles"][what];
}

std::uint64_t total_busy(const Json& view, const std::string& activity) {
  std::uint64_t sum = 0;
  for (const Json& unit : view["units"]) {
    for (const auto& [name, of_name] : unit["activities"].items()) {
      if (name.substr(0, name.find_last_not_of("0123456789") + 1) != activity) continue;
      sum += of_name["busy_cycles"].get<std::uint64_t>();
    }
  }
  return sum;
}

std::uint64_t frame_cycles(const Json& view) { return view["frame"]["cycles"]; }

std::uint64_t asked_bytes(const Json& view, const std::string& region, const std::string& requester,
                          const std::string& direction) {
  const Json& regions = view["dram"]["bytes_by_region"];
  if (!regions.contains(region) || !regions[region].contains(requester)) return 0;
  return regions[region][requester].value(direction, std::uint64_t{0});
}

std::uint64_t region_bytes(const Json& view, const std::string& region,
                           const std::string& direction) {
  const Json& regions = view["dram"]["bytes_by_region"];
  std::uint64_t sum = 0;
  if (!regions.contains(region)) return 0;
  for (const Json& requester : regions[region]) sum += requester.value(direction, std::uint64_t{0});
  return sum;
}

nlohmann::json without_host(nlohmann::json view) {
  view.erase("host");
  view["provenance"].erase("command");
  return view;
}

std::uint64_t left_out(const Json& view, const std::string& what) {
  for (const Json& entry : view["left_out"]) {
    if (entry["what"] == what) return entry["count"];
  }
  return 0;
}

}  // namespace sgs::test
