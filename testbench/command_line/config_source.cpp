// Options and reading of config_source.h.
#include "testbench/command_line/config_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "algorithm/files/input_error.h"
#include "testbench/command_line/presets.h"

namespace sgs {
namespace {

constexpr std::string_view kGroup = "group=";  // a side in px, or WIDTHxHEIGHT

// The assignments that one of --set stands for. Throws InputError for a group without sides.
std::vector<std::string> expanded(const std::string& assignment) {
  if (assignment.rfind(kGroup, 0) != 0) return {assignment};
  const std::string shape = assignment.substr(kGroup.size());
  const std::size_t between = shape.find('x');
  const std::string width = shape.substr(0, between);
  const std::string height = between == std::string::npos ? width : shape.substr(between + 1);
  for (const std::string& side : {width, height}) {
    if (side.empty() || side.find_first_not_of("0123456789") != std::string::npos) {
      throw InputError(
          fmt::format("--set group: got '{}', expected px as in 64 or 160x120", shape));
    }
  }
  return {"group_width_px=" + width, "group_height_px=" + height};
}

std::string preset_words(const std::string& name) { return "preset " + name; }

// The values of a file over those of the preset that is its base, if any. above: presets that are
// being read, each with the next one as its base.
ConfigDocument over_its_base(const std::string& path, const std::string& origin,
                             std::vector<std::string> above) {
  ConfigDocument own;
  own.add_file(path, origin);
  const std::vector<std::string> presets = preset_names();
  const std::string base = own.take_text("base", "one of " + join(presets));
  if (base.empty()) return own;
  if (std::find(presets.begin(), presets.end(), base) == presets.end()) {
    throw InputError(fmt::format("{}: base: got {}{}one of {}", origin, base,
                                 then_expected(did_you_mean(base, presets)), join(presets)));
  }
  if (std::find(above.begin(), above.end(), base) != above.end()) {
    throw InputError(
        fmt::format("{}: base: got {}, expected a preset without it as its base", origin, base));
  }
  above.push_back(base);
  ConfigDocument document = over_its_base(config_file(base), preset_words(base), above);
  document.add(own);
  return document;
}

}  // namespace

std::string ConfigSource::preset_in_words() const {
  return is_preset() ? preset_words(config) : "";
}

void ConfigSource::add_to(CommandLine& line, const std::string& otherwise) {
  line.file("--config", config,
            fmt::format("JSON file or preset: {}{}", join(preset_names()), otherwise).c_str());
  line.texts("--set", overrides,
             "key.path=value, over the configuration; may be repeated; group=64 or group=160x120 "
             "are both sides of a pixel group");
}

void ConfigSource::add_fitting_to(CommandLine& line) {
  line.flag("--fit-memories", fit_memories,
            "on-chip memories as large as all else needs; their sizes in the configuration still "
            "decide what it leaves open, such as groups and lists");
}

std::string ConfigSource::path() const { return config.empty() ? "" : config_file(config); }

bool ConfigSource::is_preset() const {
  const std::vector<std::string> presets = preset_names();
  return std::find(presets.begin(), presets.end(), config) != presets.end();
}

std::string ConfigSource::name() const { return std::filesystem::path(path()).stem().string(); }

std::string ConfigSource::in_words() const {
  std::string what = config.empty() ? "defaults" : name();
  std::set<std::string> keys;  // the last of one key's settings holds
  for (const std::string& assignment : overrides) {
    keys.insert(assignment.substr(0, assignment.find('=')));
  }
  if (!keys.empty()) {
    what += fmt::format(" + {} setting{}", keys.size(), keys.size() == 1 ? "" : "s");
  }
  return fit_memories ? what + ", memories fitted" : what;
}

ConfigDocument ConfigSource::document() const {
  ConfigDocument document;
  if (is_preset()) {
    document = over_its_base(path(), preset_in_words(), {config});
  } else if (!config.empty()) {
    document = over_its_base(path(), path(), {});
  }
  const std::string machine = document.text_at("machine");
  for (const std::string& assignment : overrides) {
    for (const std::string& one : expanded(assignment)) document.add_override(one);
  }
  const std::string other = document.text_at("machine");
  if (is_preset() && other != machine && ConfigSource{other, {}}.is_preset()) {
    throw InputError(fmt::format("--set machine={}: preset {} is of machine {}, take --config {}",
                                 other, config, machine, other));
  }
  return document;
}

}  // namespace sgs
