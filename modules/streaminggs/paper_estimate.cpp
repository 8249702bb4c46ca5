// Visits, candidates and splats of one group after the other.
#include "modules/streaminggs/paper_estimate.h"

#include <algorithm>

#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {
std::size_t PaperFrameWork::size_bytes() const {
  return of.size_bytes() + grid.nodes.size() * sizeof(VoxelNode) +
         grid.voxels.size() * sizeof(VoxelRecord) + grid.cuts.size() * sizeof(float);
}

PaperEstimate::PaperEstimate(const PaperConfig& config, const StreamingJob& job,
                             const PaperWork& work, PaperUnitEstimates& units)
    : config_(config),
      job_(job),
      work_(work),
      units_(units),
      streams_(config.fetches()),
      last_taken_(config.lists(), 0),
      finished_from_(config.parts()) {
  const PaperFifos kinds(config);
  visits_ = times_of(visit_fifos(config));
  candidates_ = times_of(kinds.candidates);
  splats_ = times_of(kinds.splats);
  sorted_ = times_of(kinds.sorted);
}

std::uint64_t PaperEstimate::draw() {
  for (std::uint32_t group = 0; group < work_.groups.size(); ++group) draw_group(group);
  std::uint64_t done = 0;
  for (const auto& rendering : units_.rendering) done = std::max(done, rendering->done());
  return done;
}

void PaperEstimate::draw_group(std::uint32_t group) {
  group_ = group;
  piece_ = 0;
  next_candidate_ = 0;
  for (std::size_t p = 0; p < units_.rendering.size(); ++p) {
    units_.rendering[p]->begin_group(group, work_.groups[group].blends[p]);
  }
  hear_of_finished();
  const auto finished = [&](std::uint64_t cycle) {
    return *std::max_element(finished_from_.begin(), finished_from_.end()) <= cycle;
  };
  units_.vsu.order(
      {group, job_.groups[group], finished,
       [&](const VoxelRecord& piece, std::uint64_t cycle) { return send(piece, cycle); },
       [&](std::uint64_t cycle) { return send_end(cycle); }});
  for (const auto& rendering : units_.rendering) rendering->end_group();
}

// A part of a group that has no pixels is finished from the start.
void PaperEstimate::hear_of_finished() {
  for (std::size_t p = 0; p < finished_from_.size(); ++p) {
    finished_from_[p] = job_.parts[p][group_].empty() ? config_.rendering.feedback_latency_cycles
                                                      : units_.rendering[p]->finished_from();
  }
}

// As PaperVsu::hand_out().
std::uint64_t PaperEstimate::send(const VoxelRecord& piece, std::uint64_t cycle) {
  const PaperGroupWork& of = work_.groups[group_];
  const std::size_t begin = next_candidate_;
  if (piece_ < of.visits.size()) next_candidate_ = of.visits[piece_++].candidates;
  const auto candidate = [&](std::uint32_t slot) {
    const auto at =
        std::lower_bound(of.candidates.begin() + static_cast<std::ptrdiff_t>(begin),
                         of.candidates.begin() + static_cast<std::ptrdiff_t>(next_candidate_), slot,
                         [](const CandidateWork& c, std::uint32_t s) { return c.slot < s; });
    return static_cast<std::size_t>(at - of.candidates.begin());
  };
  const auto fetches = static_cast<std::uint32_t>(streams_.size());
  const std::uint32_t unit = std::max(2U, config_.vsu.min_share);
  const std::uint32_t share =
      static_cast<std::uint32_t>(cycles_for(cycles_for(piece.count, fetches), unit)) * unit;
  for (std::uint32_t k = 0; k < fetches; ++k) {
    const std::size_t to = (k + visit_) % fetches;
    const std::uint32_t from = std::min(k * share, piece.count);
    const std::uint32_t end = std::min(from + share, piece.count);
    streams_[to] = {piece.first + from, end - from, candidate(piece.first + from),
                    candidate(piece.first + end)};
    cycle = visits_[to].push(cycle);
  }
  follow_visit();
  return cycle;
}

std::uint64_t PaperEstimate::send_end(std::uint64_t cycle) {
  for (std::size_t k = 0; k < streams_.size(); ++k) {
    streams_[k] = {};
    cycle = visits_[k].push(cycle);
  }
  follow_visit();
  return cycle;
}

// Through the filters into a sorting unit of each part, and what that gives through rendering.
void PaperEstimate::follow_visit() {
  const std::uint64_t all = *std::max_element(finished_from_.begin(), finished_from_.end());
  for (std::size_t f = 0; f < streams_.size(); ++f) {
    units_.coarse[f].begin({group_, streams_[f].first, streams_[f].count, all}, visits_[f],
                           candidates_[f]);
  }
  for (std::uint32_t p = 0; p < finished_from_.size(); ++p) {
    units_.sorters[list_of(p)].begin_visit(group_);
  }
  collect();
  for (std::uint32_t p = 0; p < finished_from_.size(); ++p) sort_and_blend(p);
  hear_of_finished();
  ++visit_;
}

// A sorting unit takes from whichever fetch has something, in turn. Of a fetch that serves all
// parts each takes what comes.
void PaperEstimate::collect() {
  if (streams_.size() == 1) {
    while (!streams_[0].ended) filter(0);
    return;
  }
  for (std::size_t f = 0; f < streams_.size(); ++f) filter(f);
  const std::size_t list = list_of(0);
  std::size_t& last = last_taken_[list];
  for (std::size_t open = streams_.size(); open > 0;) {
    const std::uint64_t now = units_.sorters[list].now();
    std::size_t from = streams_.size();
    std::uint64_t first = RenderingEstimate::kNever;
    for (std::size_t k = 1; k <= streams_.size(); ++k) {
      const std::size_t f = (last + k) % streams_.size();
      if (!streams_[f].arrived) continue;
      const std::uint64_t ready = splats_of(f, 0).front(now);
      if (ready >= first) continue;
      first = ready;
      from = f;
    }
    last = from;
    Stream& stream = streams_[from];
    stream.arrived = false;
    take(from, 0, stream.ended ? nullptr : &stream.splat);
    if (stream.ended) {
      --open;
    } else {
      filter(from);
    }
  }
}

// Until the fetch has given something to sorting.
void PaperEstimate::filter(std::size_t f) {
  CoarseFilterEstimate& coarse = units_.coarse[f];
  Stream& stream = streams_[f];
  const std::vector<CandidateWork>& all = work_.groups[group_].candidates;
  std::uint32_t parts = 0;
  const auto passes = [&](std::uint32_t slot) -> std::uint32_t {
    parts = 0;
    if (stream.next == stream.end || all[stream.next].slot != slot) return 0;
    const CandidateWork& candidate = all[stream.next++];
    for (std::size_t p = 0; p < finished_from_.size(); ++p) {
      const bool open = finished_from_[p] > coarse.now();
      if (open && (candidate.parts >> p & 1U) != 0) parts |= 1U << p;
    }
    return count_parts(parts);
  };
  while (!stream.arrived && !stream.ended) {
    if (coarse.next(passes)) {
      coarse.go_on(candidates_[f].push(coarse.now()));
      const CandidateWork& of = all[stream.next - 1];
      to_fine(f, {group_, of.slot, false, parts, of.splats, finished_from_.data()}, &of);
    } else {
      coarse.end();
      coarse.go_on(candidates_[f].push(coarse.now()));
      FineFilterEstimate::Candidate mark;
      mark.group = group_;
      mark.mark = true;
      stream.ended = true;
      to_fine(f, mark, nullptr);
    }
  }
}

// of: null with a mark.
void PaperEstimate::to_fine(std::size_t f, const FineFilterEstimate::Candidate& candidate,
                            const CandidateWork* of) {
  Stream& stream = streams_[f];
  const std::uint32_t* const splats =
      of == nullptr ? nullptr : work_.groups[group_].splats.data() + of->first_splat;
  units_.fine[f].take(
      candidate, candidates_[f],
      [&](std::uint32_t part) -> FifoTimes& { return splats_of(f, part); },
      [&](std::uint32_t part, std::uint64_t now, bool) {
        const std::uint32_t* const splat =
            of == nullptr ? nullptr : splats + count_parts(of->splats & ((1U << part) - 1));
        splats_of(f, part).push(now);
        if (streams_.size() == 1) {
          take(f, part, splat);
        } else {
          stream.arrived = true;
          if (splat != nullptr) stream.splat = *splat;
        }
      });
}

// splat: null: the mark behind those of a fetch.
void PaperEstimate::take(std::size_t f, std::uint32_t part, const std::uint32_t* splat) {
  PaperSorterEstimate& sorter = units_.sorters[list_of(part)];
  FifoTimes& splats = splats_of(f, part);
  if (splat == nullptr) {
    sorter.take_mark(splats);
  } else {
    sorter.take(*splat, splats, finished_from_[part]);
  }
}

void PaperEstimate::sort_and_blend(std::uint32_t part) {
  PaperSorterEstimate& sorter = units_.sorters[list_of(part)];
  RenderingEstimate& rendering = *units_.rendering[part];
  FifoTimes& sorted = sorted_[list_of(part)];
  sorter.sort(finished_from_[part], [&](std::uint32_t splat, std::uint64_t now) {
    now = sorted.push(now);
    rendering.blend(sorted, splat);
    finished_from_[part] = std::min(finished_from_[part], rendering.finished_from());
    return now;
  });
  sorter.go_on(sorted.push(sorter.now()));
  rendering.pass(sorted);
}

}  // namespace sgs
