// Entry of libFuzzer: --reader=NAME chooses what reads the inputs, --folder=DIR where they are put;
// --list names the readers. (libFuzzer leaves options of two dashes alone.)
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/fuzz/fuzzed_reader.h"

namespace {

const sgs::test::FuzzedReader* g_reader = nullptr;
std::string g_folder;

void list_readers() {
  for (const auto& reader : sgs::test::fuzzed_readers()) std::puts(reader.name.c_str());
}

}  // namespace

// What libsystemc refers to.
extern "C" int sc_main(int, char*[]) { return 0; }

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    const std::string word = (*argv)[i];
    if (word == "--list") {
      list_readers();
      std::exit(0);
    }
    if (word.rfind("--reader=", 0) == 0) g_reader = sgs::test::fuzzed_reader(word.substr(9));
    if (word.rfind("--folder=", 0) == 0) g_folder = word.substr(9);
  }
  if (g_reader == nullptr || g_folder.empty()) {
    std::fputs("expected --list, or --reader=NAME (of --list) and --folder=DIR\n", stderr);
    std::exit(2);
  }
  g_reader->prepare(g_folder);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // 0: worth keeping in the corpus, whether refused or not.
  takes(*g_reader, g_folder, std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
