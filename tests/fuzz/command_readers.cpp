// Readers of the command: configurations, devices and tables, packed scenes and checkpoints, paths
// and points, results and traces.
#include <zlib.h>

#include <cstring>
#include <utility>

#include "algorithm/storage/image_file.h"
#include "algorithm/storage/image_file_fields.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/train/checkpoint.h"
#include "modules/dram/command_trace.h"
#include "modules/dram/memspec.h"
#include "modules/dram/request_trace.h"
#include "modules/machines.h"
#include "testbench/cost/technology.h"
#include "testbench/streaminggs/report/report_diff.h"
#include "testbench/streaminggs/report/reported_run.h"
#include "testbench/streaminggs/run/camera_path.h"
#include "testbench/streaminggs/run/run_config.h"
#include "testbench/streaminggs/sweep/sweep_points.h"
#include "testbench/streaminggs/sweep/sweep_results.h"
#include "tests/fuzz/fuzzed_reader.h"
#include "tests/fuzz/zero_runs.h"

namespace sgs::test {
namespace {

template <class Value>
void put(std::string& bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::uint32_t crc_of(const char* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes), size));
}

// Length and checksum as image_file.h has them.
std::string packed_scene_of(const std::string& squeezed) {
  std::string bytes = with_runs(squeezed);
  if (bytes.size() < kFieldsAt + kChecksumBytes) return bytes;
  put(bytes, kLengthAt, std::uint64_t{bytes.size()});
  const std::size_t end = bytes.size() - kChecksumBytes;
  put(bytes, end, crc_of(bytes.data(), end));
  return bytes;
}

// Behind the magic number, of all that follows it.
std::string checkpoint_of(std::string bytes) {
  constexpr std::size_t kMagicBytes = 14, kBody = kMagicBytes + 4;
  if (bytes.size() < kBody) return bytes;
  put(bytes, kMagicBytes, crc_of(bytes.data() + kBody, bytes.size() - kBody));
  return bytes;
}

void read_config(const std::string& path) {
  ConfigDocument document;
  document.add_file(path);
  RunConfig config = read_run_config(document, machine_kinds());
  resolve(config);
  to_json(config);
}

void read_sweep_points(const std::string& path) {
  for (const SweepPoint& point : read_points(path)) {
    ConfigDocument document;
    for (const std::string& assignment : point.overrides) document.add_override(assignment);
    RunConfig config = read_run_config(document, machine_kinds());
    resolve(config);
  }
}

void read_command_trace(const std::string& path) {
  CommandTraceReader reader(path);
  for (CommandRecord record; reader.next(record);) {
  }
}

void read_report(const std::string& path) {
  const ReportedRun run = read_reported_run(path);
  diff_runs(run, run);
}

// read(path) of one file that needs nothing beside it.
template <class Read>
FuzzedReader of_file(const std::string& name, const std::string& file, const Read& read) {
  return {name, file, [read, file](const std::string& folder) { read(folder + "/" + file); }};
}

}  // namespace

const std::vector<FuzzedReader>& fuzzed_readers() {
  static const std::vector<FuzzedReader> readers = [] {
    std::vector<FuzzedReader> all = {
        of_file("config", "a.json", read_config),
        of_file("memspec", "a.json", [](const std::string& path) { load_memspec(path); }),
        of_file("technology", "a.json", [](const std::string& path) { load_technology(path); }),
        of_file("camera_path", "a.json",
                [](const std::string& path) { frames_along(read_camera_path(path, "a.ply"), 5); }),
        of_file("sweep_points", "a.txt", read_sweep_points),
        of_file("sweep_results", "a.jsonl", [](const std::string& path) { SweepResults{path}; }),
        of_file("report", "a.json", read_report),
        of_file("request_trace", "a", [](const std::string& path) { read_request_trace(path, 1.25); }),
        of_file("command_trace", "a", read_command_trace),
        of_file("packed", "a.sgs",
                [](const std::string& path) { restore_scene(read_image_file(path), path); }),
        of_file("checkpoint", "a", [](const std::string& path) { read_checkpoint(path); })};
    all[9].file_of = packed_scene_of;
    all[10].file_of = checkpoint_of;
    return all;
  }();
  return readers;
}

}  // namespace sgs::test
