// Options as CLI11 knows them.
#include "testbench/command_line/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

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

CLI::Validator not_empty() {
  return CLI::Validator(
      [](const std::string& text) {
        return text.empty() ? std::string("got nothing, expected a name") : std::string();
      },
      "");
}

// CLI11 says of a wrong command that none was given, and of none not which there are.
void check_command(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  const bool option = !word.empty() && word.front() == '-';
  if (names.empty() || option || std::find(names.begin(), names.end(), word) != names.end()) return;
  throw InputError(fmt::format(
      "{}, expected one of {}",
      argc > 1 ? fmt::format("'{}': no such command", word) : std::string("got no command"),
      join(names)));
}

}  // namespace

struct CommandLine::App {
  std::unique_ptr<CLI::App> own;  // the program's, null for a command
  CLI::App* app;                  // own, or one of its commands
  std::vector<std::unique_ptr<CommandLine>> commands;

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
  app_->add(name, value, what, given)->check(not_empty())->capture_default_str();
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

// An option that may be repeated takes one value each time: what follows is another argument.
void CommandLine::texts(const char* name, std::vector<std::string>& values, const char* what) {
  app_->add(name, values, what)->allow_extra_args(false);
}

void CommandLine::list(const char* name, std::vector<std::string>& values, const char* what) {
  app_->add(name, values, what);
}

void CommandLine::numbers(const char* name, std::vector<int>& values, const char* what) {
  app_->add(name, values, what)->delimiter(',')->allow_extra_args(false);
}

void CommandLine::needs(const char* name, const char* other) {
  app_->app->get_option(name)->needs(app_->app->get_option(other));
}

bool CommandLine::parse(int argc, const char* const* argv) {
  CLI::App& app = *app_->app;
  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    app.exit(asked_for_help);
    return false;
  } catch (const CLI::ParseError& error) {
    std::string asked = app.get_name();
    for (const CLI::App* command : app.get_subcommands()) asked += " " + command->get_name();
    throw InputError(fmt::format("{} ({} --help lists what there is)", error.what(), asked));
  }
  return true;
}

std::string CommandLine::name() const { return app_->app->get_name(); }

bool CommandLine::chosen() const { return app_->app->parsed(); }

}  // namespace sgs
