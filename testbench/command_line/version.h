// Which program this is.
#pragma once

#include <string>

namespace sgs {

std::string version();  // "0.1.0"
std::string commit();   // as of the build; empty outside a repository

// "0.1.0 (7b9a7bf)"
std::string version_text();

}  // namespace sgs
