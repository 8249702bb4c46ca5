// Frames, their table, and what they come to.
#include "testbench/streaminggs/run/path_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "algorithm/files/output_file.h"
#include "algorithm/image/image_io.h"
#include "testbench/streaminggs/report/contact_sheet.h"
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

// Power of the machine while it waits for its next frame, in watts.
double idle_w(const ViewResult& view) {
  double joules = 0;
  for (const auto& [component, energy] : view.energy_j.by_component) {
    for (const char* stays : {"logic_leakage", "sram_leakage", "memory_interface"}) {
      if (component == stays) joules += energy.middle;
    }
  }
  for (const auto& [region, energy] : view.run.memory.energy_by_region_j) {
    if (region == "standby_and_refresh") joules += energy;
  }
  return view.run.cycles > 0 ? joules / view.run.time_s() : 0;
}

// A line of both tables.
Json line_of(const Json& report) {
  Json line;
  line["frame"] = report["view"];
  for (const char* key : {"cycles", "time_s", "fps"}) line[key] = report["frame"][key];
  line["energy_j"] = report["energy"]["total_j"];
  line["mean_power_w"] = report["energy"]["mean_power_w"];
  line["bytes"] = report["dram"]["bytes"];
  line["bus_bytes"] = report["dram"]["bus_bytes"];
  for (const char* key : {"psnr_db", "ssim", "equals_streaming_renderer"}) {
    line[key] = report["image"][key];
  }
  line["binding"] = report["binding"]["unit"];
  line["utilisation"] = report["binding"]["utilisation"];
  line["holds"] = report["binding"]["holds"];
  return line;
}

// null: an empty field.
std::string csv_of(const Json& lines) {
  std::string text;
  const auto add_line = [&](const Json& line, const auto& field) {
    const char* comma = "";
    for (const auto& [key, value] : line.items()) {
      text += comma + field(key, value);
      comma = ",";
    }
    text += "\n";
  };
  add_line(lines.at(0), [](const std::string& key, const Json&) { return key; });
  for (const Json& line : lines) {
    add_line(line, [](const std::string&, const Json& value) {
      if (value.is_null()) return std::string();
      return value.is_string() ? value.get<std::string>() : value.dump();
    });
  }
  return text;
}

Json to_json(const PathSummary& s, const PathJob& job, double energy_j) {
  return {{"frames", job.frames.size()},
          {"worst_fps", s.worst_fps},
          {"worst_frame", s.worst_frame},
          {"p99_fps", s.p99_fps},
          {"median_fps", s.median_fps},
          {"energy_j", energy_j},
          {"frame_rate", job.frame_rate},
          {"late_frames", s.late},
          {"frames_w", s.frames_w},
          {"idle_w", s.idle_w},
          {"energy_a_second_j", s.frames_w + s.idle_w}};
}

void print(const PathSummary& s, const PathJob& job, double energy_j) {
  fmt::print(
      "\n{} frames along {}: frames a second worst {:.0f} (frame {}), p99 {:.0f}, median "
      "{:.0f}\n",
      job.frames.size(), job.name, s.worst_fps, s.worst_frame, s.p99_fps, s.median_fps);
  fmt::print("{} mJ a frame; at {} frames a second {} J a second: {} for frames, {} between them\n",
             rounded(1e3 * energy_j / static_cast<double>(job.frames.size())),
             rounded(job.frame_rate), rounded(s.frames_w + s.idle_w), rounded(s.frames_w),
             rounded(s.idle_w));
  if (s.late > 0) {
    fmt::print("{} of {} frames take longer than 1/{} s: the next one begins late\n", s.late,
               job.frames.size(), rounded(job.frame_rate));
  }
}

}  // namespace

std::vector<std::filesystem::path> files_of_path(const PathJob& job, const ResultFolder& out) {
  std::vector<std::filesystem::path> files = {out.path_report(), out.path_table(),
                                              out.contact_sheet()};
  for (std::size_t i = 0; i < job.frames.size(); ++i) files.push_back(out.frame(i));
  return files;
}

int run_path(const PathJob& job, RunSetting& setting, const ResultFolder& out) {
  const PreparedScene& scene = setting.scene;
  RunConfig& config = setting.config;
  const RunReport reports(config, setting.facts);
  const std::optional<RunConfig> later =
      with_codebooks(config, scene.stored.image.layout.second_half);
  Json report, lines = Json::array();
  std::vector<PathFrame> frames;
  ContactSheet sheet(job.frames.size());
  double energy_j = 0, worst_psnr_db = std::numeric_limits<double>::infinity();
  std::size_t worst_picture = 0;
  bool equal = true;
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    const std::string doubt = doubt_about(job.frames[i], scene.given());
    if (doubt.empty()) continue;
    fmt::print("frame {}: {}\n", i, doubt);
    break;  // the others likely say the same
  }
  const bool all = setting.detail == Detail::kAll;
  std::optional<ProgressLine> progress;
  if (!all) progress.emplace();
  if (all) print_table_head(setting.detail);
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    const RunConfig& machine = i > 0 && later ? *later : config;
    ViewResult view;
    try {
      view = simulate_view(scene, static_cast<int>(i), job.frames[i], machine, setting.technology,
                           setting.options);
    } catch (const InputError&) {
      throw;  // the configuration is at fault, not the frame
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("frame {} of {}: {}", i, job.name, error.what()));
    }
    const Json of_view = *reports.of_view(view, scene);
    if (i == 0) {
      for (const char* key : {"schema_version", "scene", "config", "chosen", "provenance"}) {
        report[key] = of_view[key];
      }
    }
    write_image(out.frame(i).string(), view.frame);
    if (i == 0) out.keep_only({out.frame(0)});
    if (all) {
      print_table_line(view, setting.detail);
      std::fflush(stdout);
    }
    if (progress) progress->say(fmt::format("{} of {} frames", i + 1, job.frames.size()));
    equal = equal && view.equals_golden;
    if (view.psnr_db < worst_psnr_db) worst_picture = i;
    worst_psnr_db = std::min(worst_psnr_db, view.psnr_db);
    frames.push_back({view.run.time_s(), view.energy_j.total.middle, idle_w(view)});
    energy_j += view.energy_j.total.middle;
    lines.push_back(line_of(of_view));
    lines.back()["camera"] = of_view["camera"];
    if (sheet.shows(i)) {
      sheet.add(view.frame, fmt::format("{} - {:.0f} FPS", i, 1 / view.run.time_s()));
    }
  }
  progress.reset();
  const PathSummary summary = summarise(frames, job.frame_rate);
  report["path"] = {{"name", job.name}};
  report["summary"] = to_json(summary, job, energy_j);
  report["frames"] = lines;
  for (Json& line : lines) line.erase("camera");
  OutputSet files;
  files.add(out.path_report().string()).write(report_text(report));
  files.add(out.path_table().string()).write(csv_of(lines));
  write_image(files.add(out.contact_sheet().string()), sheet.sheet());
  files.commit();
  print(summary, job, energy_j);
  if (std::isinf(worst_psnr_db)) {
    fmt::print("every frame equals its reference picture\n");
  } else {
    fmt::print("PSNR: worst {:.2f} dB (frame {})\n", worst_psnr_db, worst_picture);
  }
  if (!equal) fmt::print("\na frame differs from the streaming renderer's\n");
  fmt::print("\nwritten to {}\n", out.path_report().parent_path().string());
  return equal ? 0 : 1;
}

}  // namespace sgs
