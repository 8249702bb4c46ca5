#include "testbench/stability/counted.h"

#include <fmt/format.h>

namespace sgs {

std::string in_words(const OperationCounts& counts) {
  std::string text;
  for (const auto& [count, sign] : {std::pair{counts.multiplies, "x"},
                                    {counts.adds, "+"},
                                    {counts.divisions, "/"},
                                    {counts.square_roots, "root"},
                                    {counts.logarithms, "log"},
                                    {counts.exponentials, "exp"},
                                    {counts.look_ups, "look-up"}}) {
    if (count == 0) continue;
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {}", count, sign);
  }
  return text;
}

}  // namespace sgs
