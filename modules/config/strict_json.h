// Configurations as JSON, read strictly. Refused are unknown or doubled keys, wrong types, values
// out of range and unknown names. The InputError says where, what was found and what is allowed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "modules/config/config_visitor.h"

namespace sgs {

// Origin of a value of a document, as named by add_file() and the like.
struct ConfigOrigin {
  std::string path;  // path of the key from the document's root: "dram.channels"
  std::string origin;
};

// A JSON object put together from files and overrides, later ones over earlier ones.
class ConfigDocument {
 public:
  ConfigDocument();
  ~ConfigDocument();
  ConfigDocument(ConfigDocument&&) noexcept;
  ConfigDocument& operator=(ConfigDocument&&) noexcept;

  // Adds a file's, or a text's, object: objects are merged key by key, all else replaces. `origin`
  // stands for the file in messages. InputError as in input_json.h, and for what is no object.
  void add_file(const std::string& path) { add_file(path, path); }
  void add_file(const std::string& path, const std::string& origin);
  void add_text(const std::string& text, const std::string& origin);
  // Adds another document's values, each with its origin.
  void add(const ConfigDocument& other);

  // Sets one value: "key.path=value", the value being JSON or, failing that, a plain string.
  void add_override(const std::string& assignment);

  // The text at a key of the top level; empty where there is none.
  std::string text_at(const std::string& key) const;

  // The same, and the key is gone. InputError where something else stands there. expected: what
  // texts are, in words.
  std::string take_text(const std::string& key, const std::string& expected);

  // Origins of all values (not objects), by path.
  std::vector<ConfigOrigin> origins() const;

  // Fills `config` (whose present values are the defaults) by visit(v, config). Keys of the
  // document that visit() does not name are refused.
  template <class Struct>
  void read_into(Struct& config) const {
    const std::unique_ptr<ConfigVisitor> reader = make_reader();
    visit(*reader, config);
    finish(*reader);
  }

  // Reads the section `key` alone. The rest of the document is for others to read; only keys of
  // this section that stand outside of it are refused.
  template <class Struct>
  void read_section_into(const char* key, Struct& config) const {
    const std::unique_ptr<ConfigVisitor> reader = make_reader();
    reader->section(key, config, "");
    finish_section(*reader, key);
  }

 private:
  struct Content;
  std::unique_ptr<ConfigVisitor> make_reader() const;
  static void finish(const ConfigVisitor& reader);
  static void finish_section(const ConfigVisitor& reader, const char* section);

  std::unique_ptr<Content> content_;
};

// Writing visitors, and what they have written so far.
class ConfigWriter : public ConfigVisitor {
 public:
  virtual std::string text() const = 0;
};
std::unique_ptr<ConfigWriter> make_json_writer();
std::unique_ptr<ConfigWriter> make_commented_writer();
std::unique_ptr<ConfigWriter> make_listing_writer();

// A configuration as indented JSON: what --print-config prints, readable again.
template <class Struct>
std::string config_to_json(Struct config) {
  const std::unique_ptr<ConfigWriter> writer = make_json_writer();
  visit(static_cast<ConfigVisitor&>(*writer), config);
  return writer->text();
}

// The same, each key with a comment: "rcd": 15,  // 1..1000000: activate to read or write
template <class Struct>
std::string config_to_commented_json(Struct config) {
  const std::unique_ptr<ConfigWriter> writer = make_commented_writer();
  visit(static_cast<ConfigVisitor&>(*writer), config);
  return writer->text();
}

}  // namespace sgs
