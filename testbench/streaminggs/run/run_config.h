// The three configurations of a run: the machine, how the scene is stored, the memory. One JSON
// document holds them: `machine` names the kind, whose keys stand beside it; `storage`; `dram`.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithm/memory/storage_config.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/storage_scheme.h"
#include "modules/config/strict_json.h"
#include "modules/dram/dram_config.h"
#include "modules/machine_design.h"
#include "testbench/command_line/config_source.h"

namespace sgs {

struct RunConfig {
  const std::vector<MachineKind>* kinds = nullptr;
  std::size_t kind = 0;  // number in `kinds`
  std::unique_ptr<MachineDesign> design;
  StorageConfig storage;
  DramConfig dram;
  std::vector<AutoChoice> chosen;     // values left to the model
  std::vector<ConfigOrigin> origins;  // where the document says what
  std::string storage_source;  // one line about a packed scene: the file, its contents, who differs
  bool memories_fitted = false;
  std::string sizes_replaced;  // one line about sizes that are given, and that fitting replaces

  const char* machine() const { return (*kinds)[kind].name; }
  void add_choices(const std::vector<StorageChoice>& choices);
};

void visit(ConfigVisitor& v, RunConfig& config);

// The kinds that read scenes stored in this order: "a or b"; empty where there is none.
std::string readers_of(const std::vector<MachineKind>& kinds, StorageOrder order);

// Every key that the configuration of one of the kinds has, as a path.
std::vector<std::string> keys_of(const std::vector<MachineKind>& kinds);

// As the document says; what is left to the model is not resolved yet. Throws InputError.
RunConfig read_run_config(const ConfigDocument& document, const std::vector<MachineKind>& kinds);

// As a command line says. Throws InputError, also where it sizes a memory that is to be fitted.
RunConfig read_run_config(const ConfigSource& source, const std::vector<MachineKind>& kinds);

// Before resolve(), which then makes on-chip memories as large as all else needs.
void fit_memories(RunConfig& config);

// The line of RunConfig::sizes_replaced, were the memories fitted; empty where none is given.
// preset: the origin that is a shipped configuration, whose sizes are there to be replaced.
std::string sizes_to_replace(RunConfig& config, const std::string& preset);

// The document's, with what was decided for `resolved`, which was read from it, and stored as that
// is. Whatever is derived stays open, and so a key of it can be changed.
RunConfig as_decided(ConfigDocument document, RunConfig& resolved);

// Runs `act`. An error that refuses a key, by its path or by that below `storage`, then also says
// where its value is from; one about a memory that is too small says who sizes it.
void naming_origins(const RunConfig& config, const std::function<void()>& act);

// Makes it the resolved, valid configuration. Throws InputError, also for what --set says of
// codebooks, or of their buffer, that the encoding has not.
void resolve(RunConfig& config);

// Fits the machine to the scene's records. Throws InputError.
void adapt(RunConfig& config, const SecondHalfFormat& format);

// The same for a packed scene, which brings its storage. path: what errors name. preset: the origin
// that is a shipped configuration, whose storage gives way; empty for none. Throws InputError when
// the machine cannot read the scene, and when whatever else was said of storage is not as the file
// has it.
void resolve(RunConfig& config, const PackedScene& packed, const std::string& path,
             const std::string& preset);

std::string to_json(RunConfig& config);

}  // namespace sgs
