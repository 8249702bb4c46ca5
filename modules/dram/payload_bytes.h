// Access of a generic payload to a store of bytes, and the response it deserves.
#pragma once

#include <tlm>

#include "modules/dram/byte_store.h"

namespace sgs {

// Moves the payload's bytes, byte enables respected, and sets its response: OK, or the TLM error
// for a range outside the store, a streaming width below the length, an empty byte-enable array, or
// a command that is neither read nor write; on an error no byte moves. True when OK.
bool move_bytes(tlm::tlm_generic_payload& payload, ByteStore& store);

}  // namespace sgs
