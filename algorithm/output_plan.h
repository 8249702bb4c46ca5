// What a command reads and writes, checked as a whole before it begins.
#pragma once

#include <string>
#include <vector>

namespace sgs {

class OutputPlan {
 public:
  // Names that are no file, and empty ones, are for whoever reads them to judge.
  void add_input(const std::string& path) { inputs_.push_back(path); }
  void add_output(const std::string& path) { outputs_.push_back(path); }
  const std::vector<std::string>& inputs() const { return inputs_; }

  // Throws InputError when an output cannot be made (as OutputFile does), when it is one of the
  // inputs by whatever name or link, when two outputs are the same file, and when one is the folder
  // of another. Leaves nothing.
  void check() const;

 private:
  std::vector<std::string> inputs_;
  std::vector<std::string> outputs_;
};

}  // namespace sgs
