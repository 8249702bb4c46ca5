// Reading of what describe prints, and the draw.
#include "tests/system/hostile_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <regex>
#include <sstream>

#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

// Not drawn one by one: which machine, names of files, seeds, what must fit the rest or an option.
bool left_alone(const std::string& name) {
  for (const char* key : {"machine", "eyes", "culling.by", "dram.memspec", "dram.mapping",
                          "dram.current_set", "storage.vq.seed"}) {
    if (name == key) return true;
  }
  return name.rfind("sram.", 0) == 0 || name.rfind("dram.write_", 0) == 0;
}

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream in(list);
  for (std::string word; in >> word;) {
    if (word.back() == ',') word.pop_back();
    words.push_back(word);
  }
  return words;
}

std::vector<StatedKey> read_keys(const std::string& preset) {
  const Outcome outcome = run_streaminggs({"describe", "--config", preset});
  REQUIRE(outcome.status == 0);
  const std::regex line_of_key(R"(^([a-z0-9_.]+) = (\S*)  \(([^)]*)\)  .*)");
  const std::regex range(R"(^(-?[0-9.e+]+)\.\.([0-9.e+]+)(?:, null)?$)");
  std::vector<StatedKey> keys;
  std::istringstream in(outcome.out);
  for (std::string line; std::getline(in, line);) {
    std::smatch key, ends;
    if (!std::regex_match(line, key, line_of_key) || left_alone(key[1])) continue;
    StatedKey stated{key[1], key[2], {}, 0, 0};
    const std::string allowed = key[3];
    if (std::regex_match(allowed, ends, range)) {
      stated.low = std::stod(ends[1]);
      stated.high = std::stod(ends[2]);
    } else {
      stated.choices = words_of(allowed);
    }
    keys.push_back(stated);
  }
  REQUIRE(keys.size() > 20);
  return keys;
}

std::string draw(std::mt19937_64& random, const StatedKey& key) {
  const auto pick = [&](std::size_t choices) { return random() % choices; };
  if (!key.choices.empty()) return key.choices[pick(key.choices.size())];
  const double now = key.value == "null" ? key.low : std::stod(key.value);
  const double usual = std::max(1.0, now);
  double value = 0;
  switch (pick(8)) {
    case 0:
      value = key.low;
      break;
    case 1:
      value = key.low + 1;
      break;
    case 2:
      value = key.low + static_cast<double>(pick(8));
      break;
    case 3:
      value = std::floor(usual / 2);
      break;
    case 4:
      value = usual * 2;
      break;
    case 5:
      value = usual + static_cast<double>(pick(16));
      break;
    case 6:
      value = usual * static_cast<double>(1 + pick(16));
      break;
    // What nothing is built of is drawn to its end; memories and lanes have no use for it.
    default:
      value = std::min(key.high, 64 * usual);
  }
  value = std::clamp(value, key.low, key.high);
  // Sides of groups and the like are multiples of 4: so that most are.
  if (value > 4 && pick(4) != 0) value = std::clamp(4 * std::floor(value / 4), key.low, key.high);
  return fmt::format("{}", value);
}

}  // namespace

std::vector<StatedKey> stated_keys(const std::string& preset) {
  static std::map<std::string, std::vector<StatedKey>> known;
  auto& keys = known[preset];
  if (keys.empty()) keys = read_keys(preset);
  return keys;
}

std::vector<std::string> drawn_settings(std::mt19937_64& random, const std::string& preset,
                                        int count) {
  const std::vector<StatedKey> keys = stated_keys(preset);
  std::vector<std::string> settings;
  for (int i = 0; i < count; ++i) {
    const StatedKey& key = keys[random() % keys.size()];
    settings.push_back(key.name + "=" + draw(random, key));
  }
  // A queue and its watermarks only go together.
  if (count > 4 && random() % 2 == 0) {
    const std::uint64_t entries = 1 + random() % 40, high = 1 + random() % entries;
    settings.push_back(fmt::format("dram.write_queue_entries={}", entries));
    settings.push_back(fmt::format("dram.write_high_watermark={}", high));
    settings.push_back(fmt::format("dram.write_low_watermark={}", random() % high));
  }
  return settings;
}

}  // namespace sgs::test
