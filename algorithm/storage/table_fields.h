// The numbers of a packed scene's header that only its storage order has.
#pragma once

#include <cstdint>

namespace sgs {

// Counts its bytes, writes or reads it. A reader throws InputError for what is not between lowest
// and highest.
class TableFields {
 public:
  virtual ~TableFields() = default;
  virtual void operator()(const char* name, double& value, double lowest, double highest) = 0;
  virtual void operator()(const char* name, int& value, double lowest, double highest) = 0;
  virtual void operator()(const char* name, std::uint32_t& value, double lowest,
                          double highest) = 0;

  // Of records or blocks: four bytes in the file, whatever holds it in memory.
  template <class Count>
  void count(const char* name, Count& value) {
    auto word = static_cast<std::uint32_t>(value);
    (*this)(name, word, 0, UINT32_MAX);
    value = word;
  }
};

}  // namespace sgs
