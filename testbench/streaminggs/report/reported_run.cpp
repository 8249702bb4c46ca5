// Reading of report.json.
#include "testbench/streaminggs/report/reported_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "testbench/streaminggs/report/report.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

void add(ReportedQuantity& to, const std::string& name, double amount) {
  ReportedPart& part = to.parts[without_numbers(name)];
  part.sum += amount;
  part.copies += 1;
}

// A text as it is, all else as JSON has it.
std::string in_words(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void flatten(const JsonPlace& place, const std::string& path,
             std::map<std::string, std::string>& into) {
  for (const auto& [key, value] : place.members()) {
    const std::string name = path.empty() ? key : path + "." + key;
    if (value.json().is_object()) {
      flatten(value, name, into);
    } else {
      into[name] = value.json().dump();
    }
  }
}

void add_activity(const std::string& name, const JsonPlace& activity, ReportedView& view) {
  add(view.of(Quantity::kBusy), name, activity.at("busy_cycles").number());
  for (const JsonPlace& wait : activity.at("waits").elements()) {
    const std::string what = wait.at("for").text();
    const double cycles = wait.at("cycles").number();
    if (what == "idle") continue;
    view.of(Quantity::kWaits).whole += cycles;
    const std::string at = wait.has("on") ? " at " + wait.at("on").text() : "";
    add(view.of(Quantity::kWaits), name + ": " + what + at, cycles);
  }
}

void add_units(const JsonPlace& units, ReportedView& view) {
  for (const auto& [unit, of_unit] : units.members()) {
    for (const auto& [name, activity] : of_unit.at("activities").members()) {
      add_activity(unit + "." + name, activity, view);
    }
  }
  ReportedQuantity& waits = view.of(Quantity::kWaits);
  double activities = 0;
  for (const auto& [name, part] : view.of(Quantity::kBusy).parts) activities += part.copies;
  if (activities > 0) waits.whole /= activities;
  // Who waits at several places of one kind stands there once.
  for (auto& [name, wait] : waits.parts) {
    wait.copies = view.of(Quantity::kBusy).parts.at(name.substr(0, name.find(": "))).copies;
  }
}

void add_bytes(const JsonPlace& dram, ReportedQuantity& to) {
  to.whole = dram.at("bytes").number();
  for (const auto& [region, requesters] : dram.at("bytes_by_region").members()) {
    for (const auto& [requester, directions] : requesters.members()) {
      for (const auto& [direction, bytes] : directions.members()) {
        add(to, region + ": " + requester + " " + direction, bytes.number());
      }
    }
  }
}

// Keys of a section of costs: components, their total, and beside them what is none of these.
void add_costs(const JsonPlace& section, const std::string& suffix, ReportedQuantity& to) {
  const std::string total = "total" + suffix;
  to.whole = section.at(total).number();
  for (const auto& [key, band] : section.at("bands").members()) {
    if (key == total) continue;
    add(to, key.substr(0, key.size() - std::min(suffix.size(), key.size())),
        section.at(key).number());
  }
}

// Reports of earlier programs have no owners: the whole stays 0.
void add_owners(const JsonPlace& area, ReportedQuantity& to) {
  if (!area.has("by_owner")) return;
  to.whole = area.at("with_memory_interface").at("middle").number();
  for (const auto& [owner, mm2] : area.at("by_owner").members()) add(to, owner, mm2.number());
}

// As many digits as a pose has: files of cameras that tell it in other ways differ beyond.
std::string in_digits(const JsonPlace& place) {
  if (place.json().is_array()) {
    std::string text;
    for (const JsonPlace& element : place.elements()) {
      text += (text.empty() ? "" : " ") + in_digits(element);
    }
    return text;
  }
  constexpr double kSteps = 1e6;
  return fmt::format("{}", std::round(place.number() * kSteps) / kSteps + 0.0);  // no -0
}

std::string plain(const JsonPlace& place) { return in_words(place.json()); }

void add_scene(const JsonPlace& scene, ReportedView& view) {
  view.facts.emplace_back(
      "scene", fmt::format("{}, {} Gaussians, SH degree {}, {} dropped", plain(scene.at("name")),
                           plain(scene.at("gaussians")), plain(scene.at("sh_degree")),
                           plain(scene.at("dropped_invalid"))));
}

void add_camera(const JsonPlace& report, ReportedView& view) {
  const auto fact = [&](const char* kind, std::string what) {
    view.facts.emplace_back(kind, std::move(what));
  };
  const JsonPlace camera = report.at("camera"), frame = report.at("frame");
  // Reports of earlier programs tell the camera's name alone. A pose has other names in other
  // files.
  if (camera.has("position")) {
    fact("camera stands at", in_digits(camera.at("position")));
    fact("camera is turned", in_digits(camera.at("rotation")));
    fact("focal lengths, px",
         fmt::format("{} {}", in_digits(camera.at("fx_px")), in_digits(camera.at("fy_px"))));
    fact("principal point, px",
         camera.has("cx_px")
             ? fmt::format("{} {}", in_digits(camera.at("cx_px")), in_digits(camera.at("cy_px")))
             : "in the middle");
  } else {
    fact("camera", fmt::format("{} ({})", plain(camera.at("id")), plain(camera.at("img_name"))));
  }
  fact("size, px", fmt::format("{}x{}", plain(frame.at("width_px")), plain(frame.at("height_px"))));
}

void add_program(const JsonPlace& provenance, ReportedView& view) {
  const auto fact = [&](const char* kind, std::string what) {
    view.facts.emplace_back(kind, std::move(what));
  };
  fact("technology", plain(provenance.at("technology")));
  // Reports of earlier programs have a hash of another kind.
  if (provenance.has("technology_xxh64")) {
    fact("technology's hash", plain(provenance.at("technology_xxh64")));
  }
  fact("program",
       fmt::format("{} {}", plain(provenance.at("version")), plain(provenance.at("commit"))));
}

std::string psnr_in_words(const JsonPlace& psnr_db) {
  return psnr_db.json().is_null() ? "equal" : fmt::format("{:.2f}", psnr_db.number());
}

// What a simulation counted.
void add_counts(const JsonPlace& report, ReportedView& view) {
  view.cycles = report.at("frame").at("cycles").number();
  const JsonPlace provenance = report.at("provenance");
  // Reports of earlier programs lack it.
  if (provenance.has("memory_image_xxh64")) {
    view.image_hash = provenance.at("memory_image_xxh64").text();
  }
  view.holds = report.at("binding").at("holds").text();
  add_units(report.at("units"), view);
  view.of(Quantity::kTime).whole = report.at("frame").at("time_s").number();
  view.of(Quantity::kBusy).whole = view.cycles;
  add_bytes(report.at("dram"), view.of(Quantity::kBytes));
  const JsonPlace energy = report.at("energy");
  add_costs(energy, "_j", view.of(Quantity::kJoules));
  // Reports of earlier programs lack it.
  view.memory_known = !energy.has("memory_known") || energy.at("memory_known").json() == true;
  view.facts.emplace_back("energy", view.memory_known ? "with the memory's"
                                                      : "without the memory's, which is not known");
  add_costs(report.at("area_mm2"), "", view.of(Quantity::kArea));
  add_owners(report.at("area_mm2"), view.of(Quantity::kDieArea));
}

ReportedView read_view(const JsonPlace& report) {
  ReportedView view;
  view.view = static_cast<int>(report.at("view").number());
  add_scene(report.at("scene"), view);
  add_camera(report, view);
  add_program(report.at("provenance"), view);
  const JsonPlace image = report.at("image");
  view.psnr_db = psnr_in_words(image.at("psnr_db"));
  view.equals = image.at("equals_streaming_renderer").json() == true;
  add_counts(report, view);
  return view;
}

// Frames back to back as one view: its picture is the worst of theirs.
ReportedView read_stream(const JsonPlace& report) {
  const JsonPlace stream = report.at("stream"), all = stream.at("all");
  ReportedView view;
  add_scene(all.at("scene"), view);
  const std::vector<JsonPlace> frames = stream.at("frames").elements();
  view.facts.emplace_back(
      "path", fmt::format("{}, {} frames", plain(report.at("path").at("name")), frames.size()));
  view.facts.emplace_back("pictures a second", plain(stream.at("frame_rate")));
  add_program(all.at("provenance"), view);
  double worst_db = std::numeric_limits<double>::infinity();
  view.psnr_db = "equal";
  for (const JsonPlace& frame : frames) {
    view.equals = view.equals && frame.at("equals_streaming_renderer").json() == true;
    const JsonPlace psnr_db = frame.at("psnr_db");
    if (psnr_db.json().is_null() || psnr_db.number() >= worst_db) continue;
    worst_db = psnr_db.number();
    view.psnr_db = psnr_in_words(psnr_db);
  }
  add_counts(all, view);
  return view;
}

// Unused memory is not built: what a key gives may be more than the machine has.
void add_used(const JsonPlace& view, ReportedRun& run) {
  if (!view.has("sram")) return;
  for (const auto& [key, bytes] : view.at("sram").members()) {
    const std::string path = "sram." + key;
    if (run.config.count(path) > 0) run.used[path] = bytes.json().dump();
  }
}

void check_version(const JsonPlace& report) {
  const JsonPlace version = report.at("schema_version");
  if (version.json() != kReportVersion) version.refuse(fmt::format("{}", kReportVersion));
}

}  // namespace

std::string without_numbers(const std::string& name) {
  std::string out;
  bool in_number = false;
  for (const char c : name) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!digit) {
      out += c;
    } else if (!in_number) {
      out += 'N';
    }
    in_number = digit;
  }
  return out;
}

ReportedRun read_reported_run(const std::string& path) {
  std::error_code unknown;
  ReportedRun run;
  run.path = path;
  if (std::filesystem::is_directory(path, unknown)) {
    run.path = (std::filesystem::path(path) / "report.json").string();
  }
  const Json json = read_json(run.path);
  const JsonPlace report(run.path, json);
  check_version(report);
  flatten(report.at("config"), "", run.config);
  JsonPlace first = report;
  run.stream = report.has("stream");
  if (run.stream) {
    run.views.push_back(read_stream(report));
    first = report.at("stream").at("all");
  } else if (report.has("views")) {
    const JsonPlace views = report.at("views");
    for (const JsonPlace& view : views.elements()) run.views.push_back(read_view(view));
    if (run.views.empty()) views.refuse("a finished view or more");
    first = views.elements()[0];
  } else {
    run.views.push_back(read_view(report));
  }
  add_used(first, run);
  for (const JsonPlace& choice : first.at("chosen").elements()) {
    run.chosen.insert(choice.at("key").text());
  }
  std::sort(run.views.begin(), run.views.end(),
            [](const ReportedView& a, const ReportedView& b) { return a.view < b.view; });
  return run;
}

}  // namespace sgs
