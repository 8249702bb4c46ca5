// sweep_results.h: a file of results from one sweep to the next.
#include "testbench/streaminggs/sweep/sweep_results.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

TEST_CASE("sweep results: who waits for a sweep that has written nothing has a file of its own") {
  const ScratchFolder scratch;
  const std::string path = scratch.path("r.jsonl");
  auto ending = std::make_unique<SweepResults>(path);
  auto next = std::async(std::launch::async, [&] {
    SweepResults results(path);
    results.add(R"({"key":"a","status":"done"})");
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // so that it waits
  ending.reset();
  next.get();
  CHECK(bytes_of(path) == "{\"key\":\"a\",\"status\":\"done\"}\n");
}

}  // namespace
}  // namespace sgs::test
