// Values of one view's report, by name; what is not there fails the test.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace sgs::test {

// A counter of one unit.
std::uint64_t counter(const nlohmann::json& view, const std::string& unit, const std::string& name);

// Sum of a counter over the units whose names begin with `prefix`.
std::uint64_t counter_of_all(const nlohmann::json& view, const std::string& prefix,
                             const std::string& name);

// Sum of a counter over all units of a view that have it; 0 where none has.
std::uint64_t total(const nlohmann::json& view, const std::string& name);

// Cycles that one activity of a unit worked.
std::uint64_t cycles(const nlohmann::json& view, const std::string& unit,
                     const std::string& activity);

// Cycles that it waited for something: "input", "reads", "room" and so on.
std::uint64_t waited_cycles(const nlohmann::json& view, const std::string& unit,
                            const std::string& activity, const std::string& what);

// Sum of the busy cycles over all activities of this name, numbered or not.
std::uint64_t total_busy(const nlohmann::json& view, const std::string& activity);

// Cycles of the frame.
std::uint64_t frame_cycles(const nlohmann::json& view);

// Bytes asked for in a region by one requester, and by all; direction: "read" or "write". 0 where
// there was no such request.
std::uint64_t asked_bytes(const nlohmann::json& view, const std::string& region,
                          const std::string& requester, const std::string& direction);
std::uint64_t region_bytes(const nlohmann::json& view, const std::string& region,
                           const std::string& direction);

// What a view says of the model: all but how long the host took, and by what command.
nlohmann::json without_host(nlohmann::json view);

// The count of one entry of `left_out`; 0 where it is not listed.
std::uint64_t left_out(const nlohmann::json& view, const std::string& what);

}  // namespace sgs::test
