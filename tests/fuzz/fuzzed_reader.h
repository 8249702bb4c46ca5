// A reader of files, as fuzzing and the replay of its seeds call it.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace sgs::test {

struct FuzzedReader {
  std::string name;  // and that of its folder in corpus/
  std::string file;  // what the bytes are in the folder that is read
  // Reads folder/file, or the data set that it is part of.
  std::function<void(const std::string& folder)> read;
  // Writes what else has to stand in the folder; once.
  std::function<void(const std::string& folder)> prepare = [](const std::string&) {};
  // The file that a fuzzer's bytes stand for: with a right checksum, which no mutation would find.
  std::function<std::string(std::string bytes)> file_of = [](std::string bytes) { return bytes; };
};

// Those of this executable.
const std::vector<FuzzedReader>& fuzzed_readers();

// Null where there is none.
const FuzzedReader* fuzzed_reader(const std::string& name);

// Whether it takes `bytes`, put into the prepared folder. A refusal is an InputError; whatever else
// is thrown is a fault of the reader, and goes on to the caller.
bool takes(const FuzzedReader& reader, const std::string& folder, const std::string& bytes);

}  // namespace sgs::test
