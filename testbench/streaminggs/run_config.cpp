// Reading and resolving of the three configurations.
#include "testbench/streaminggs/run_config.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"
#include "algorithm/storage/storage_choices.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/memspec.h"
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

void visit(ConfigVisitor& v, RunConfig& c) {
  std::vector<const char*> names;
  for (const MachineKind& kind : *c.kinds) names.push_back(kind.name);
  const std::size_t before = c.kind;
  v.choice("machine", c.kind, names, "which accelerator; its keys stand beside this one");
  if (!c.design || c.kind != before) {
    c.design = (*c.kinds)[c.kind].design();
    c.storage.order = c.design->storage_order();
  }
  c.design->visit(v);
  v.section("storage", c.storage, "how the scene is stored");
  v.section("dram", c.dram, "memory");
}

RunConfig read_run_config(const ConfigDocument& document, const std::vector<MachineKind>& kinds) {
  RunConfig config;
  config.kinds = &kinds;
  document.read_into(config);
  return config;
}

void resolve(RunConfig& config) {
  config.dram.validate();
  if (config.storage.order == StorageOrder::kChunks && config.storage.chunk_gaussians == 0) {
    const AddressMapping mapping(config.dram, load_memspec(config.dram.memspec));
    const Choice<std::uint32_t> chunk = choose_chunk_gaussians(mapping.run_bytes());
    config.storage.chunk_gaussians = chunk.value;
    config.chosen.push_back(
        {"storage.chunk_gaussians", static_cast<double>(chunk.value), chunk.why});
  }
  config.design->resolve(config.storage, config.chosen);
}

void resolve(RunConfig& config, const PackedScene& packed, const std::string& path) {
  const StorageOrder order = packed.storage.order;
  if (order != config.design->storage_order()) {
    throw InputError(fmt::format(
        "{}: stored by {}; machine {} reads scenes stored by {}: take --config {}, or pack the "
        "scene again with this configuration",
        path, kStorageOrderNames[static_cast<std::size_t>(order)], config.machine(),
        kStorageOrderNames[static_cast<std::size_t>(config.design->storage_order())],
        readers_of(*config.kinds, order)));
  }
  config.storage = packed.storage;
  resolve(config);
}

std::string to_json(RunConfig& config) {
  const std::unique_ptr<ConfigWriter> writer = make_json_writer();
  visit(static_cast<ConfigVisitor&>(*writer), config);
  return writer->text();
}

}  // namespace sgs
