// How a scene is stored, as keys of the configuration.
#pragma once

#include "algorithm/memory/storage_config.h"
#include "modules/config/config_visitor.h"

namespace sgs {

void visit(ConfigVisitor& v, VqConfig& config);
// The keys of the configuration's own storage order; those of others are unknown.
void visit(ConfigVisitor& v, StorageConfig& config);

}  // namespace sgs
