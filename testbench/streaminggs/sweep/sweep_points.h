// The points that a sweep is to simulate, as its user says them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sgs {

// A configuration, and what it differs in from the sweep's command line: an empty text stands for
// what was said there.
struct SweepPoint {
  std::string id;                                  // JSON; what its answer is to be known by
  std::string scene, cameras, view, size, stereo;  // as the options of these names
  std::string config;                              // a preset or a file
  std::vector<std::string> overrides;  // "key.path=value", over those of the command line
  std::optional<bool> fit_memories;    // as the option
  std::string refused;                 // why this is no point at all
};

// All combinations of axes "KEY=V1,V2,...", the last axis changing fastest. Throws InputError.
std::vector<SweepPoint> grid_of(const std::vector<std::string>& axes);

// A line: "KEY=VALUE KEY=VALUE ...", or a JSON object of
//   "set"     {"key.path": value, ...}
//   "id", "scene", "cameras", "view" (a number or text), "size", "stereo", "config", "fit_memories"
//   (a truth)
// each of which may be left out. place: of the line, for messages. Throws InputError.
SweepPoint parse_point(const std::string& line, const std::string& place);

// The content of a list's line: all before a word that begins with '#', without blanks around it;
// all of a JSON line.
std::string content_of(const std::string& line);

// The lines of a file that have content. Throws InputError, also where none has.
std::vector<SweepPoint> read_points(const std::string& path);

}  // namespace sgs
