// Strict configuration: what is read, what is refused and with which words.
#include "modules/config/strict_json.h"

#include <catch2/catch.hpp>

#include "algorithm/files/input_error.h"

namespace sgs {

enum class Colour { kRed, kGreen };

struct Inner {
  std::uint32_t depth = 4;
  bool on = false;
};
struct Outer {
  std::uint8_t lanes = 16;
  double rate_mhz = 800.0;
  std::optional<double> pj;
  std::string label = "x";
  Colour colour = Colour::kRed;
  std::vector<double> taps = {1.0};
  Inner inner;
  std::map<std::string, Inner> sets;
  std::map<std::string, std::string> notes;
};

void visit(ConfigVisitor& v, Inner& c) {
  v("depth", c.depth, in_range(1, 1024), "entries");
  v("on", c.on, "whether");
}
void visit(ConfigVisitor& v, Outer& c) {
  v("lanes", c.lanes, at_least(1), "lanes");
  v("rate_mhz", c.rate_mhz, in_range(1.0, 5000.0), "rate");
  v("pj", c.pj, in_range(0.0, 9.0), "energy");
  v("label", c.label, "text");
  v("colour", c.colour, names<Colour>({{"red", Colour::kRed}, {"green", Colour::kGreen}}), "hue");
  v("taps", c.taps, in_range(-1.0, 1.0), "filter");
  v.section("inner", c.inner, "nested");
  v.sections("sets", c.sets, "by name");
  v.strings("notes", c.notes, "free text");
}

namespace {

Outer read(const std::string& text) {
  ConfigDocument document;
  document.add_text(text, "test.json");
  Outer config;
  document.read_into(config);
  return config;
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  return "accepted";
}

TEST_CASE("strict json: values, names, nested objects and defaults") {
  const Outer c = read(R"({"lanes": 8, "colour": "green", "inner": {"depth": 9}, "taps": [0.5, -1],
                           "sets": {"a": {"on": true}}, "notes": {"k": "v"}})");
  CHECK(c.lanes == 8);
  CHECK(c.rate_mhz == 800.0);
  CHECK(!c.pj);
  CHECK(read(R"({"pj": 0})").pj == 0.0);
  CHECK(!read(R"({"pj": null})").pj);
  CHECK(c.colour == Colour::kGreen);
  CHECK(c.inner.depth == 9);
  CHECK(c.taps == std::vector<double>{0.5, -1.0});
  CHECK(c.sets.at("a").on);
  CHECK(c.sets.at("a").depth == 4);
  CHECK(c.notes.at("k") == "v");
}

TEST_CASE("strict json: refusals name file, key, what was found and what is allowed") {
  CHECK(refusal(R"({"lane": 8})") ==
        "test.json: lane: unknown key; did you mean lanes? Expected one of colour, inner, label, "
        "lanes, notes, pj, rate_mhz, sets, taps");
  CHECK(refusal(R"({"colur": "red"})").find("; did you mean colour?") != std::string::npos);
  CHECK(refusal(R"({"depht": 3})").find("; did you mean inner.depth?") != std::string::npos);
  CHECK(refusal(R"({"colour": "gren"})") ==
        "test.json: colour: got \"gren\"; did you mean green? Expected one of red, green");
  CHECK(refusal(R"({"inner": {"width": 8}})") ==
        "test.json: inner.width: unknown key, expected one of depth, on");
  CHECK(refusal(R"({"inner": {"depth": 0}})") ==
        "test.json: inner.depth: got 0, expected an integer in [1, 1024]");
  CHECK(refusal(R"({"lanes": 256})") ==
        "test.json: lanes: got 256, expected an integer in [1, 255]");
  CHECK(refusal(R"({"lanes": -1})") == "test.json: lanes: got -1, expected an integer in [1, 255]");
  CHECK(refusal(R"({"lanes": 1.5})") ==
        "test.json: lanes: got 1.5, expected an integer in [1, 255]");
  CHECK(refusal(R"({"lanes": 18446744073709551615})") ==
        "test.json: lanes: got 18446744073709551615, expected an integer in [1, 255]");
  CHECK(refusal(R"({"lanes": "8"})") ==
        "test.json: lanes: got \"8\", expected an integer in [1, 255]");
  CHECK(refusal(R"({"rate_mhz": 0})") ==
        "test.json: rate_mhz: got 0, expected a number in [1, 5000]");
  CHECK(refusal(R"({"pj": -0.5})") ==
        "test.json: pj: got -0.5, expected a number in [0, 9], or null");
  CHECK(refusal(R"({"colour": "blue"})") ==
        "test.json: colour: got \"blue\", expected one of red, green");
  CHECK(refusal(R"({"inner": 3})") == "test.json: inner: got 3, expected an object");
  CHECK(refusal(R"({"inner": {"on": 1}})") == "test.json: inner.on: got 1, expected true or false");
  CHECK(refusal(R"({"taps": [2]})") == "test.json: taps: got 2, expected a number in [-1, 1]");
  CHECK(refusal(R"({"lanes": 1, "lanes": 2})") ==
        "test.json: key 'lanes' twice in one object, expected once");
  CHECK(refusal("[1]") == "test.json: got a JSON array, expected an object");
  CHECK(refusal("{").find("test.json: line 1, column 2: not JSON: ") == 0);
  CHECK(refusal(R"({"label": "v"})") == "accepted");
}

TEST_CASE("strict json: later sources override earlier ones, and messages say which") {
  ConfigDocument document;
  document.add_text(R"({"lanes": 8, "inner": {"depth": 7, "on": true}})", "a.json");
  document.add_override("inner.depth=12");
  document.add_override("colour=green");
  document.add_override("label=3 apples");
  Outer c;
  document.read_into(c);
  CHECK(c.inner.depth == 12);
  CHECK(c.inner.on);
  CHECK(c.colour == Colour::kGreen);
  CHECK(c.label == "3 apples");

  document.add_override("inner.depth=0");
  try {
    document.read_into(c);
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()) ==
          "--set inner.depth=0: inner.depth: got 0, expected an integer in [1, 1024]");
  }
  CHECK_THROWS_AS(document.add_override("inner.depth"), InputError);
  CHECK_THROWS_AS(document.add_override("=3"), InputError);
  CHECK_THROWS_AS(document.add_override("inner..depth=3"), InputError);
  CHECK_THROWS_AS(document.add_file("/nowhere/x.json"), InputError);
}

TEST_CASE("strict json: who said what, the last one counts") {
  ConfigDocument document;
  document.add_text(R"({"label": "a", "inner": {"depth": 5, "on": true}, "lanes": 3})", "base");
  document.add_text(R"({"inner": {"depth": 6}, "inner2": {"depth": 7}})", "mine");
  document.add_override("sets.inner.on=true");
  CHECK(document.text_at("label") == "a");
  CHECK(document.text_at("lanes").empty());
  CHECK(document.text_at("colour").empty());
  document.add_override("label=b");
  CHECK(document.text_at("label") == "b");
  std::string said;
  for (const ConfigOrigin& value : document.origins()) {
    said += value.path + " by " + value.origin + "; ";
  }
  CHECK(said ==
        "inner.depth by mine; inner.on by base; inner2.depth by mine; label by --set label=b; "
        "lanes by base; sets.inner.on by --set sets.inner.on=true; ");
}

TEST_CASE("strict json: what is printed reads back as the same configuration") {
  Outer c;
  c.lanes = 3;
  c.rate_mhz = 0.1 + 799.9;
  c.colour = Colour::kGreen;
  c.sets["one"].depth = 77;
  c.notes["why"] = "\"quoted\"";
  const std::string text = config_to_json(c);
  const Outer back = read(text);
  CHECK(config_to_json(back) == text);
  CHECK(back.lanes == 3);
  CHECK(back.rate_mhz == c.rate_mhz);
  CHECK(!back.pj);
  CHECK(back.sets.at("one").depth == 77);
  CHECK(back.notes.at("why") == "\"quoted\"");
  const std::string commented = config_to_commented_json(c);
  CHECK(commented.find("\"depth\": 4,  // 1..1024: entries\n") != std::string::npos);
  CHECK(commented.find("\"pj\": null,  // 0..9, null: energy\n") != std::string::npos);
}

}  // namespace
}  // namespace sgs
