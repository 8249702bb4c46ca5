// Encoding of track_events.h.
#include "testbench/timeline/track_events.h"

#include <cstring>

namespace sgs {
namespace {

// Numbers of fields, and values of enumerations.
namespace trace {
constexpr std::uint32_t kPacket = 1;
}
namespace packet_field {
constexpr std::uint32_t kTimestamp = 8, kSequenceId = 10, kTrackEvent = 11, kInternedData = 12,
                        kSequenceFlags = 13, kTrackDescriptor = 60;
}
constexpr std::uint64_t kStateCleared = 1, kNeedsState = 2;  // SequenceFlags
namespace descriptor {
constexpr std::uint32_t kUuid = 1, kName = 2, kProcess = 3, kParentUuid = 5, kCounter = 8,
                        kChildOrdering = 11, kSiblingOrderRank = 12;
}
constexpr std::uint64_t kExplicit = 3;  // ChildTracksOrdering
namespace process_field {
constexpr std::uint32_t kPid = 1, kProcessName = 6;
}
namespace counter_field {
constexpr std::uint32_t kUnit = 3, kUnitName = 6;
}
constexpr std::uint64_t kUnitCount = 2;
namespace interned {
constexpr std::uint32_t kEventNames = 2, kIid = 1, kText = 2;
}
namespace event_field {
constexpr std::uint32_t kType = 9, kNameIid = 10, kTrackUuid = 11, kName = 23, kCounterValue = 30,
                        kDoubleCounterValue = 44;
}
constexpr std::uint64_t kSliceBegin = 1, kSliceEnd = 2, kCounterType = 4;

}  // namespace

// One message, as far as it was put together.
class TrackEvents::Message {
 public:
  Message& number(std::uint32_t field, std::uint64_t value) {
    varint(field << 3U | kVarint);
    varint(value);
    return *this;
  }
  Message& real(std::uint32_t field, double value) {
    varint(field << 3U | kFixed64);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);  // little-endian, as the machines we run on
    bytes_.append(bytes, sizeof value);
    return *this;
  }
  Message& text(std::uint32_t field, std::string_view value) {
    varint(field << 3U | kLength);
    varint(value.size());
    bytes_.append(value);
    return *this;
  }
  Message& message(std::uint32_t field, const Message& value) { return text(field, value.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::uint32_t kVarint = 0, kFixed64 = 1, kLength = 2;  // wire types

  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) bytes_ += static_cast<char>(value | 0x80U);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

TrackEvents::TrackEvents(OutputFile& to) : to_(to) {
  Message first;
  first.number(packet_field::kSequenceFlags, kStateCleared);
  packet(first);
}

void TrackEvents::packet(const Message& packet) {
  Message with_sequence = packet;
  with_sequence.number(packet_field::kSequenceId, 1);
  Message out;
  out.message(trace::kPacket, with_sequence);
  to_.write(out.bytes());
  bytes_ += out.bytes().size();
}

TrackEvents::Track TrackEvents::describe(Message& descriptor) {
  descriptor.number(descriptor::kUuid, next_track_);
  descriptor.number(descriptor::kChildOrdering, kExplicit);
  descriptor.number(descriptor::kSiblingOrderRank, next_track_);
  Message out;
  out.message(packet_field::kTrackDescriptor, descriptor);
  packet(out);
  return next_track_++;
}

TrackEvents::Track TrackEvents::process(std::string_view name) {
  Message process, descriptor;
  process.number(process_field::kPid, 1).text(process_field::kProcessName, name);
  descriptor.text(descriptor::kName, name).message(descriptor::kProcess, process);
  return describe(descriptor);
}

TrackEvents::Track TrackEvents::track(Track parent, std::string_view name) {
  Message descriptor;
  descriptor.text(descriptor::kName, name).number(descriptor::kParentUuid, parent);
  return describe(descriptor);
}

TrackEvents::Track TrackEvents::counter(Track parent, std::string_view name,
                                        std::string_view unit) {
  Message counter, descriptor;
  if (unit.empty()) {
    counter.number(counter_field::kUnit, kUnitCount);
  } else {
    counter.text(counter_field::kUnitName, unit);
  }
  descriptor.text(descriptor::kName, name).number(descriptor::kParentUuid, parent);
  descriptor.message(descriptor::kCounter, counter);
  return describe(descriptor);
}

TrackEvents::Name TrackEvents::name(std::string_view text) {
  Message entry, data, out;
  entry.number(interned::kIid, next_name_).text(interned::kText, text);
  data.message(interned::kEventNames, entry);
  out.message(packet_field::kInternedData, data).number(packet_field::kSequenceFlags, kNeedsState);
  packet(out);
  return next_name_++;
}

void TrackEvents::event(std::uint64_t time, const Message& track_event) {
  Message out;
  out.number(packet_field::kTimestamp, time);
  out.number(packet_field::kSequenceFlags, kNeedsState);
  out.message(packet_field::kTrackEvent, track_event);
  packet(out);
}

void TrackEvents::begin(Track track, std::uint64_t time, Name name) {
  Message e;
  e.number(event_field::kType, kSliceBegin).number(event_field::kTrackUuid, track);
  event(time, e.number(event_field::kNameIid, name));
  ++slices_;
}

void TrackEvents::begin(Track track, std::uint64_t time, std::string_view name) {
  Message e;
  e.number(event_field::kType, kSliceBegin).number(event_field::kTrackUuid, track);
  event(time, e.text(event_field::kName, name));
  ++slices_;
}

void TrackEvents::end(Track track, std::uint64_t time) {
  Message e;
  event(time, e.number(event_field::kType, kSliceEnd).number(event_field::kTrackUuid, track));
}

void TrackEvents::value(Track track, std::uint64_t time, std::uint64_t value) {
  Message e;
  e.number(event_field::kType, kCounterType).number(event_field::kTrackUuid, track);
  event(time, e.number(event_field::kCounterValue, value));
  ++values_;
}

void TrackEvents::value(Track track, std::uint64_t time, double value) {
  Message e;
  e.number(event_field::kType, kCounterType).number(event_field::kTrackUuid, track);
  event(time, e.real(event_field::kDoubleCounterValue, value));
  ++values_;
}

}  // namespace sgs
