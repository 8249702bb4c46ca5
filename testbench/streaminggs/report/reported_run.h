// A run of `simulate` as its report tells of it: what it was given, and where its cycles, bytes,
// joules and square millimetres are.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sgs {

// A part of the report. Copies that differ only in numbers ("hfu0.fine", "hfu1.fine") are one part:
// "hfuN.fine".
struct ReportedPart {
  double sum = 0;  // over its copies
  double copies = 0;
};

struct ReportedQuantity {
  double whole = 0;
  std::map<std::string, ReportedPart> parts;
};

// kTime has no parts. The whole of kBusy is the frame in cycles; that of kWaits is the mean of the
// activities, without idle.
// kArea is by kind of part; kDieArea by owner, with PHY and controller of the memory.
enum class Quantity { kTime, kBusy, kWaits, kBytes, kJoules, kArea, kDieArea };
constexpr std::size_t kQuantities = 7;

struct ReportedView {
  int view = 0;
  // Facts about the run beside the configuration: words for a kind of fact, and the fact.
  std::vector<std::pair<std::string, std::string>> facts;
  double cycles = 0;
  std::string image_hash;    // of the bytes loaded into the memory
  std::string psnr_db;       // "equal" where nothing differs from the reference picture
  bool equals = true;        // the frame is the streaming renderer's, to the byte
  std::string holds;         // binding.holds
  bool memory_known = true;  // its energy is part of kJoules
  std::array<ReportedQuantity, kQuantities> quantities;
  const ReportedQuantity& of(Quantity q) const { return quantities[static_cast<std::size_t>(q)]; }
  ReportedQuantity& of(Quantity q) { return quantities[static_cast<std::size_t>(q)]; }
};

struct ReportedRun {
  std::string path;                           // the report's file
  std::map<std::string, std::string> config;  // every key with its path, and its value as JSON
  std::set<std::string> chosen;               // those of them that the model chose
  std::map<std::string, std::string> used;    // bytes that are built, by the key with the size
  bool stream = false;                        // of frames back to back, which are one view
  std::vector<ReportedView> views;            // by number
};

// "hfu0.fine" -> "hfuN.fine"
std::string without_numbers(const std::string& name);

// path: a report.json of `simulate`, of all views or of one, or the folder that it is in. Throws
// InputError: not there, no report, of another version, without a finished view, or a value that is
// missing or of the wrong type.
ReportedRun read_reported_run(const std::string& path);

}  // namespace sgs
