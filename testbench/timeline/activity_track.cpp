#include "testbench/timeline/activity_track.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgs {

ActivityTrack::ActivityTrack(const Activity& activity, TrackEvents& events,
                             TrackEvents::Track track, const GroupRange& groups,
                             PlaceName place_name)
    : activity_(activity),
      events_(events),
      track_(track),
      groups_(groups),
      place_name_(std::move(place_name)) {}

// Counters that an activity closed at one moment, and at no other since the last look: one of them
// rose by the time between the two, what it did in between.
std::size_t ActivityTrack::take_state() {
  std::size_t state = 0;
  if (activity_.busy_cycles() != busy_) state = kWorking;
  busy_ = activity_.busy_cycles();
  const std::vector<Activity::Wait>& waits = activity_.waits();
  waited_.resize(waits.size());
  for (std::size_t i = 0; i < waits.size(); ++i) {
    if (waits[i].cycles != waited_[i]) state = i;
    waited_[i] = waits[i].cycles;
  }
  return state;
}

void ActivityTrack::look(std::uint64_t now, std::optional<std::uint64_t> window_from) {
  if (activity_.item() != item_) {
    item_ = activity_.item();
    changes_.emplace_back(now, item_);
  }
  const std::uint64_t closed = activity_.closed_at();
  if (closed == until_) return;
  const std::size_t state = take_state();
  std::size_t done = 0;
  for (; done < changes_.size() && changes_[done].first < closed; ++done) {
    const auto& [at, item] = changes_[done];
    if (at > until_) add({until_, at, state, item_at_until_}, window_from);
    until_ = std::max(until_, at);
    item_at_until_ = item;
  }
  changes_.erase(changes_.begin(), changes_.begin() + static_cast<std::ptrdiff_t>(done));
  add({until_, closed, state, item_at_until_}, window_from);
  until_ = closed;
}

void ActivityTrack::add(const Slice& slice, std::optional<std::uint64_t> window_from) {
  Slice shown = slice;
  if (slice.item.what != nullptr) {
    if (!groups_.holds(slice.item.number)) return;
  } else if (!groups_.all()) {
    if (!window_from) return;
    shown.begin = std::max(shown.begin, *window_from);
  }
  if (shown.state == Activity::kIdling || shown.begin >= shown.end) return;
  if (pending_ && pending_->end == shown.begin && pending_->state == shown.state &&
      pending_->item == shown.item) {
    pending_->end = shown.end;
    return;
  }
  write();
  pending_ = shown;
}

void ActivityTrack::write() {
  if (!pending_) return;
  const Slice& slice = *pending_;
  const Item& item = slice.item;
  const bool same_group = open_.what == item.what && open_.number == item.number;
  // The open slices of an item go on as long as nothing lies between.
  if (slice.begin > open_until_) {
    close_items(0);
  } else if (!(open_ == item)) {
    close_items(same_group ? 1 : 0);
  }
  if (item.what != nullptr && open_slices_ == 0) {
    events_.begin(track_, slice.begin, fmt::format("{} {}", item.what, item.number));
    open_slices_ = 1;
  }
  if (item.what != nullptr && item.visit != Activity::kNoVisit && open_slices_ == 1) {
    events_.begin(track_, slice.begin, fmt::format("visit {}", item.visit));
    open_slices_ = 2;
  }
  open_ = item;
  events_.begin(track_, slice.begin, name_of(slice.state));
  events_.end(track_, slice.end);
  open_until_ = slice.end;
  pending_.reset();
}

void ActivityTrack::close_items(std::size_t keep) {
  for (; open_slices_ > keep; --open_slices_) events_.end(track_, open_until_);
}

void ActivityTrack::finish() {
  write();
  close_items(0);
}

// "busy", or "waits for room: visits_to_hfu0"
TrackEvents::Name ActivityTrack::name_of(std::size_t state) {
  const auto known = names_.find(state);
  if (known != names_.end()) return known->second;
  std::string text = "busy";
  if (state != kWorking) {
    const Activity::Wait& wait = activity_.waits()[state];
    text = fmt::format("waits for {}", sgs::name_of(wait.what));
    if (wait.at != nullptr) text += ": " + place_name_(*wait.at);
  }
  return names_[state] = events_.name(text);
}

}  // namespace sgs
