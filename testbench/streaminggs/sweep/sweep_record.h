// A result of a sweep as a line of JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sgs {

constexpr const char* kPointDone = "done";
constexpr const char* kPointRefused = "refused";
constexpr const char* kPointFailed = "failed";

// The point that was asked for, in its user's words.
struct PointInWords {
  std::string scene, cameras, view, size, stereo, config;  // empty: not said
  std::vector<std::string> overrides;
  bool fit_memories = false;
};

// report: a view's. Kept are the numbers that a comparison of machines asks for: not where each
// activity waited, the ledger, the uses of on-chip memory, the bands, what was left out.
std::string line_of_done(const std::string& key, const PointInWords& point,
                         const nlohmann::ordered_json& report);
// Line of a point that the command does not take, and why.
std::string line_of_refused(const std::string& key, const PointInWords& point,
                            const std::string& why);
// Line of a point that failed, and how often it was attempted.
std::string line_of_failed(const std::string& key, const PointInWords& point,
                           const std::string& why, int attempts);

// A line for who asked: `id` (JSON, or empty) before it, and the point in this one's words.
// kept: an earlier sweep's result.
std::string answer_of(const std::string& line, const std::string& id, const PointInWords& point,
                      bool kept);

// Whether it is of a frame to which no Gaussian contributes.
bool holds_no_gaussian(const std::string& line);

// A line for people about a refused or failed point: which one, and why.
std::string in_short(const std::string& line);

}  // namespace sgs
