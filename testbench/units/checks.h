// Counted checks of one test case: each holds or is printed.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <string>

namespace sgs::tb {

class Checks {
 public:
  void that(bool held, const std::string& what) {
    ++made_;
    if (held) return;
    constexpr std::uint64_t kPrintedFailures = 10;
    if (++failed_ <= kPrintedFailures) std::printf("  FAILED: %s\n", what.c_str());
  }

  template <class A, class B>
  void equal(const A& got, const B& expected, const std::string& what) {
    const bool held = got == expected;
    that(held, held ? std::string() : fmt::format("{}: {}, expected {}", what, got, expected));
  }

  std::uint64_t made() const { return made_; }
  std::uint64_t failed() const { return failed_; }

 private:
  std::uint64_t made_ = 0, failed_ = 0;
};

}  // namespace sgs::tb
