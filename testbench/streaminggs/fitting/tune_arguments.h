// The arguments of the tunings of a scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "algorithm/train/fitting.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/fitting/dataset_arguments.h"
#include "testbench/streaminggs/fitting/fitting_run.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {

struct TuneArguments : SceneArguments, FittingArguments {
  bool boundary = false, quantise = false, streaming = false;
  DatasetArguments data;  // no folder: the scene's own pictures
  std::string target;     // scene whose pictures they are; empty: the one that is tuned
  std::uint32_t between = 0;
  ConfigSource config;
  std::optional<std::uint32_t> steps;  // none: as many as the paper takes
  std::uint64_t seed = 1;
  std::optional<double> rate;  // none: that of the tuning
  double beta = 0.05;
  std::string misordered_in = "group", penalty_mean = "rendered";
  std::uint32_t reassign_every = 100;
  double price = 0.01;
  static constexpr std::uint32_t kVisitMemoryMb = 1024;
  std::uint32_t visit_memory_mb = kVisitMemoryMb;

  void add_to(CommandLine& line);
  // Throws InputError for what does not go together.
  void check() const;
  std::size_t visit_bytes() const { return std::size_t{visit_memory_mb} * 1'000'000; }
  const char* purpose() const {
    return boundary ? "boundary" : quantise ? "quantise" : "streaming";
  }
  // work(): the tuning in words, which a checkpoint must have been made with. pace(): the values
  // that may differ from there on.
  std::string work() const;
  std::string pace(const TuningConfig& config) const;
  // Sets the values that all tunings share. steps, rate: used where the user says none.
  void set(TuningConfig& config, int own_steps, double own_rate) const;
};

}  // namespace sgs
