// One description of a report serves writing it and telling what it holds: each entry has its key,
// unit and meaning where its value is given.
//
//   r.object("frame", [&] {
//     r("cycles", "cycles", "Cycles from time 0 until the last pixel is in DRAM.", run.cycles);
//     r("fps", "1/s", "Frames a second at this frame time.", [&] { return 1 / run.time_s(); });
//   });
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "testbench/streaminggs/report/report_entry.h"

namespace sgs {

class ReportVisitor {
 public:
  using Json = nlohmann::ordered_json;

  // A key as it is written, and as it is told: keys that the data brings are told as one in
  // capitals, for example PATH.
  struct Key {
    Key(const char* key) : told(key), written(key) {}
    Key(std::string told_key, std::string written_key)
        : told(std::move(told_key)), written(std::move(written_key)) {}
    std::string told, written;
  };

  virtual ~ReportVisitor() = default;

  // An entry. value: its value, or a function of nothing that makes it, which is not called when
  // entries are told. unit: empty where it has none.
  template <class Value>
  void operator()(const Key& key, const char* unit, const char* meaning, const Value& value) {
    if constexpr (!std::is_invocable_v<Value>) {
      on_value(key, unit, meaning, Json(value));
    } else if (telling()) {
      on_value(key, unit, meaning, Json());
    } else {
      on_value(key, unit, meaning, Json(value()));
    }
  }

  // True where entries are given that a report may lack: it has them, or they are told.
  bool has(bool there) const { return there || telling(); }

  // An object of the entries that `entries()` gives; begun again, it goes on.
  template <class Entries>
  void object(const Key& key, const Entries& entries) {
    begin_object(key);
    entries();
    end();
  }

  // Calls entries(element) for each element. They are told of one element, made by default.
  template <class List, class Entries>
  void each(const List& list, const Entries& entries) {
    if (telling()) return entries(typename List::value_type{});
    for (const auto& element : list) entries(element);
  }
  template <class Element, class Entries>
  void each(const std::optional<Element>& maybe, const Entries& entries) {
    if (telling()) return entries(Element{});
    if (maybe) entries(*maybe);
  }

  // A list of objects, one for each element.
  template <class List, class Entries>
  void list(const Key& key, const List& of, const Entries& entries) {
    begin_list(key);
    each(of, [&](const auto& element) {
      begin_element();
      entries(element);
      end();
    });
    end();
  }

  virtual bool telling() const = 0;

 protected:
  virtual void on_value(const Key& key, const char* unit, const char* meaning, Json value) = 0;
  virtual void begin_object(const Key& key) = 0;
  virtual void begin_list(const Key& key) = 0;
  virtual void begin_element() = 0;
  virtual void end() = 0;  // of an object, a list or an element
};

// Writes entries into a JSON object, behind those that it has. The object outlives the writer.
class ReportWriter : public ReportVisitor {
 public:
  explicit ReportWriter(Json& report) : at_{&report} {}
  bool telling() const override { return false; }

 protected:
  void on_value(const Key& key, const char*, const char*, Json value) override {
    (*at_.back())[key.written] = std::move(value);
  }
  void begin_object(const Key& key) override {
    Json& object = (*at_.back())[key.written];
    if (object.is_null()) object = Json::object();
    at_.push_back(&object);
  }
  void begin_list(const Key& key) override {
    Json& list = (*at_.back())[key.written];
    list = Json::array();
    at_.push_back(&list);
  }
  void begin_element() override { at_.push_back(&at_.back()->emplace_back(Json::object())); }
  void end() override { at_.pop_back(); }

 private:
  std::vector<Json*> at_;  // from the report to the object or list that is being written
};

// Collects entries, each path once.
class ReportTeller : public ReportVisitor {
 public:
  const std::vector<ReportEntry>& entries() const { return entries_; }
  bool telling() const override { return true; }

 protected:
  void on_value(const Key& key, const char* unit, const char* meaning, Json) override {
    const std::string path = path_of(key);
    const bool told = std::any_of(entries_.begin(), entries_.end(),
                                  [&](const ReportEntry& entry) { return entry.path == path; });
    if (!told) entries_.push_back({path, unit, meaning});
  }
  void begin_object(const Key& key) override { paths_.push_back(path_of(key) + "."); }
  void begin_list(const Key& key) override { paths_.push_back(path_of(key) + "[]."); }
  void begin_element() override { paths_.push_back(paths_.back()); }
  void end() override { paths_.pop_back(); }

 private:
  std::string path_of(const Key& key) const { return paths_.back() + key.told; }

  std::vector<std::string> paths_{""};
  std::vector<ReportEntry> entries_;
};

}  // namespace sgs
