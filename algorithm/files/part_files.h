// Temporaries of this process that a signal removes before it ends the process.
#pragma once

namespace sgs {

// path: of a file; must stay where it is in memory until it is forgotten. From any thread. At most
// a few hundred at once are remembered.
void remember_part(const char* path);
void forget_part(const char* path);

// From now on SIGINT and SIGTERM, unless they are ignored, remove what is remembered and then end
// the process as ever. Its children leave that to it.
void remove_parts_on_signals();

}  // namespace sgs
