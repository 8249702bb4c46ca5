// child_process.h: what comes back, why a child failed, and that it is forked from one
// thread.
#include <sys/time.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "algorithm/files/input_error.h"
#include "testbench/process/child_process.h"

namespace sgs {
namespace {

using Catch::Matchers::Equals;

TEST_CASE("in child: gives back what the work returns, whatever it is") {
  for (const std::string& text :
       {std::string(), std::string("a\0b", 3), std::string(3'000'000, 'x')}) {
    CHECK((in_child([&] { return text; }) == text));
  }
}

TEST_CASE("in child: why it failed, in one line") {
  struct Case {
    std::string (*work)();
    const char* why;
  };
  for (const Case& c : std::vector<Case>{
           {[]() -> std::string { throw std::runtime_error("no\nway"); }, "no\\nway"},
           {[]() -> std::string { throw std::bad_alloc(); }, "out of memory in the simulation"},
           {[]() -> std::string { fail_child("from within"); }, "from within"},
           {[]() -> std::string { ::_exit(3); }, "the simulation ended with exit status 3"},
           {[]() -> std::string { return std::raise(SIGKILL), ""; },
            "the simulation was ended by signal 9"}}) {
    CHECK_THROWS_WITH(in_child(c.work), Equals(c.why));
  }
}

TEST_CASE("in child: bad input stays bad input") {
  const auto refuse = []() -> std::string { throw InputError("none of\nthat"); };
  CHECK_THROWS_AS(in_child(refuse), InputError);
  CHECK_THROWS_WITH(in_child(refuse), Equals("none of\\nthat"));
}

std::ptrdiff_t threads() {
  using Tasks = std::filesystem::directory_iterator;
  return std::distance(Tasks("/proc/self/task"), Tasks());
}

TEST_CASE("in child: no other thread stands at the fork") {
  for (int round = 0; round < 5; ++round) {
    tbb::parallel_for(0, 32,
                      [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); });
    const std::ptrdiff_t before = threads();
    in_child([] { return std::string(); });
    if (std::thread::hardware_concurrency() > 1) CHECK(before > 1);
    CHECK(threads() == 1);
  }
}

TEST_CASE("child process: several work at a time, and one that is not wanted is ended") {
  const auto began = std::chrono::steady_clock::now();
  {
    const ChildProcess endless([]() -> std::string {
      while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
    });
    ChildProcess long_answer([] { return std::string(3'000'000, 'x'); });
    ChildProcess refused([]() -> std::string { throw InputError("no"); });
    CHECK_THROWS_AS(refused.result(), InputError);
    CHECK(long_answer.result().size() == 3'000'000);
  }
  CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(30));
}

TEST_CASE("child process: an answer that is written piece by piece comes whole") {
  // Signals end a write() in the middle wherever the pipe is full, which it is all the time.
  std::string answer(1'000'000, '\0');
  std::uint32_t state = 1;
  for (char& byte : answer) byte = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  ChildProcess child([&] {
    struct sigaction on_alarm = {};  // no SA_RESTART
    on_alarm.sa_handler = [](int) {};
    ::sigaction(SIGALRM, &on_alarm, nullptr);
    const itimerval every_ms = {{0, 1000}, {0, 1000}};
    ::setitimer(ITIMER_REAL, &every_ms, nullptr);
    return answer;
  });
  do {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (!child.receive());
  CHECK((child.result() == answer));
}

TEST_CASE("child process: it ends with the one that started it") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  in_child([&]() -> std::string {
    ::close(ends[0]);
    // Left behind: the grandchild has the other end of the pipe as long as it lives.
    new ChildProcess([]() -> std::string {
      while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
    });
    return "";
  });
  ::close(ends[1]);
  char byte = 0;
  CHECK(::read(ends[0], &byte, 1) == 0);
  ::close(ends[0]);
}

}  // namespace
}  // namespace sgs
