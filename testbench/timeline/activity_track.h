// One activity as slices: what it works on, and within that its work and its waiting by cause.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "testbench/timeline/track_events.h"
#include "tlm/activity.h"

namespace sgs {

// Groups of pixels, or tiles, by their numbers.

// Both ends are among them.
struct GroupRange {
  std::uint32_t first = 0, last = UINT32_MAX;
  bool holds(std::uint32_t group) const { return first <= group && group <= last; }
  bool all() const { return first == 0 && last == UINT32_MAX; }
};

// Says what a place is called.
using PlaceName = std::function<std::string(const sc_core::sc_object&)>;

// The track of one activity. The cause of a wait is known when the wait has ended: slices are
// written then. Idle time is a gap.
class ActivityTrack {
 public:
  ActivityTrack(const Activity& activity, TrackEvents& events, TrackEvents::Track track,
                const GroupRange& groups, PlaceName place_name);

  // To be called when an instant is over in which it may have changed, at the latest before the
  // next one. window_from: what belongs to no group is shown from there on; none: not at all.
  void look(std::uint64_t now, std::optional<std::uint64_t> window_from);
  // After the last look: closes what is open.
  void finish();

  // It works on one of the groups now.
  bool in_range() const { return item_.what != nullptr && groups_.holds(item_.number); }

 private:
  using Item = Activity::Item;
  static constexpr std::size_t kWorking = ~std::size_t{0};
  struct Slice {
    std::uint64_t begin = 0, end = 0;
    std::size_t state = 0;  // kWorking, or an index of the activity's waits
    Item item;
  };

  std::size_t take_state();
  void add(const Slice& slice, std::optional<std::uint64_t> window_from);
  void write();
  void close_items(std::size_t keep);
  TrackEvents::Name name_of(std::size_t state);

  const Activity& activity_;
  TrackEvents& events_;
  const TrackEvents::Track track_;
  const GroupRange groups_;
  const PlaceName place_name_;

  // Seen so far.
  std::uint64_t until_ = 0, busy_ = 0;
  std::vector<std::uint64_t> waited_;
  Item item_, item_at_until_;
  std::vector<std::pair<std::uint64_t, Item>> changes_;  // changes of the item, from until_ on

  std::optional<Slice> pending_;  // may still grow
  Item open_;                     // whose slices are open: its group's, and its visit's
  std::size_t open_slices_ = 0;
  std::uint64_t open_until_ = 0;                    // where the last slice within ended
  std::map<std::size_t, TrackEvents::Name> names_;  // by state
};

}  // namespace sgs
