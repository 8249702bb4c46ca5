// A frame of the machine of paper order, reckoned without a kernel. The units' estimates pass the
// frame's visits, candidates and splats on in the order in which the machine does; when each comes
// to each unit follows from when that is free, when there is room behind it, and when the memory
// answers. What finished groups spare follows from when the units hear of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithm/render/paper_work.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/frame_work.h"
#include "modules/streaminggs/hfu/coarse_filter_estimate.h"
#include "modules/streaminggs/hfu/codebook_estimate.h"
#include "modules/streaminggs/hfu/fine_filter_estimate.h"
#include "modules/streaminggs/paper_config.h"
#include "modules/streaminggs/rendering/rendering_estimate.h"
#include "modules/streaminggs/sorting/paper_sorter_estimate.h"
#include "modules/streaminggs/streaming_job.h"
#include "modules/streaminggs/vsu/paper_vsu_estimate.h"
#include "tlm/fifo_times.h"

namespace sgs {

struct PaperFrameWork : FrameWork {
  PaperWork of;
  VoxelGrid grid;  // of the scene, which need not stay
  std::size_t size_bytes() const override;
};

// Of the units of a machine; in the order of their numbers.
struct PaperUnitEstimates {
  PaperVsuEstimate& vsu;
  std::vector<CoarseFilterEstimate> coarse;                   // [fetch]
  std::vector<FineFilterEstimate> fine;                       // [fetch]
  std::vector<PaperSorterEstimate> sorters;                   // [list]
  std::vector<std::unique_ptr<RenderingEstimate>> rendering;  // [part]
};

class PaperEstimate {
 public:
  PaperEstimate(const PaperConfig& config, const StreamingJob& job, const PaperWork& work,
                PaperUnitEstimates& units);

  // The cycles of the frame.
  std::uint64_t draw();

  // Entries that went through the FIFOs between the units, in the order of the machine's.
  const std::vector<FifoTimes>& visits() const { return visits_; }
  const std::vector<FifoTimes>& candidates() const { return candidates_; }
  const std::vector<FifoTimes>& splats() const { return splats_; }
  const std::vector<FifoTimes>& sorted() const { return sorted_; }

 private:
  // What a fetch filters of the visit at hand.
  struct Stream {
    std::uint32_t first = 0, count = 0;  // storage slots
    std::size_t next = 0, end = 0;       // candidates of the group
    bool arrived = false;                // what it gave last waits for sorting
    bool ended = false;                  // that is the mark behind its share
    std::uint32_t splat = 0;             // else its place in the order of blending
  };
  void draw_group(std::uint32_t group);
  std::uint64_t send(const VoxelRecord& piece, std::uint64_t cycle);
  std::uint64_t send_end(std::uint64_t cycle);
  void follow_visit();
  void hear_of_finished();
  void filter(std::size_t fetch);
  void to_fine(std::size_t fetch, const FineFilterEstimate::Candidate& candidate,
               const CandidateWork* of);
  void collect();
  void take(std::size_t fetch, std::uint32_t part, const std::uint32_t* splat);
  void sort_and_blend(std::uint32_t part);
  std::size_t list_of(std::uint32_t part) const {
    return part * config_.lists_of_part() + visit_ % config_.lists_of_part();
  }
  FifoTimes& splats_of(std::size_t fetch, std::uint32_t part) {
    return splats_[list_of(part) * streams_.size() + fetch];
  }

  const PaperConfig& config_;
  const StreamingJob& job_;
  const PaperWork& work_;
  PaperUnitEstimates& units_;
  std::vector<FifoTimes> visits_, candidates_, splats_, sorted_;
  std::uint32_t group_ = 0, visit_ = 0;       // visit_: the number of the next
  std::size_t piece_ = 0;                     // of the group's visits, the next
  std::size_t next_candidate_ = 0;            // of the group
  std::vector<Stream> streams_;               // [fetch]
  std::vector<std::size_t> last_taken_;       // [list] the stream that it took from last
  std::vector<std::uint64_t> finished_from_;  // [part]
};

}  // namespace sgs
