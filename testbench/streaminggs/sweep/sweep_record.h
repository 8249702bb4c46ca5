// A result of a sweep as a line of JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sgs {

constexpr const char* kPointDone = "done";
constexpr const char* kPointRefused = "refused";
constexpr const char* kPointFailed = "failed";

// What was asked for, in the words in which it was.
struct PointInWords {
  std::string scene, cameras, view, size, config;  // empty: not said
  std::vector<std::string> overrides;
};

// report: a view's. Kept are the numbers that a comparison of machines asks for: not where each
// activity waited, the ledger, the uses of on-chip memory, the bands, what was left out.
std::string line_of_done(const std::string& key, const PointInWords& point,
                         const nlohmann::ordered_json& report);
// What the command does not take, and why.
std::string line_of_refused(const std::string& key, const PointInWords& point,
                            const std::string& why);
// What ended badly, for the so-many-th time.
std::string line_of_failed(const std::string& key, const PointInWords& point,
                           const std::string& why, int attempts);

// A line for who asked: `id` (JSON, or empty) before it, and the point in this one's words.
// kept: an earlier sweep's result.
std::string answer_of(const std::string& line, const std::string& id, const PointInWords& point,
                      bool kept);

// Of a refused or failed one, a line for people: which point, and why.
std::string in_short(const std::string& line);

}  // namespace sgs
