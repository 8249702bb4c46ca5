// A frame of the machine of exact order, reckoned without a kernel. The units' estimates pass the
// frame's visits and keys on in the order in which the machine does; when each comes to each unit
// follows from when that is free, when there is room behind it, and when the memory answers. What
// saturated groups and finished sub-tiles spare follows from when the units hear of them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithm/render/exact_work.h"
#include "modules/frame_work.h"
#include "modules/streaminggs/exact_config.h"
#include "modules/streaminggs/hfu/coarse_filter_estimate.h"
#include "modules/streaminggs/hfu/codebook_estimate.h"
#include "modules/streaminggs/hfu/fine_filter_estimate.h"
#include "modules/streaminggs/merge/merge_estimate.h"
#include "modules/streaminggs/rendering/rendering_estimate.h"
#include "modules/streaminggs/sorting/exact_sorter_estimate.h"
#include "modules/streaminggs/vsu/exact_vsu_estimate.h"
#include "tlm/fifo_times.h"

namespace sgs {

struct ExactFrameWork : FrameWork {
  ExactWork of;
  std::size_t size_bytes() const override;
};

// Of the units of a machine; in the order of their numbers.
struct ExactUnitEstimates {
  ExactVsuEstimate vsu;
  std::vector<CoarseFilterEstimate> coarse;
  std::vector<FineFilterEstimate> fine;
  std::vector<ExactSorterEstimate> sorters;
  MergeEstimate merge;
};

class ExactEstimate {
 public:
  ExactEstimate(const ExactConfig& config, const ExactWork& work, ExactUnitEstimates& units,
                RenderingEstimate& rendering);

  // The cycles of the frame.
  std::uint64_t draw();

  // Entries that went through the FIFOs between the units, in the order of the machine's.
  const std::vector<FifoTimes>& visits() const { return visits_; }
  const std::vector<FifoTimes>& keys() const { return keys_; }
  const std::vector<FifoTimes>& sorted() const { return sorted_; }
  const std::vector<FifoTimes>& released() const { return released_; }
  const std::vector<FifoTimes>& splats() const { return splats_; }

 private:
  void draw_group(std::uint32_t group);
  // From VSU on: a visit, its keys, and what they set free; or the end of the group.
  void send(const VisitWork& visit, std::uint32_t first_key, float release_below,
            std::uint64_t cycle);
  void send_end(std::uint64_t cycle);
  void filter(std::uint32_t first, std::uint32_t count, std::uint32_t first_key);
  void merge_keys();
  void release_below(float nearest);
  void emit(const MergeEstimate::Key& key);
  void to_fine(const FineFilterEstimate::Candidate& candidate, std::uint32_t splat);

  const ExactConfig& config_;
  const ExactWork& work_;
  ExactUnitEstimates& units_;
  RenderingEstimate& rendering_;
  std::vector<FifoTimes> visits_, keys_, sorted_, released_, splats_;
  std::uint32_t group_ = 0, visit_ = 0;  // visit_: the number of the next
  std::uint64_t sequence_ = 0;           // keys and marks released
  float last_depth_ = -1;
  const ExactGroupWork* of_ = nullptr;
  std::vector<MergeEstimate::Key> list_;  // of the visit at hand
};

}  // namespace sgs
