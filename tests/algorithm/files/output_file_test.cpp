// Output files, plans and sets of them; input files.
#include "algorithm/files/output_file.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <functional>
#include <thread>
#include <vector>

#include "algorithm/files/input_file.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

// While it lives, no file grows beyond `bytes`: as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

}  // namespace

TEST_CASE("output file: appears on commit, and not before") {
  const test::ScratchFolder scratch;
  scratch.write("a.txt", "old");
  {
    OutputFile output(scratch.path("a.txt"));
    CHECK(output.path() == scratch.path("a.txt"));
    output.write("new");
    output.finish();
    CHECK(test::bytes_of(scratch.path("a.txt")) == "old");
    CHECK(test::bytes_of(output.temporary_path()) == "new");
    output.commit();
  }
  CHECK(test::bytes_of(scratch.path("a.txt")) == "new");
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("output file: without commit nothing is left") {
  const test::ScratchFolder scratch;
  {
    OutputFile output(scratch.path("a.txt"));
    output.write("new");
    CHECK(scratch.file_count() == 1);
  }
  CHECK(scratch.file_count() == 0);
}

TEST_CASE("output file: two writers of one name do not meet") {
  const test::ScratchFolder scratch;
  const std::string path = scratch.path(std::string(250, 'a'));  // leaves no room for a suffix
  OutputFile first(path), second(path);
  CHECK(first.temporary_path() != second.temporary_path());
  for (int i = 0; i < 1000; ++i) {
    first.write("first ");
    second.write("second");
  }
  second.commit();
  first.commit();
  const std::string bytes = test::bytes_of(path);
  CHECK(bytes.size() == 6000);
  CHECK(bytes.find("second") == std::string::npos);
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("output file: a full disk is an error that leaves nothing") {
  const test::ScratchFolder scratch;
  scratch.write("a.txt", "old");
  const std::string large(100000, 'x');
  const auto in_parts = [&](OutputFile& output) {
    for (int i = 0; i < 100; ++i) output.write(large.data(), 1000);
  };
  const auto at_once = [&](OutputFile& output) { output.write(large); };
  // Less than a buffer: shows only when it is flushed.
  const auto little = [&](OutputFile& output) { output.write(large.data(), 1500); };
  for (const std::function<void(OutputFile&)>& write :
       std::vector<std::function<void(OutputFile&)>>{in_parts, at_once, little}) {
    const FullDisk disk(1000);
    OutputFile output(scratch.path("a.txt"));
    write(output);
    CHECK_THROWS_WITH(output.commit(), Contains("a.txt: cannot be written completely (File too"));
    CHECK_THROWS_AS(output.commit(), std::runtime_error);
  }
  CHECK(test::bytes_of(scratch.path("a.txt")) == "old");
  CHECK(scratch.file_count() == 1);
  {
    const FullDisk disk(1000);
    OutputSet set;
    set.add(scratch.path("a.txt")).write("small");
    set.add(scratch.path("folder/b.txt")).write("small");
    set.add(scratch.path("folder/c.txt")).write(large);
    CHECK_THROWS_AS(set.commit(), std::runtime_error);
  }
  CHECK(test::bytes_of(scratch.path("a.txt")) == "old");
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("output file: a child process may write it, its end removes nothing") {
  const test::ScratchFolder scratch;
  OutputFile output(scratch.path("a.txt"));
  const auto in_child = [](const std::function<void()>& body) {
    const pid_t child = ::fork();
    if (child == 0) {
      body();
      ::_exit(0);
    }
    ::waitpid(child, nullptr, 0);
  };
  in_child([&] {
    output.write("from the child");
    output.finish();
  });
  in_child([&] { output.~OutputFile(); });
  output.commit();
  CHECK(test::bytes_of(scratch.path("a.txt")) == "from the child");
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("output file: folders are made, and removed again without commit") {
  const test::ScratchFolder scratch;
  { const OutputFile output(scratch.path("x/y/a.txt")); }
  CHECK(scratch.file_count() == 0);
  {
    OutputFile kept(scratch.path("x/y/a.txt"));
    const OutputFile dropped(scratch.path("x/z/a.txt"));
    kept.commit();
  }
  CHECK(std::filesystem::exists(scratch.path("x/y/a.txt")));
  CHECK_FALSE(std::filesystem::exists(scratch.path("x/z")));
}

TEST_CASE("output file: folders that another writer makes and takes away do not matter") {
  const test::ScratchFolder scratch;
  std::atomic<bool> done{false};
  std::thread other([&] {
    while (!done) OutputFile(scratch.path("common/theirs/out.bin"));
  });
  std::size_t written = 0;
  for (int i = 0; i < 2000; ++i) {
    OutputFile file(scratch.path("common/ours/out.bin"));
    file.write("x", 1);
    written += i % 2;
    if (i % 2 == 1) {
      file.commit();
      std::filesystem::remove_all(scratch.path("common/ours"));
    }
  }
  done = true;
  other.join();
  CHECK(written == 1000);
}

TEST_CASE("output file: places that cannot be files are refused, and left as they are") {
  const test::ScratchFolder scratch;
  scratch.write("file", "kept");
  scratch.write("locked", "kept");
  REQUIRE(::mkfifo(scratch.path("pipe").c_str(), 0600) == 0);
  REQUIRE(::mkdir(scratch.path("closed").c_str(), 0500) == 0);
  REQUIRE(::chmod(scratch.path("locked").c_str(), 0400) == 0);
  std::filesystem::create_symlink("/dev/full", scratch.path("to_device"));
  std::filesystem::create_symlink("loop", scratch.path("loop"));
  struct Row {
    std::string path, message;
    bool for_root = true;  // who may write everywhere
  };
  const std::size_t files = scratch.file_count();
  for (const Row& row :
       std::vector<Row>{{"", "not a file name"},
                        {scratch.path(""), "not a file name"},
                        {scratch.path("."), "a folder"},
                        {scratch.path("closed"), "a folder"},
                        {scratch.path("pipe"), "a device or a pipe"},
                        {"/dev/null", "a device or a pipe"},
                        {scratch.path("to_device"), "a device or a pipe"},
                        {scratch.path("loop"), "symbolic links"},
                        {scratch.path("file/a"), "Not a directory"},
                        {scratch.path("file/x/a"), "Not a directory"},
                        {scratch.path(std::string(300, 'a')), "File name too long"},
                        {scratch.path("none/" + std::string(300, 'a')), "File name too long"},
                        {"/proc/none", "/proc/none"},
                        {scratch.path("locked"), "Permission denied", false},
                        {scratch.path("closed/a"), "Permission denied", false},
                        {scratch.path("closed/x/a"), "Permission denied", false}}) {
    if (!row.for_root && ::geteuid() == 0) continue;
    INFO(row.path);
    CHECK_THAT(test::input_error_of([&] { OutputFile output(row.path); }), Contains(row.message));
    CHECK_THAT(test::input_error_of([&] { OutputFile output(row.path); }), Contains("expected"));
  }
  CHECK(scratch.file_count() == files);
  CHECK(test::bytes_of(scratch.path("file")) == "kept");
}

TEST_CASE("output plan: an output is no input and no other output, whatever it is called") {
  const test::ScratchFolder scratch;
  scratch.write("in", "kept");
  scratch.write("other", "");
  std::filesystem::create_symlink("in", scratch.path("link"));
  std::filesystem::create_hard_link(scratch.path("in"), scratch.path("second_name"));
  const auto plan_of = [&](const std::vector<std::string>& outputs) {
    OutputPlan plan;
    for (const char* input : {"in", "missing"}) plan.add_input(scratch.path(input));
    plan.add_input("");
    plan.add_input("builtin:object");
    for (const std::string& output : outputs) plan.add_output(scratch.path(output));
    return plan;
  };
  for (const char* name : {"in", "./in", "link", "second_name", "new/../in"}) {
    INFO(name);
    CHECK_THAT(test::input_error_of([&] { plan_of({name}).check(); }),
               Contains("is the same file as the input " + scratch.path("in")));
  }
  for (const char* name : {"a", "./a", "new/../a"}) {
    CHECK_THAT(test::input_error_of([&] {
                 plan_of({"a", name}).check();
               }),
               Contains("is the same file as the output " + scratch.path("a")));
  }
  for (const auto& [first, second] :
       {std::pair("a", "a/b"), {"a/b/c", "a"}, {"./a", "new/../a/b"}}) {
    INFO(first << " " << second);
    const std::vector<std::string> paths{first, second};
    CHECK_THAT(test::input_error_of([&] { plan_of(paths).check(); }),
               Contains("lies below " + scratch.path("")) && Contains("expected a folder"));
  }
  test::input_error_of([&] { plan_of({"a", "."}).check(); });
  OutputPlan relative;
  relative.add_output("none_of_this_name");
  relative.add_output("./none_of_this_name");
  test::input_error_of([&] { relative.check(); });
  plan_of({"a", "ab/c", "b", "other", "new/a", "missing"}).check();
  CHECK(scratch.file_count() == 4);
}

TEST_CASE("input file: reads ranges, refuses what lies beyond the end") {
  const test::ScratchFolder scratch;
  const InputFile file(scratch.write("a", "0123456789"));
  CHECK(file.size_bytes() == 10);
  char two[2];
  file.read_at(4, two, 2);
  CHECK(std::string(two, 2) == "45");
  CHECK(file.text_from(7, 100) == "789");
  CHECK(file.text_from(7, 2) == "78");
  CHECK(file.text_from(10, 5).empty());
  CHECK(file.text_from(99, 5).empty());
  CHECK_THAT(test::input_error_of([&] { file.read_at(9, two, 2); }),
             Contains("byte 10: the file ends, expected 1 more bytes"));
}
