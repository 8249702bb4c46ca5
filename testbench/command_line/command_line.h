// The options and arguments that a program takes from its command line. CLI11 stands behind it,
// seen in one file alone: it costs each file that includes it seconds to compile.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sgs {

constexpr std::uint64_t kMostSeed = INT64_MAX;

enum class Given { kMaybe, kAlways };

// Options, positional arguments (names without dashes) and commands. A value keeps what it holds
// where it is not given; it must outlive parse(). Values that do not fit are InputErrors of
// parse().
class CommandLine {
 public:
  CommandLine(const std::string& program, const std::string& purpose);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  // A command of the program, one of which must be given. Lives as long as the program's own.
  CommandLine& command(const char* name, const char* purpose);

  void flag(const char* name, bool& value, const char* what);
  void text(const char* name, std::string& value, const char* what, Given given = Given::kMaybe);
  // A text that is not empty: an option that was given must not count as left out. Help shows what
  // it holds without its folders.
  void file(const char* name, std::string& value, const char* what, Given given = Given::kMaybe);
  void one_of(const std::vector<std::string>& allowed, const char* name, std::string& value,
              const char* what);
  // Decimal digits only, in [lo, hi].
  void whole(const char* name, std::uint64_t& value, std::uint64_t lo, std::uint64_t hi,
             const char* what);
  void whole(const char* name, std::uint32_t& value, std::uint32_t lo, std::uint32_t hi,
             const char* what);
  // A finite number in [lo, hi].
  void real(const char* name, double& value, double lo, double hi, const char* what);
  // Where none is given, the command itself decides.
  void whole(const char* name, std::optional<std::uint32_t>& value, std::uint32_t lo,
             std::uint32_t hi, const char* what);
  void real(const char* name, std::optional<double>& value, double lo, double hi, const char* what);
  // Different numbers with commas between them, each 0 or finite in [lo, hi].
  void reals_or_0(const char* name, std::vector<double>& values, double lo, double hi,
                  const char* what);
  // May be repeated, one text each.
  void texts(const char* name, std::vector<std::string>& values, const char* what);
  // Positional, any number of them.
  void list(const char* name, std::vector<std::string>& values, const char* what);
  // Different whole numbers, at least 0, with commas between them.
  void numbers(const char* name, std::vector<int>& values, const char* what);

  // One option of this command is refused without another.
  void needs(const char* name, const char* other);
  // Or beside another.
  void excludes(const char* name, const char* other);
  // Or where its text is empty: an option that was given must not count as left out.
  void refuses_empty(const char* name, const char* expected);

  // keys: makes the keys that --set of this command takes. Whoever writes one as an option is told.
  void set_keys(const std::function<std::vector<std::string>()>& keys);
  // Help ends with this text.
  void end_help_with(const std::string& text);

  // True if anything is left to do: --help and --version are answered here. Throws InputError.
  bool parse(int argc, const char* const* argv);
  std::string name() const;
  bool chosen() const;  // after parse(): whether this command was given

 private:
  struct App;
  explicit CommandLine(std::unique_ptr<App> app);
  std::unique_ptr<App> app_;
};

}  // namespace sgs
