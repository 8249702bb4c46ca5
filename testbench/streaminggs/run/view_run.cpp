// Files of views.
#include "testbench/streaminggs/run/view_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/image/image_formats.h"
#include "algorithm/image/image_io.h"
#include "testbench/streaminggs/report/error_maps.h"
#include "testbench/streaminggs/report/group_table.h"
#include "testbench/streaminggs/report/terminal.h"
#include "testbench/streaminggs/run/camera_check.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

// All files of a view at once: no picture stands beside the report of another run.
void write_view(const fs::path& folder, const ViewResult& view, const std::string& report) {
  OutputSet files;
  const auto add = [&](const std::string& file) -> OutputFile& {
    return files.add((folder / file).string());
  };
  write_image(add("frame.exr"), view.frame);
  write_image(add("reference.exr"), view.reference);
  // With 8 bits a channel both pictures are often the same.
  const std::string frame = encode_png(view.frame);
  add("frame.png").write(frame);
  add("reference.png")
      .write(same_png(view.frame, view.reference) ? frame : encode_png(view.reference));
  add("report.json").write(report);
  std::set<std::string> old(std::begin(kErrorMapFiles), std::end(kErrorMapFiles));
  old.insert(std::begin(kRightEyeFiles), std::end(kRightEyeFiles));
  if (view.right) {
    write_image(add(kRightEyeFiles[0]), view.right->frame);
    add(kRightEyeFiles[1]).write(encode_png(view.right->frame));
    write_image(add(kRightEyeFiles[2]), view.right->reference);
    for (const char* file : kRightEyeFiles) old.erase(file);
  }
  old.insert(kGroupTableFile);
  if (const std::string groups = group_table(view); !groups.empty()) {
    add(kGroupTableFile).write(groups);
    old.erase(kGroupTableFile);
  }
  for (const ErrorMap& map : error_maps(view)) {
    write_image(add(map.file), map.image);
    old.erase(map.file);
  }
  files.commit();
  for (const std::string& file : old) fs::remove(folder / file);
}

// Several views share a short line each.
void print_views(const std::vector<ViewResult>& views, const RunSetting& setting) {
  const bool all = setting.detail == Detail::kAll;
  for (const ViewResult& view : views) {
    if (all || &view == &views.front()) fmt::print("\n");
    print_bottleneck(view);
    print_right_eye(view);
    print_fixed_rates(view);
    if (!all && views.size() > 1) continue;
    print_energy(view);
    if (all) print_losses(view);
    print_regions(view);
  }
}

}  // namespace

std::vector<fs::path> files_of_views(const NumberedCameras& views, const ResultFolder& out) {
  std::vector<fs::path> files;
  for (const auto& [number, camera] : views) {
    const std::vector<fs::path> of_view = ResultFolder::files_of(out.view(number));
    files.insert(files.end(), of_view.begin(), of_view.end());
  }
  return files;
}

int run_views(const NumberedCameras& views, RunSetting& setting, const ResultFolder& out,
              bool dropping) {
  RunReport report(setting.config, setting.facts);
  std::vector<std::pair<int, std::string>> failed;
  std::vector<ViewResult> results;
  bool equal = true, all_refused = true;
  std::size_t named = 0;  // among failed
  for (const auto& [number, camera] : views) {
    const std::string doubt = doubt_about(camera, setting.scene.given());
    if (!doubt.empty()) fmt::print("view {}: {}\n", number, doubt);
  }
  print_table_head(setting.detail);
  for (const auto& [number, camera] : views) {
    try {
      ViewResult view = simulate_view(setting.scene, number, camera, setting.config,
                                      setting.technology, setting.options);
      const auto of_view = report.of_view(view, setting.scene);
      write_view(out.view(number), view, report_text(*of_view));
      if (results.empty()) out.keep_only(ResultFolder::files_of(out.view(number)));
      print_table_line(view, setting.detail);
      equal = equal && view.equals_golden;
      report.add(*of_view);
      results.push_back(std::move(view));
    } catch (const std::exception& error) {
      if (views.size() == 1) throw;
      failed.emplace_back(number, error.what());
      all_refused = all_refused && dynamic_cast<const InputError*>(&error) != nullptr;
    }
    std::fflush(stdout);
    if (all_refused && results.empty()) continue;  // one line is enough if it goes on like this
    for (; named < failed.size(); ++named) {
      fmt::print(stderr, "streaminggs: view {}: {}\n", failed[named].first, failed[named].second);
    }
  }
  if (results.empty() && all_refused) {
    const auto& [number, why] = failed.front();
    throw InputError(
        fmt::format("view {}: {}; none of {} views can be drawn", number, why, views.size()));
  }
  if (results.empty()) throw std::runtime_error("no view could be finished");
  const std::string text = report.text(failed);
  write_whole_file(out.report().string(), text.data(), text.size());
  print_views(results, setting);
  const auto empty = std::count_if(results.begin(), results.end(), is_empty);
  if (results.size() > 1) print_empty(static_cast<std::size_t>(empty), results.size(), "views");
  print_scene(setting.scene, setting.config, dropping);
  print_unknown_energy(results.front());
  print_area(results.front(), setting.technology.name, setting.detail);
  if (setting.detail == Detail::kAll) print_lanes(results.front());
  print_choices(setting.config.chosen, setting.detail);
  for (const auto& [view, why] : failed) fmt::print("\nview {} failed: {}\n", view, why);
  if (!equal) fmt::print("\nthe frame differs from the streaming renderer's\n");
  fmt::print("\nwritten to {}\n", out.report().parent_path().string());
  return equal && failed.empty() ? 0 : 1;
}

}  // namespace sgs
