// Units that the machines of both orders share: filtering units, codebooks, rendering. The two tops
// bind them in their own ways.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "modules/machine.h"
#include "modules/machine_design.h"
#include "modules/streaminggs/fifo_kind.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/hfu/codebook_buffer.h"
#include "modules/streaminggs/hfu/hfu.h"
#include "modules/streaminggs/rendering/rendering_unit.h"
#include "modules/streaminggs/streaming_config.h"
#include "modules/streaminggs/unit_context.h"

namespace sgs {

class StreamingMachine : public Machine {
 public:
  const ClockDomain& clock() const override { return clock_; }
  void publish(DataSheet& sheet) override;

 private:
  void publish_spare_units(DataSheet& sheet);

  const StreamingConfig config_;
  const StreamingJob job_;
  const BuiltFor built_for_;
  const StallConfig stalls_;
  const ClockDomain clock_;
  std::vector<StreamingJob> part_jobs_;     // [part]
  std::vector<std::uint32_t> parts_drawn_;  // [frame]
  struct Queue {
    FifoChannel* fifo;
    SramUse use;
    const char* key;  // as FifoKind
  };
  std::vector<Queue> queues_;  // between the units

 protected:
  template <class T>
  using Fifos = std::vector<std::unique_ptr<TimedFifo<T>>>;

  // Handling of tokens in an order: candidates without a splat reported or not, and splats spread
  // over the FIFOs that rendering reads.
  struct Tokens {
    Rejects rejects;
    Arrival arrival;
  };

  // Makes the shared units, and binds what is bound alike in both orders.
  StreamingMachine(const sc_core::sc_module_name& name, const StreamingConfig& config,
                   const StreamingJob& job, const BuiltFor& built_for, const BuildOptions& options,
                   const Tokens& tokens);

  // A FIFO between two units, one of its kind.
  template <class T>
  void add_fifo(Fifos<T>& fifos, const std::string& name, const FifoKind<T>& kind) {
    fifos.push_back(std::make_unique<FifoOfKind<T>>(name.c_str(), clock_, kind));
    if (stalls_.probability > 0) fifos.back()->inject(stalls_);
    queues_.push_back({fifos.back().get(), kind.each(), kind.key});
  }

  UnitContext context() const { return {clock_, job_, built_for_}; }
  // Context of units that have one part of the groups: its pixels are their groups.
  UnitContext part_context(std::uint32_t part) const {
    return {clock_, part_jobs_[part], built_for_part(config_, built_for_)};
  }
  const StreamingJob& job() const { return job_; }

  // The units in the order of the pipeline.
  virtual void publish_units(DataSheet& sheet) = 0;

  std::vector<std::unique_ptr<FinishedGroups>> finished_groups_;  // [part]
  Fifos<VisitShare> visits_;                                      // [fetch]
  std::unique_ptr<CodebookBuffer> codebooks_;  // null where second halves are not quantised
  std::vector<std::unique_ptr<Hfu>> hfus_;     // [fetch]
  std::vector<std::unique_ptr<RenderingUnit>> rendering_;  // [part]

 private:
  void make_finished_groups();
  void make_units(const Tokens& tokens);
  void bind();
  std::string name_of_part(const char* what, std::uint32_t part) const;
};

}  // namespace sgs
