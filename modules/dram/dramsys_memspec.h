// Memspecs of DRAMSys (tukl-msd/DRAMSys, configs/memspec), by the names of tukl-msd/DRAMUtils.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sgs {

bool is_dramsys_memspec(const nlohmann::ordered_json& json);

// The same device as a memspec of ours, as JSON. `notes` gets a line for what the file does not
// state and what stands in for it, and for what is not taken over. `origin` stands for the file.
// InputError: a type of memory that has no such form, or a number that is missing or none.
nlohmann::ordered_json converted_from_dramsys(const nlohmann::ordered_json& json,
                                              const std::string& origin,
                                              std::vector<std::string>& notes);

// A refusal of a key of the converted memspec, "ORIGIN: KEY: ...", by the key of `json` that its
// value is from. Of other keys as it is.
std::string in_dramsys_keys(const std::string& refusal, const std::string& origin,
                            const nlohmann::ordered_json& json);

}  // namespace sgs
