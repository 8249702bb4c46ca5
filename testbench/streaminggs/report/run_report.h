// report.json of a run: that of each view, with what is the same for all of them, and all of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "testbench/streaminggs/report/report_entry.h"
#include "testbench/streaminggs/run/path_summary.h"
#include "testbench/streaminggs/run/run_config.h"
#include "testbench/streaminggs/run/stream_summary.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

struct RunFacts {
  std::string technology, technology_path;
  std::uint64_t technology_hash = 0;  // the file's
  std::uint64_t seed = 0;             // seeds the random stalls
  std::string configuration;          // its name, with how many values are set over it
  std::string command;                // the whole command line
  std::chrono::steady_clock::time_point began;
};

// Of a camera path, whose frames are the views.
struct PathReport {
  std::string name;
  PathSummary summary;
};

// A frame of a stream, and how it is judged.
struct StreamedPicture {
  FrameTiming timing;
  double psnr_db = 0, ssim = 0;
  bool equals_golden = false, empty = false;  // of both eyes where there are two
  struct Measures {
    double psnr_db = 0, ssim = 0;
  };
  std::optional<Measures> right;  // the right eye's
  double worst_psnr_db() const { return right ? std::min(psnr_db, right->psnr_db) : psnr_db; }
};

// Of a camera path whose frames are drawn back to back.
struct StreamReport {
  std::string name;
  StreamSummary summary;
  StreamFlow flow;
  std::vector<StreamedPicture> frames;
};

class RunReport {
 public:
  // config: resolved.
  RunReport(RunConfig& config, RunFacts facts);
  ~RunReport();

  std::shared_ptr<const nlohmann::ordered_json> of_view(const ViewResult& view,
                                                        const PreparedScene& scene) const;
  // Machine and memory over a whole stream, and the report of that.
  nlohmann::ordered_json of_all(const ViewResult& all, const PreparedScene& scene) const;
  nlohmann::ordered_json of_stream(const StreamReport& stream,
                                   const nlohmann::ordered_json& all) const;
  // One of a view that was finished.
  void add(const nlohmann::ordered_json& view);

  // The report of all views. failed: those that were not finished, and why.
  std::string text(const std::vector<std::pair<int, std::string>>& failed) const;
  // The same of the frames of a path.
  std::string text(const PathReport& path) const;

 private:
  struct Content;
  const RunFacts facts_;
  std::unique_ptr<Content> content_;
};

// As it stands in the file.
std::string report_text(const nlohmann::ordered_json& report);

// What such reports may hold: of one view, and of all.
std::vector<ReportEntry> entries_of_view();
std::vector<ReportEntry> entries_of_all_views();

}  // namespace sgs
