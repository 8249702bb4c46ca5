// The data set that a command reads, and how small.
#pragma once

#include <string>

#include "algorithm/dataset/dataset.h"
#include "algorithm/files/output_file.h"
#include "testbench/command_line/command_line.h"

namespace sgs {

// Prints a line each: layout, views and their split, sizes, alpha, points, bounds, where the
// cameras stand; then its notes.
void print_dataset(const Dataset& dataset);

// Its notes alone, a line each.
void print_notes(const Dataset& dataset);

struct DatasetArguments {
  std::string folder;
  DatasetOptions options;

  void add_options_to(CommandLine& line);
  // These need that another argument is given.
  static constexpr const char* kNames[] = {"--downscale", "--layout", "--images"};
  // The data set in words: a checkpoint must have been made with the same.
  std::string work() const;
  // Reads it and checks that `plan`, to which its files are added as inputs, writes over none of
  // them. Throws InputError, also where there is no view to test with.
  Dataset open(OutputPlan& plan) const;
};

}  // namespace sgs
