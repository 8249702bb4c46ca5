// Options as CLI11 knows them.
#include "testbench/command_line/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <functional>
#include <limits>

#include "algorithm/files/input_error.h"
#include "testbench/command_line/version.h"

namespace sgs {
namespace {

// True if all of `text` is a number of the type of `value`.
template <class Number>
bool read(const std::string& text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

// CLI11 alone wraps -1 to 2^64 - 1, cuts 10^23 and takes nan for in range.
template <class Number>
CLI::Validator in_interval(Number lo, Number hi, const char* kind) {
  const std::string allowed = fmt::format("{} from {} to {}", kind, lo, hi);
  return CLI::Validator(
      [=](const std::string& text) {
        Number value{};
        const bool good = read(text, value) && value >= lo && value <= hi;
        return good ? std::string() : fmt::format("got '{}', expected {}", text, allowed);
      },
      fmt::format("in [{}, {}]", lo, hi));
}

// What a list's numbers may be, and the same in words.
template <class Number>
struct Allowed {
  std::function<bool(Number)> allows;
  std::string expected;
};

// texts: each time that the option was given.
template <class Number>
std::vector<Number> list_of(const std::vector<std::string>& texts, const char* name,
                            const Allowed<Number>& allowed) {
  const std::string text = join(texts, ",");
  std::vector<Number> values;
  const auto refuse = [&](const std::string& got, const std::string& expected) {
    throw CLI::ValidationError(name, fmt::format("got '{}', whose number {} is {}, expected {}",
                                                 text, values.size() + 1, got, expected));
  };
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    Number value{};
    if (!read(word, value) || !allowed.allows(value)) {
      refuse(fmt::format("'{}'", word), allowed.expected);
    }
    if (std::find(values.begin(), values.end(), value) != values.end()) {
      refuse(word + " again", "different ones");
    }
    values.push_back(value);
    begin = end + 1;
  }
  return values;
}

// refusal: of an empty text.
CLI::Validator not_empty(const std::string& refusal) {
  return CLI::Validator(
      [=](const std::string& text) { return text.empty() ? refusal : std::string(); }, "");
}

// CLI11 says of a wrong command that none was given, and of none not which there are.
void check_command(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  const bool option = !word.empty() && word.front() == '-';
  if (names.empty() || option || std::find(names.begin(), names.end(), word) != names.end()) return;
  throw InputError(fmt::format(
      "{}{}one of {}",
      argc > 1 ? fmt::format("'{}': no such command", word) : std::string("got no command"),
      then_expected(did_you_mean(word, names)), join(names)));
}

// "SCENE" of "--scene", where the command takes such an argument, which has no name before it.
std::string argument_of(const std::string& bare, const CLI::App& app) {
  std::string upper = bare;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto options = app.get_options();
  const bool there = std::any_of(options.begin(), options.end(), [&](const CLI::Option* option) {
    return option->get_positional() && option->get_name(true) == upper;
  });
  return there ? upper : "";
}

// "--frame-rate" of "rate": the only option of which the word is a part between dashes. Empty: none
// or several.
std::string option_with_part(const std::string& bare, const std::vector<std::string>& options) {
  std::string found;
  for (const std::string& option : options) {
    if ((option + "-").find("-" + bare + "-") == std::string::npos) continue;
    if (!found.empty()) return "";
    found = option;
  }
  return found;
}

// What "--hfus 8" or "--hfus=8" may mean where no such option is: an argument without a name, a key
// of --set, or an option that is spelt nearly so.
std::string meaning_of_option(const std::string& name, const std::string& value,
                              const CLI::App& app, const std::vector<std::string>& keys) {
  const std::string bare = name.substr(std::min(name.find_first_not_of('-'), name.size()));
  if (const std::string argument = argument_of(bare, app); !argument.empty()) {
    return fmt::format("; did you mean {} alone? {} takes no name before it",
                       value.empty() ? argument : value, argument);
  }
  std::vector<std::string> options;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& long_name : option->get_lnames()) options.push_back("--" + long_name);
  }
  std::string as_key = bare;
  std::replace(as_key.begin(), as_key.end(), '-', '_');
  const auto key = nearest_key(as_key, keys);
  const std::string whole = option_with_part(bare, options);
  const std::string option =
      whole.empty() ? did_you_mean("--" + bare, options) : fmt::format("; did you mean {}?", whole);
  if (!key || (!option.empty() && keys[*key] != as_key)) return option;
  return fmt::format("; did you mean --set {}={}?", keys[*key], value.empty() ? "VALUE" : value);
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}

// extras: those of the words that no option takes, in their order. CLI11 turns the order round, and
// takes the value of an unknown option for another argument.
std::string refusal_of(const std::vector<std::string>& extras,
                       const std::vector<std::string>& words, const CLI::App& app,
                       const std::vector<std::string>& keys) {
  const auto found = std::find_if(extras.begin(), extras.end(), is_option);
  if (found == extras.end()) {
    return fmt::format("got '{}', expected no further argument", extras.at(0));
  }
  const std::size_t equals = found->find('=');
  const std::string name = found->substr(0, equals);
  const auto word = std::find(words.begin(), words.end(), *found);
  std::string value;
  if (equals != std::string::npos) {
    value = found->substr(equals + 1);
  } else if (words.end() - word > 1 && !is_option(word[1])) {
    value = word[1];
  }
  return fmt::format("{}{}{}: no such option{}", name, value.empty() ? "" : " ", value,
                     meaning_of_option(name, value, app, keys));
}

}  // namespace

struct CommandLine::App {
  std::unique_ptr<CLI::App> own;  // the program's, null for a command
  CLI::App* app;                  // own, or one of its commands
  std::vector<std::unique_ptr<CommandLine>> commands;
  std::function<std::vector<std::string>()> keys;  // those of --set; none where it takes none

  template <class Number>
  void add_list(const char* name, std::vector<Number>& values, const Allowed<Number>& allowed,
                const char* what) {
    const auto take = [=, &values](const std::vector<std::string>& texts) {
      values = list_of(texts, name, allowed);
    };
    app->add_option_function<std::vector<std::string>>(name, take, what)
        ->type_name("NUMBER,...")
        ->allow_extra_args(false);
  }
  template <class Value>
  CLI::Option* add(const char* name, Value& value, const char* what, Given given = Given::kMaybe) {
    return app->add_option(name, value, what)->required(given == Given::kAlways);
  }
};

CommandLine::CommandLine(const std::string& program, const std::string& purpose)
    : app_(std::make_unique<App>()) {
  app_->own = std::make_unique<CLI::App>(purpose, program);
  app_->app = app_->own.get();
  app_->app->set_version_flag("--version", fmt::format("{} {}", program, version_text()));
}

CommandLine::CommandLine(std::unique_ptr<App> app) : app_(std::move(app)) {}
CommandLine::~CommandLine() = default;

CommandLine& CommandLine::command(const char* name, const char* purpose) {
  app_->app->require_subcommand(1);
  auto command = std::make_unique<App>();
  command->app = app_->app->add_subcommand(name, purpose);
  app_->commands.emplace_back(new CommandLine(std::move(command)));
  return *app_->commands.back();
}

void CommandLine::flag(const char* name, bool& value, const char* what) {
  app_->app->add_flag(name, value, what);
}

void CommandLine::text(const char* name, std::string& value, const char* what, Given given) {
  app_->add(name, value, what, given)->capture_default_str();
}

void CommandLine::file(const char* name, std::string& value, const char* what, Given given) {
  app_->add(name, value, what, given)
      ->check(not_empty("got nothing, expected a name"))
      ->default_str(std::filesystem::path(value).filename().string());
}

void CommandLine::one_of(const std::vector<std::string>& allowed, const char* name,
                         std::string& value, const char* what) {
  app_->add(name, value, what)->check(CLI::IsMember(allowed))->capture_default_str();
}

void CommandLine::whole(const char* name, std::uint64_t& value, std::uint64_t lo, std::uint64_t hi,
                        const char* what) {
  app_->add(name, value, what)->check(in_interval(lo, hi, "a whole number"))->capture_default_str();
}

void CommandLine::whole(const char* name, std::uint32_t& value, std::uint32_t lo, std::uint32_t hi,
                        const char* what) {
  app_->add(name, value, what)->check(in_interval(lo, hi, "a whole number"))->capture_default_str();
}

void CommandLine::real(const char* name, double& value, double lo, double hi, const char* what) {
  app_->add(name, value, what)->check(in_interval(lo, hi, "a number"))->capture_default_str();
}

void CommandLine::whole(const char* name, std::optional<std::uint32_t>& value, std::uint32_t lo,
                        std::uint32_t hi, const char* what) {
  app_->add(name, value, what)->check(in_interval(lo, hi, "a whole number"));
}

void CommandLine::real(const char* name, std::optional<double>& value, double lo, double hi,
                       const char* what) {
  app_->add(name, value, what)->check(in_interval(lo, hi, "a number"));
}

void CommandLine::reals_or_0(const char* name, std::vector<double>& values, double lo, double hi,
                             const char* what) {
  const Allowed<double> allowed{
      [=](double value) { return value == 0 || (value >= lo && value <= hi); },
      fmt::format("a number from {} to {}, or 0", lo, hi)};
  app_->add_list(name, values, allowed, what);
}

// An option that may be repeated takes one value each time: what follows is another argument.
void CommandLine::texts(const char* name, std::vector<std::string>& values, const char* what) {
  app_->add(name, values, what)->allow_extra_args(false);
}

void CommandLine::list(const char* name, std::vector<std::string>& values, const char* what) {
  app_->add(name, values, what);
}

void CommandLine::numbers(const char* name, std::vector<int>& values, const char* what) {
  constexpr int kMost = std::numeric_limits<int>::max();
  const Allowed<int> allowed{[](int value) { return value >= 0; },
                             fmt::format("a whole number from 0 to {}", kMost)};
  app_->add_list(name, values, allowed, what);
}

void CommandLine::needs(const char* name, const char* other) {
  app_->app->get_option(name)->needs(app_->app->get_option(other));
}

void CommandLine::excludes(const char* name, const char* other) {
  app_->app->get_option(name)->excludes(app_->app->get_option(other));
}

void CommandLine::refuses_empty(const char* name, const char* expected) {
  app_->app->get_option(name)->check(not_empty(fmt::format("got '', expected {}", expected)));
}

void CommandLine::set_keys(const std::function<std::vector<std::string>()>& keys) {
  app_->keys = keys;
}

void CommandLine::end_help_with(const std::string& text) { app_->app->footer(text); }

bool CommandLine::parse(int argc, const char* const* argv) {
  CLI::App& app = *app_->app;
  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    app.exit(asked_for_help);
    return false;
  } catch (const CLI::ParseError& error) {
    const App* asked = app_.get();
    std::string name = app.get_name(), what = error.what();
    for (const std::unique_ptr<CommandLine>& command : app_->commands) {
      if (!command->chosen()) continue;
      asked = command->app_.get();
      name += " " + command->name();
    }
    // What is missing may stand behind an option that is not there: --scene=x.ply.
    const std::vector<std::string> extras = app.remaining(true);
    const bool missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
                         std::any_of(extras.begin(), extras.end(), is_option);
    if (missing || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
      const bool sets = asked->keys && asked->app->get_option_no_throw("--set") != nullptr;
      what = refusal_of(extras, {argv, argv + argc}, *asked->app,
                        sets ? asked->keys() : std::vector<std::string>());
    }
    throw InputError(fmt::format("{} ({} --help lists what there is)", what, name));
  }
  return true;
}

std::string CommandLine::name() const { return app_->app->get_name(); }

bool CommandLine::chosen() const { return app_->app->parsed(); }

}  // namespace sgs
