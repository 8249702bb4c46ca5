// From lines of JSON to cells.
#include "testbench/streaminggs/sweep/sweep_table.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kOfPoint[] = {"scene",  "cameras", "view",        "size",
                                    "stereo", "config",  "fit_memories"};
// Keys of every configuration with groups, whoever chose them.
constexpr const char* kGroup[] = {"group_width_px", "group_height_px"};
// A column of a table, and where the report has it. On-chip memory that is needed has another name
// than the key that says how much there is.
struct Column {
  const char* name;
  const char* path;
};
constexpr Column kOfReport[] = {
    {"frame.cycles", "frame.cycles"},
    {"frame.time_s", "frame.time_s"},
    {"frame.fps", "frame.fps"},
    {"frame.width_px", "frame.width_px"},
    {"frame.height_px", "frame.height_px"},
    {"image.psnr_db", "image.psnr_db"},
    {"image.ssim", "image.ssim"},
    {"image.missed", "image.missed"},
    {"image.misordered", "image.misordered"},
    {"dram.bytes", "dram.bytes"},
    {"dram.bus_bytes", "dram.bus_bytes"},
    {"limit.ratio", "limit.ratio"},
    {"energy.total_j", "energy.total_j"},
    {"energy.mean_power_w", "energy.mean_power_w"},
    {"energy.memory_known", "energy.memory_known"},
    {"area_mm2.total", "area_mm2.total"},
    {"area_mm2.with_memory_interface.middle", "area_mm2.with_memory_interface.middle"},
    {"sram.input_needed_bytes", "sram.input_bytes"},
    {"sram.input_available_bytes", "sram.input_available_bytes"},
    {"sram.codebook_needed_bytes", "sram.codebook_bytes"},
    {"sram.codebook_available_bytes", "sram.codebook_available_bytes"},
    {"sram.shared_needed_bytes", "sram.shared_bytes"},
    {"sram.shared_available_bytes", "sram.shared_available_bytes"},
    {"sram.buffer_needed_bytes", "sram.buffer_bytes"},
    {"sram.buffer_available_bytes", "sram.buffer_available_bytes"},
    {"binding.unit", "binding.unit"},
    {"binding.utilisation", "binding.utilisation"},
    {"binding.holds", "binding.holds"},
    {"host.simulation_wall_s", "host.simulation_wall_s"},
};

// The value at "a.b.c"; null where there is none.
const Json* find(const Json& in, const std::string& path) {
  const Json* at = &in;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    if (!at->is_object()) return nullptr;
    const auto found = at->find(path.substr(begin, end - begin));
    if (found == at->end()) return nullptr;
    at = &*found;
    begin = end + 1;
  }
  return at;
}

std::string cell_of(const Json* value) {
  if (value == nullptr || value->is_null()) return {};
  return value->is_string() ? value->get<std::string>() : value->dump();
}

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string out = "\"";
  for (const char c : cell) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

void SweepTable::add_keys(const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    if (std::find(keys_.begin(), keys_.end(), key) == keys_.end()) keys_.push_back(key);
  }
}

void SweepTable::add(const std::string& line) {
  const Json result = Json::parse(line);
  Row row;
  const auto take = [&](const std::string& column, const Json* value) {
    row[column] = cell_of(value);
  };
  for (const char* column : {"key", "status", "reason"}) take(column, find(result, column));
  const Json& point = result.at("point");
  for (const char* column : kOfPoint) take(column, find(point, column));
  std::vector<std::string> keys;
  for (const auto& [key, value] : point.at("set").items()) {
    keys.push_back(key);
    take(key, &value);
  }
  if (const Json* report = find(result, "report")) {
    for (const Json& choice : report->at("chosen")) keys.push_back(choice.at("key"));
    keys.insert(keys.end(), std::begin(kGroup), std::end(kGroup));
    for (const std::string& key : keys) take(key, find(report->at("config"), key));
    for (const Column& column : kOfReport) take(column.name, find(*report, column.path));
    // JSON has no infinity: the frame is the reference picture.
    const Json* psnr = find(*report, "image.psnr_db");
    if (psnr != nullptr && psnr->is_null()) row["image.psnr_db"] = "inf";
  }
  add_keys(keys);
  rows_.push_back(std::move(row));
}

std::string SweepTable::csv() const {
  std::vector<std::string> columns(std::begin(kOfPoint), std::end(kOfPoint));
  columns.insert(columns.end(), keys_.begin(), keys_.end());
  columns.insert(columns.end(), {"status", "reason"});
  for (const Column& column : kOfReport) columns.emplace_back(column.name);
  columns.emplace_back("key");
  // A quantity that no machine of this sweep has gets no column.
  const auto empty = [&](const std::string& column) {
    return std::none_of(rows_.begin(), rows_.end(), [&](const Row& row) {
      const auto cell = row.find(column);
      return cell != row.end() && !cell->second.empty();
    });
  };
  columns.erase(std::remove_if(columns.begin(), columns.end(), empty), columns.end());
  std::string text;
  for (const std::string& column : columns) text += (text.empty() ? "" : ",") + quoted(column);
  text += '\n';
  for (const Row& row : rows_) {
    std::string cells;
    for (const std::string& column : columns) {
      const auto cell = row.find(column);
      cells += (&column == &columns.front() ? "" : ",") +
               (cell == row.end() ? std::string() : quoted(cell->second));
    }
    text += cells + '\n';
  }
  return text;
}

}  // namespace sgs
