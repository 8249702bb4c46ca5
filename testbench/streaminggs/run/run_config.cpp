// Reading and resolving of the three configurations.
#include "testbench/streaminggs/run/run_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "algorithm/storage/storage_scheme.h"
#include "modules/config/unknown_key.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/memspec.h"
#include "modules/memory_too_small.h"
#include "modules/storage_keys.h"

namespace sgs {

std::string readers_of(const std::vector<MachineKind>& kinds, StorageOrder order) {
  std::string names;
  for (const MachineKind& kind : kinds) {
    if (kind.design()->storage_order() != order) continue;
    names += fmt::format("{}{}", names.empty() ? "" : " or ", kind.name);
  }
  return names;
}

namespace {

using Json = nlohmann::ordered_json;

// Of "key.path".
Json::json_pointer pointer_to(std::string path) {
  std::replace(path.begin(), path.end(), '.', '/');
  return Json::json_pointer("/" + path);
}

// key: below `storage`. A size left open is whatever the file holds; real ones have that of a
// float.
bool agree(const StorageScheme& scheme, const std::string& key, const Json& said,
           const Json& held) {
  for (const StorageSize& size : scheme.sizes()) {
    if (key == size.key && said == 0) return true;
  }
  if (scheme.has_voxel_rule() && key == "voxel_rule") return true;  // a file holds a size
  return said.is_number_float() ? said.get<float>() == held.get<float>() : said == held;
}

// "vq, voxels of 0.4"
std::string in_words(const StorageConfig& storage) {
  return fmt::format("{}, {}", kEncodingNames[static_cast<std::size_t>(storage.encoding)],
                     scheme_of(storage.order).in_words(storage));
}

// The line of RunConfig::storage_source. Throws InputError when somebody but the preset disagrees.
std::string compared(const RunConfig& config, const PackedScene& packed, const std::string& path,
                     const std::string& preset) {
  const Json said = {{"storage", parse_json(config_to_json(config.storage), "the configuration")}};
  const Json held = {{"storage", parse_json(config_to_json(packed.storage), path)}};
  std::string differs;
  for (const ConfigOrigin& value : config.origins) {
    if (value.path.rfind("storage.", 0) != 0) continue;
    const Json &a = said.at(pointer_to(value.path)), &b = held.at(pointer_to(value.path));
    const std::string key = value.path.substr(value.path.find('.') + 1);
    if (agree(scheme_of(packed.storage.order), key, a, b)) continue;
    const std::string got = a.is_string() ? a.get<std::string>() : a.dump();
    if (value.origin != preset) {
      throw InputError(fmt::format("{}: {}: got {}, expected {}: {} is stored so", value.origin,
                                   value.path, got, b.is_string() ? b.get<std::string>() : b.dump(),
                                   path));
    }
    differs += (differs.empty() ? "" : ", ") + (key == "encoding" ? got : key + " " + got);
  }
  return fmt::format("storage from {}: {}{}", std::filesystem::path(path).filename().string(),
                     in_words(packed.storage),
                     differs.empty() ? "" : fmt::format(" ({}: {})", preset, differs));
}

bool is_override(const ConfigOrigin& value) { return value.origin.rfind("--set ", 0) == 0; }

// Where a value is from that does not go with the others: what stands in a file was right before
// the overrides.
std::string place_of(const ConfigOrigin& value, const RunConfig& config) {
  if (is_override(value)) return value.origin;
  std::string overrides;
  for (const ConfigOrigin& other : config.origins) {
    if (is_override(other)) overrides += " " + other.origin;
  }
  return value.origin + (overrides.empty() ? "" : " with") + overrides;
}

// A size that a document gives, not 0, of a memory that can be fitted.
struct GivenSize {
  ConfigOrigin from;
  std::string bytes;
};

std::vector<GivenSize> sizes_given(RunConfig& config) {
  const Json values = parse_json(to_json(config), "the configuration");
  std::vector<GivenSize> sizes;
  for (const char* key : (*config.kinds)[config.kind].design()->fit_memories()) {
    const Json& bytes = values.at(pointer_to(key));
    for (const ConfigOrigin& value : config.origins) {
      if (value.path == key && bytes != 0) sizes.push_back({value, bytes.dump()});
    }
  }
  return sizes;
}

void refuse_sizes_of_overrides(RunConfig& config) {
  for (const GivenSize& size : sizes_given(config)) {
    if (!is_override(size.from)) continue;
    throw InputError(
        fmt::format("{}: got it with --fit-memories, expected one of the two", size.from.origin));
  }
}

void resolve_machine(RunConfig& config) {
  naming_origins(config, [&] {
    config.dram.validate();
    const Memspec device = load_memspec(config.dram.memspec);
    const AddressMapping mapping(config.dram, device);
    config.dram.refresh_postpone_max =
        static_cast<std::int32_t>(config.dram.refreshes_postponed(device));
    config.add_choices(scheme_of(config.storage.order).choose(config.storage, mapping.run_bytes()));
    config.design->resolve(config.storage, config.chosen);
  });
}

RunConfig defaults_of(const MachineKind& kind, const std::vector<MachineKind>& kinds,
                      const std::string& setting = "") {
  ConfigDocument document;
  document.add_override(fmt::format("machine={}", kind.name));
  if (!setting.empty()) document.add_override(setting);
  return read_run_config(document, kinds);
}

// As paths.
std::vector<std::string> keys_of(RunConfig& config) {
  ConfigDocument document;
  document.add_text(to_json(config), "the configuration");
  std::vector<std::string> keys;
  for (const ConfigOrigin& value : document.origins()) keys.push_back(value.path);
  return keys;
}

// A setting by which a machine is not as by its defaults, and the default, as "key=value" each.
struct Deciding {
  std::string set, by_default;
};

// The one of `origins` without which `holds` of the defaults, and with which alone it does not;
// none where it takes several. config: of these settings, as far as it could be read.
std::optional<Deciding> deciding_setting(RunConfig& config,
                                         const std::vector<ConfigOrigin>& origins,
                                         const std::function<bool(RunConfig&)>& holds) {
  const MachineKind& kind = (*config.kinds)[config.kind];
  RunConfig defaults = defaults_of(kind, *config.kinds);
  if (!holds(defaults)) return {};
  const Json set = parse_json(to_json(config), "the configuration");
  const Json unset = parse_json(to_json(defaults), "the defaults");
  const auto in_words = [](const std::string& key, const Json& value) {
    return key + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
  };
  for (const ConfigOrigin& value : origins) {
    const Json::json_pointer place = pointer_to(value.path);
    if (!set.contains(place) || !unset.contains(place) || set[place] == unset[place]) continue;
    const std::string setting = in_words(value.path, set[place]);
    RunConfig with = defaults_of(kind, *config.kinds, setting);
    if (!holds(with)) return Deciding{setting, in_words(value.path, unset[place])};
  }
  return {};
}

// Whether it has such a key, or a section of that name.
bool has_key(RunConfig& config, const std::string& key) {
  const std::vector<std::string> keys = keys_of(config);
  return std::any_of(keys.begin(), keys.end(), [&](const std::string& other) {
    return other == key || other.rfind(key + ".", 0) == 0;
  });
}

// The kinds of machine that have it by their defaults.
std::vector<std::string> kinds_with(const std::string& key, const std::vector<MachineKind>& kinds) {
  std::vector<std::string> names;
  for (const MachineKind& kind : kinds) {
    RunConfig config = defaults_of(kind, kinds);
    if (has_key(config, key)) names.emplace_back(kind.name);
  }
  return names;
}

// A file may be of many encodings, as --print-config's are.
void check_codebook_keys(const RunConfig& config) {
  if (SecondHalfFormat{config.storage.encoding, 0, {}}.quantised()) return;
  for (const ConfigOrigin& value : config.origins) {
    const bool of_codebooks =
        value.path.rfind("storage.vq.", 0) == 0 || value.path.rfind("codebook.", 0) == 0;
    if (!of_codebooks || !is_override(value)) continue;
    throw InputError(fmt::format(
        "{}: got it with storage.encoding {}, which has no codebooks, expected vq or "
        "vq_packed",
        value.origin, kEncodingNames[static_cast<std::size_t>(config.storage.encoding)]));
  }
}

}  // namespace

void naming_origins(const RunConfig& config, const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    const bool could_fit =
        !config.memories_fitted && dynamic_cast<const MemoryTooSmall*>(&error) != nullptr;
    const std::string told = error.what();
    const std::string message = told + (could_fit ? "; --fit-memories sizes it" : "");
    const std::string key = told.substr(0, told.find(": "));
    for (const char* section : {"", "storage."}) {
      for (const ConfigOrigin& value : config.origins) {
        if (value.path != section + key) continue;
        throw InputError(fmt::format("{}: {}{}", place_of(value, config), section,
                                     is_override(value) ? told : message));
      }
    }
    if (could_fit) throw InputError(message);
    throw;
  }
}

void RunConfig::add_choices(const std::vector<StorageChoice>& choices) {
  for (const StorageChoice& choice : choices) {
    chosen.push_back(
        {ChoiceKind::kDecided, fmt::format("storage.{}", choice.key), choice.value, choice.why});
  }
}

void visit(ConfigVisitor& v, RunConfig& c) {
  std::vector<const char*> names;
  for (const MachineKind& kind : *c.kinds) names.push_back(kind.name);
  const std::size_t before = c.kind;
  v.choice("machine", c.kind, names, "which accelerator; its keys stand beside this one");
  if (!c.design || c.kind != before) c.design = (*c.kinds)[c.kind].design();
  c.design->visit(v);
  c.storage.order = c.design->storage_order();
  v.section("storage", c.storage, "how the scene is stored");
  v.section("dram", c.dram, "memory");
}

std::vector<std::string> keys_of(const std::vector<MachineKind>& kinds) {
  std::vector<std::string> keys;
  for (const MachineKind& kind : kinds) {
    RunConfig config = defaults_of(kind, kinds);
    for (const std::string& key : keys_of(config)) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  }
  return keys;
}

RunConfig read_run_config(const ConfigDocument& document, const std::vector<MachineKind>& kinds) {
  RunConfig config;
  config.kinds = &kinds;
  try {
    document.read_into(config);
  } catch (const UnknownKey& error) {
    const auto has_it = [&](RunConfig& other) { return has_key(other, error.path); };
    if (const auto by = deciding_setting(config, document.origins(), has_it)) {
      throw InputError(
          fmt::format("{}; not with {}, but with {}", error.what(), by->set, by->by_default));
    }
    std::vector<std::string> others = kinds_with(error.path, kinds);
    // A key that its own machine would have by several other keys is just unknown.
    others.erase(std::remove(others.begin(), others.end(), config.machine()), others.end());
    if (others.empty()) throw;
    throw InputError(fmt::format("{}; it is a key of machine {}, not of {}", error.what(),
                                 join(others, " and "), config.machine()));
  }
  config.origins = document.origins();
  return config;
}

RunConfig read_run_config(const ConfigSource& source, const std::vector<MachineKind>& kinds) {
  RunConfig config = read_run_config(source.document(), kinds);
  if (!source.fit_memories) return config;
  refuse_sizes_of_overrides(config);
  config.sizes_replaced = sizes_to_replace(config, source.preset_in_words());
  fit_memories(config);
  return config;
}

void fit_memories(RunConfig& config) {
  config.design->fit_memories();
  config.memories_fitted = true;
}

std::string sizes_to_replace(RunConfig& config, const std::string& preset) {
  std::vector<std::string> given;
  for (const auto& [from, bytes] : sizes_given(config)) {
    if (from.origin == preset) continue;
    given.push_back(fmt::format("{} {} ({})", from.path, bytes, from.origin));
  }
  return given.empty() ? "" : "memories are fitted, not as given: " + join(given);
}

RunConfig as_decided(ConfigDocument document, RunConfig& resolved) {
  const Json values = parse_json(to_json(resolved), "the configuration");
  Json decided = Json::object();
  for (const AutoChoice& choice : resolved.chosen) {
    if (choice.kind != ChoiceKind::kDecided) continue;
    decided[pointer_to(choice.key)] = values.at(pointer_to(choice.key));
  }
  document.add_text(decided.dump(), "what was decided");
  RunConfig config = read_run_config(document, *resolved.kinds);
  config.storage = resolved.storage;
  return config;
}

void resolve(RunConfig& config) {
  check_codebook_keys(config);
  resolve_machine(config);
}

void adapt(RunConfig& config, const SecondHalfFormat& format) {
  naming_origins(config, [&] { config.design->adapt(format, config.chosen); });
}

void resolve(RunConfig& config, const PackedScene& packed, const std::string& path,
             const std::string& preset) {
  const StorageOrder order = packed.storage.order;
  if (order != config.design->storage_order()) {
    const auto reads_it = [&](RunConfig& other) { return other.design->storage_order() == order; };
    const auto by = deciding_setting(config, config.origins, reads_it);
    const std::string readers = readers_of(*config.kinds, order);
    const std::string take = by                ? "--set " + by->by_default
                             : readers.empty() ? ""
                                               : "--config " + readers;
    throw InputError(
        fmt::format("{}: stored by {}; machine {}{} reads scenes stored by {}: {}pack the scene "
                    "again with this configuration",
                    path, scheme_of(order).name(), config.machine(), by ? " with " + by->set : "",
                    scheme_of(config.design->storage_order()).name(),
                    take.empty() ? "" : fmt::format("take {}, or ", take)));
  }
  config.storage_source = compared(config, packed, path, preset);
  config.storage = packed.storage;
  check_codebook_keys(config);
  resolve_machine(config);
}

std::string to_json(RunConfig& config) {
  const std::unique_ptr<ConfigWriter> writer = make_json_writer();
  visit(static_cast<ConfigVisitor&>(*writer), config);
  return writer->text();
}

}  // namespace sgs
