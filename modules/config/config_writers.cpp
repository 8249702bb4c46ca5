// Visitors that write a configuration: as JSON, and as a list for people.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "algorithm/files/input_error.h"
#include "modules/config/strict_json.h"

namespace sgs {

namespace {
using Json = nlohmann::ordered_json;

class JsonWriter : public ConfigWriter {
 public:
  std::string text() const override { return stack_.front().second.dump(2) + "\n"; }

 protected:
  void on_bool(const char* key, bool& value, const char*) override { top()[key] = value; }
  void on_string(const char* key, std::string& value, const char*) override { top()[key] = value; }
  void on_real(const char* key, double& value, ConfigRange, const char*) override {
    top()[key] = value;
  }
  void on_reals(const char* key, std::vector<double>& value, ConfigRange, const char*) override {
    top()[key] = value;
  }
  void on_integer(const char* key, std::int64_t& value, ConfigRange, const char*) override {
    top()[key] = value;
  }
  void on_choice(const char* key, std::size_t& index, const std::vector<const char*>& allowed,
                 const char*) override {
    top()[key] = allowed[index];
  }
  void begin_section(const char* key, const char*) override {
    stack_.emplace_back(key, Json::object());
  }
  void end_section() override {
    auto finished = std::move(stack_.back());
    stack_.pop_back();
    top()[finished.first] = std::move(finished.second);
  }
  std::vector<std::string> free_keys(const std::vector<std::string>& present) override {
    return present;
  }

 private:
  Json& top() { return stack_.back().second; }
  std::vector<std::pair<std::string, Json>> stack_{{"", Json::object()}};
};

class ListingWriter : public ConfigWriter {
 public:
  std::string text() const override { return text_; }

 protected:
  void on_bool(const char* key, bool& value, const char* doc) override {
    line(key, value ? "true" : "false", "true, false", doc);
  }
  void on_string(const char* key, std::string& value, const char* doc) override {
    line(key, value, "text", doc);
  }
  void on_real(const char* key, double& value, ConfigRange range, const char* doc) override {
    line(key, fmt::format("{}", value), interval(range), doc);
  }
  void on_reals(const char* key, std::vector<double>& value, ConfigRange range,
                const char* doc) override {
    std::vector<std::string> texts;
    for (const double one : value) texts.push_back(fmt::format("{}", one));
    line(key, "[" + join(texts) + "]", interval(range), doc);
  }
  void on_integer(const char* key, std::int64_t& value, ConfigRange range,
                  const char* doc) override {
    line(key, fmt::format("{}", value),
         fmt::format("{}..{}", static_cast<std::int64_t>(range.lo),
                     static_cast<std::int64_t>(range.hi)),
         doc);
  }
  void on_choice(const char* key, std::size_t& index, const std::vector<const char*>& allowed,
                 const char* doc) override {
    line(key, allowed[index], join(allowed), doc);
  }
  void begin_section(const char* key, const char*) override {
    path_.push_back(std::string(key) + ".");
  }
  void end_section() override { path_.pop_back(); }
  std::vector<std::string> free_keys(const std::vector<std::string>& present) override {
    return present;
  }

 private:
  static std::string interval(ConfigRange range) {
    return fmt::format("{}..{}", static_cast<double>(range.lo), static_cast<double>(range.hi));
  }
  void line(const std::string& key, const std::string& value, const std::string& allowed,
            const char* doc) {
    text_ += fmt::format("{}{} = {}  ({})  {}\n", join(path_, ""), key, value, allowed, doc);
  }
  std::vector<std::string> path_;
  std::string text_;
};

}  // namespace

std::unique_ptr<ConfigWriter> make_json_writer() { return std::make_unique<JsonWriter>(); }
std::unique_ptr<ConfigWriter> make_listing_writer() { return std::make_unique<ListingWriter>(); }

}  // namespace sgs
