// Frames, their report and table, and what they come to.
#include "testbench/streaminggs/run/path_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "algorithm/files/output_file.h"
#include "algorithm/image/image_io.h"
#include "testbench/streaminggs/report/contact_sheet.h"
#include "testbench/streaminggs/report/json_table.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/report/terminal.h"
#include "testbench/streaminggs/run/camera_check.h"
#include "testbench/streaminggs/run/path_summary.h"
#include "testbench/streaminggs/run/progress.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// The same machine behind its first frame: as resolved, but for codebooks that are there. None
// where there is nothing to keep.
std::optional<RunConfig> with_codebooks(RunConfig& config, const SecondHalfFormat& format) {
  Json document = parse_json(to_json(config), "the configuration");
  const Json::json_pointer kept("/codebook/preloaded");
  if (!format.quantised() || !document.contains(kept)) return {};
  document[kept] = true;
  ConfigDocument text;
  text.add_text(document.dump(), "the configuration");
  RunConfig later = read_run_config(text, *config.kinds);
  resolve(later);
  adapt(later, format);
  return later;
}

// A line of the table.
Json line_of(const Json& report) {
  Json line;
  line["frame"] = report["view"];
  for (const char* key : {"cycles", "time_s", "fps"}) line[key] = report["frame"][key];
  const Json& energy = report["energy"];
  const bool memory_known = energy["memory_known"];
  line["energy_j"] = memory_known ? energy["total_j"] : Json();
  line["mean_power_w"] = memory_known ? energy["mean_power_w"] : Json();
  line["bytes"] = report["dram"]["bytes"];
  line["bus_bytes"] = report["dram"]["bus_bytes"];
  for (const char* key : {"psnr_db", "ssim", "equals_streaming_renderer"}) {
    line[key] = report["image"][key];
  }
  line["binding"] = report["binding"]["unit"];
  line["utilisation"] = report["binding"]["utilisation"];
  line["holds"] = report["binding"]["holds"];
  line["empty"] = report["image"]["empty"];
  return line;
}

// Frames as they are drawn, and what the terminal says of them.
class DrawnFrames {
 public:
  explicit DrawnFrames(const PathJob& job) : job_(job), sheet_(job.frames.size()) {}

  // of_view: its report.
  void add(ViewResult view, const Json& of_view) {
    const std::size_t number = frames_.size();
    const FixedRate& rate = view.fixed_rates.at(0);
    const Totals& all_j = rate.held ? rate.totals_j : view.energy_totals_j;
    frames_.push_back(
        {view.run.time_s(), view.energy_j.total, rate.rest_j.total, all_j.with_memory_interface,
         is_empty(view),
         view.run.memory.energy_not_stated.empty() && rate.memory_not_stated.empty()});
    lines_.push_back(line_of(of_view));
    all_equal_ = all_equal_ && view.equals_golden;
    if (view.psnr_db < worst_psnr_db_) worst_picture_ = number;
    worst_psnr_db_ = std::min(worst_psnr_db_, view.psnr_db);
    if (sheet_.shows(number)) {
      sheet_.add(view.frame,
                 fmt::format("{} - {} FPS", number, rate_in_words(1 / view.run.time_s())));
    }
    if (!slowest_ || view.run.time_s() > slowest_->run.time_s()) slowest_ = std::move(view);
  }

  PathSummary summary() const { return summarise(frames_, job_.frame_rate); }
  std::string table() const { return csv_of(lines_); }
  Image sheet() const { return sheet_.sheet(); }
  const ViewResult& slowest() const { return *slowest_; }
  bool all_equal() const { return all_equal_; }

  void print() const {
    const PathSummary s = summary();
    fmt::print("\n{} frame{}{} along {}: frames a second worst {} (frame {}), p99 {}, median {}\n",
               s.frames, s.frames == 1 ? "" : "s", slowest_->right ? " of two eyes" : "", job_.name,
               rate_in_words(s.worst_fps), s.worst_frame, rate_in_words(s.p99_fps),
               rate_in_words(s.median_fps));
    // Late frames begin fewer a second than are asked for.
    const double frames = static_cast<double>(s.frames);
    const double begun = s.late > 0 ? frames * s.frames_w.middle / s.energy_j : s.rate;
    fmt::print(
        "{} mJ a frame, without the rest between frames; {} W at {} frames a second{}: {} for "
        "frames, {} between them; {} W with PHY and controller\n",
        rounded(1e3 * s.energy_j / frames), rounded(s.frames_w + s.idle_w), rounded(begun),
        s.memory_known ? "" : " without the memory", rounded(s.frames_w.middle),
        rounded(s.idle_w.middle), rounded(s.with_interface_w));
    if (s.late > 0) {
      fmt::print("{} of {} frames take longer than 1/{} s: the next one begins late\n", s.late,
                 s.frames, rounded(s.rate));
    }
    fmt::print("frame {}, the slowest: {}\n", s.worst_frame, slowest_->binding.sentence());
    print_empty(s.empty, s.frames, "frames");
    if (std::isinf(worst_psnr_db_)) {
      fmt::print("every frame equals its reference picture\n");
    } else {
      fmt::print("PSNR: worst {:.2f} dB (frame {})\n", worst_psnr_db_, worst_picture_);
    }
  }

 private:
  const PathJob& job_;
  std::vector<PathFrame> frames_;
  Json lines_ = Json::array();
  ContactSheet sheet_;
  std::optional<ViewResult> slowest_;  // the first of several
  double worst_psnr_db_ = std::numeric_limits<double>::infinity();
  std::size_t worst_picture_ = 0;
  bool all_equal_ = true;
};

}  // namespace

std::vector<std::filesystem::path> files_of_path(const PathJob& job, const ResultFolder& out) {
  std::vector<std::filesystem::path> files = {out.path_table(), out.contact_sheet()};
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    files.push_back(out.frame(i));
    if (job.frames[i].eyes_apart != 0) files.push_back(out.frame(i, 1));
  }
  return files;
}

void write_frame(const ResultFolder& out, std::size_t number, const Image& left,
                 const Image* right) {
  write_image(out.frame(number).string(), left);
  if (right != nullptr) write_image(out.frame(number, 1).string(), *right);
  if (number > 0) return;
  std::vector<std::filesystem::path> kept = {out.frame(0)};
  if (right != nullptr) kept.push_back(out.frame(0, 1));
  out.keep_only(kept);
}

void print_doubt(const PathJob& job, const PreparedScene& scene) {
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    const std::string doubt = doubt_about(job.frames[i], scene.given());
    if (doubt.empty()) continue;
    fmt::print("frame {}: {}\n", i, doubt);
    return;  // the others likely say the same
  }
}

int run_path(const PathJob& job, RunSetting& setting, const ResultFolder& out, bool dropping) {
  const PreparedScene& scene = setting.scene;
  RunConfig& config = setting.config;
  RunReport report(config, setting.facts);
  const std::optional<RunConfig> later =
      with_codebooks(config, scene.stored.image.layout.second_half);
  print_doubt(job, scene);
  const bool all = setting.detail == Detail::kAll;
  RunOptions options = setting.options;
  options.frame_rates = {job.frame_rate};
  std::optional<ProgressLine> progress;
  if (!all) progress.emplace();
  if (all) print_table_head(setting.detail);
  DrawnFrames drawn(job);
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    const RunConfig& machine = i > 0 && later ? *later : config;
    ViewResult view;
    try {
      view = simulate_view(scene, static_cast<int>(i), job.frames[i], machine, setting.technology,
                           options);
    } catch (const InputError&) {
      throw;  // the configuration is at fault, not the frame
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("frame {} of {}: {}", i, job.name, error.what()));
    }
    write_frame(out, i, view.frame, view.right ? &view.right->frame : nullptr);
    if (all) {
      print_table_line(view, setting.detail);
      std::fflush(stdout);
    }
    if (progress) progress->say(fmt::format("{} of {} frames", i + 1, job.frames.size()));
    const auto of_view = report.of_view(view, scene);
    report.add(*of_view);
    drawn.add(std::move(view), *of_view);
  }
  progress.reset();
  OutputSet files;
  files.add(out.report().string()).write(report.text({job.name, drawn.summary()}));
  files.add(out.path_table().string()).write(drawn.table());
  write_image(files.add(out.contact_sheet().string()), drawn.sheet());
  files.commit();
  drawn.print();
  print_scene(scene, config, dropping);
  print_unknown_energy(drawn.slowest());
  print_area(drawn.slowest(), setting.technology.name, setting.detail);
  if (all) print_lanes(drawn.slowest());
  print_choices(config.chosen, setting.detail);
  if (!drawn.all_equal()) fmt::print("\na frame differs from the streaming renderer's\n");
  fmt::print("\nwritten to {}\n", out.report().parent_path().string());
  return drawn.all_equal() ? 0 : 1;
}

}  // namespace sgs
