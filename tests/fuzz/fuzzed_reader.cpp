// One input to one reader.
#include "tests/fuzz/fuzzed_reader.h"

#include <fstream>

#include "algorithm/files/input_error.h"

namespace sgs::test {

const FuzzedReader* fuzzed_reader(const std::string& name) {
  for (const FuzzedReader& reader : fuzzed_readers()) {
    if (reader.name == name) return &reader;
  }
  return nullptr;
}

bool takes(const FuzzedReader& reader, const std::string& folder, const std::string& bytes) {
  std::ofstream(folder + "/" + reader.file, std::ios::binary) << reader.file_of(bytes);
  try {
    reader.read(folder);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace sgs::test
