// The values that units publish, for the checks at the end of a case.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tlm/data_sheet.h"

namespace sgs::tb {

class Published : public DataSheet {
 public:
  void activity(Activity& activity, const char* resource, const char*) override {
    activities.push_back(&activity);
    activity_of_[resource] = &activity;
  }
  void counter(const char* name, const char*, const char*, std::uint64_t value) override {
    counters_[name] += value;
  }
  void datapath(const Datapath& path, std::uint64_t items) override {
    items_[path.name] += items;
    operations(path.component.c_str(), path.lane.c_str(),
               static_cast<double>(items) * path.used_macs);
    for (const BesideLanes& beside : path.beside) {
      operations(path.component.c_str(), beside.kind.c_str(),
                 static_cast<double>(items) * beside.operations);
    }
  }
  void accesses(const char* use, std::uint64_t reads, std::uint64_t writes) override {
    accesses_[use].first += reads;
    accesses_[use].second += writes;
  }
  void operations(const char* component, const char* kind, double count) override {
    operations_[std::string(component) + " " + kind] += count;
  }
  void queue(FifoChannel& queue, const char*) override { queues.push_back(&queue); }
  void port(MemoryPort& port, const char*) override { ports.push_back(&port); }

  std::vector<Activity*> activities;
  std::vector<FifoChannel*> queues;
  std::vector<MemoryPort*> ports;

  // std::out_of_range when nobody publishes it. Counters and operations are added up over the
  // units, as they were when they were published.
  std::uint64_t busy_cycles(const std::string& resource) const {
    return activity_of_.at(resource)->busy_cycles();
  }
  std::uint64_t counter(const std::string& name) const { return counters_.at(name); }
  std::uint64_t items(const std::string& datapath) const { return items_.at(datapath); }
  // Reads and writes of a use.
  std::pair<std::uint64_t, std::uint64_t> accesses(const std::string& use) const {
    return accesses_.at(use);
  }
  double operations(const std::string& component, const std::string& kind) const {
    return operations_.at(component + " " + kind);
  }

 private:
  std::map<std::string, const Activity*> activity_of_;  // [resource], which has only one here
  std::map<std::string, std::uint64_t> counters_;
  std::map<std::string, double> operations_;
  std::map<std::string, std::uint64_t> items_;
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> accesses_;
};

}  // namespace sgs::tb
