// Visitors that write a configuration: as JSON, with comments or without, and as a list for people.
#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "algorithm/files/input_error.h"
#include "modules/config/strict_json.h"

namespace sgs {

namespace {
using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

class JsonWriter : public ConfigWriter {
 public:
  std::string text() const override { return stack_.front().second.dump(2) + "\n"; }

 protected:
  void on_bool(const char* key, bool& value, const char*) override { top()[key] = value; }
  void on_string(const char* key, std::string& value, const char*) override { top()[key] = value; }
  void on_real(const char* key, double& value, ConfigRange, const char*) override {
    top()[key] = value;
  }
  void on_open_real(const char* key, std::optional<double>& value, ConfigRange,
                    const char*) override {
    top()[key] = json_of(value);
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

// What it writes says of each key which values are allowed and what they mean.
class ExplainingWriter : public ConfigWriter {
 protected:
  void on_bool(const char* key, bool& value, const char* doc) override {
    line(key, value, "true, false", doc);
  }
  void on_string(const char* key, std::string& value, const char* doc) override {
    line(key, value, "text", doc);
  }
  void on_real(const char* key, double& value, ConfigRange range, const char* doc) override {
    line(key, value, interval(range), doc);
  }
  void on_open_real(const char* key, std::optional<double>& value, ConfigRange range,
                    const char* doc) override {
    line(key, json_of(value), interval(range) + ", null", doc);
  }
  void on_reals(const char* key, std::vector<double>& value, ConfigRange range,
                const char* doc) override {
    line(key, value, interval(range), doc);
  }
  void on_integer(const char* key, std::int64_t& value, ConfigRange range,
                  const char* doc) override {
    line(key, value,
         fmt::format("{}..{}", static_cast<std::int64_t>(range.lo),
                     static_cast<std::int64_t>(range.hi)),
         doc);
  }
  void on_choice(const char* key, std::size_t& index, const std::vector<const char*>& allowed,
                 const char* doc) override {
    line(key, allowed[index], join(allowed), doc);
  }
  std::vector<std::string> free_keys(const std::vector<std::string>& present) override {
    return present;
  }
  virtual void line(const char* key, const Json& value, const std::string& allowed,
                    const char* doc) = 0;

 private:
  static std::string interval(ConfigRange range) {
    return fmt::format("{}..{}", static_cast<double>(range.lo), static_cast<double>(range.hi));
  }
};

class ListingWriter : public ExplainingWriter {
 public:
  std::string text() const override { return text_; }

 protected:
  void begin_section(const char* key, const char*) override {
    path_.push_back(std::string(key) + ".");
  }
  void end_section() override { path_.pop_back(); }
  void line(const char* key, const Json& value, const std::string& allowed,
            const char* doc) override {
    text_ += fmt::format("{}{} = {}  ({})  {}\n", join(path_, ""), key, plain(value), allowed, doc);
  }

 private:
  static std::string plain(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{}", value.get<double>());
    if (!value.is_array()) return value.dump();
    std::vector<std::string> texts;
    for (const Json& one : value) texts.push_back(plain(one));
    return "[" + join(texts) + "]";
  }

  std::vector<std::string> path_;
  std::string text_;
};

// JSON with a comment behind each key: what is allowed, and what it means.
class CommentedWriter : public ExplainingWriter {
 public:
  std::string text() const override {
    std::string all = "{\n";
    for (const Line& line : lines_) {
      all += line.json + (line.comma ? "," : "");
      all += line.comment.empty() ? "\n" : "  // " + line.comment + "\n";
    }
    return all + "}\n";
  }

 protected:
  void begin_section(const char* key, const char* doc) override {
    add(fmt::format("{}{}: {{", indent(), Json(key).dump()), doc);
    last_.push_back(kNone);
  }
  void end_section() override {
    last_.pop_back();
    lines_.push_back({indent() + "}", "", false});
    last_.back() = lines_.size() - 1;
  }
  void line(const char* key, const Json& value, const std::string& allowed,
            const char* doc) override {
    const std::string comment = *doc == '\0' ? "" : fmt::format("{}: {}", allowed, doc);
    add(fmt::format("{}{}: {}", indent(), Json(key).dump(), value.dump()), comment);
  }

 private:
  static constexpr std::size_t kNone = SIZE_MAX;
  struct Line {
    std::string json, comment;
    bool comma;  // another entry of the same object follows
  };

  std::string indent() const { return std::string(2 * last_.size(), ' '); }
  void add(std::string json, std::string comment) {
    if (last_.back() != kNone) lines_[last_.back()].comma = true;
    last_.back() = lines_.size();
    lines_.push_back({std::move(json), std::move(comment), false});
  }

  std::vector<Line> lines_;
  std::vector<std::size_t> last_{kNone};  // [level] the last entry's line
};

}  // namespace

std::unique_ptr<ConfigWriter> make_json_writer() { return std::make_unique<JsonWriter>(); }
std::unique_ptr<ConfigWriter> make_commented_writer() {
  return std::make_unique<CommentedWriter>();
}
std::unique_ptr<ConfigWriter> make_listing_writer() { return std::make_unique<ListingWriter>(); }

}  // namespace sgs
