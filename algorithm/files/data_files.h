// The files that come with the programs: presets, memspecs, technology tables.
#pragma once

#include <string>

namespace sgs {

// The place of one of them, by its name in share/streaminggs ("presets"). That folder is found from
// the executable, so that an installed prefix may be moved; in a build tree it is made of links to
// the sources.
std::string data_file(const std::string& name);

// Throws InputError where the folder is not there.
void require_data_files();

}  // namespace sgs
