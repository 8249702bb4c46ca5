// output_file.h and input_file.h.
#include "algorithm/output_file.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "algorithm/input_file.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

TEST_CASE("output file: appears on commit, and not before") {
  const test::ScratchFolder scratch;
  scratch.write("a.txt", "old");
  {
    OutputFile output(scratch.path("a.txt"));
    CHECK(output.path() == scratch.path("a.txt"));
    std::ofstream(output.temporary_path()) << "new";
    CHECK(test::bytes_of(scratch.path("a.txt")) == "old");
    output.commit();
  }
  CHECK(test::bytes_of(scratch.path("a.txt")) == "new");
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("output file: without commit nothing is left") {
  const test::ScratchFolder scratch;
  {
    OutputFile output(scratch.path("a.txt"));
    std::ofstream(output.temporary_path()) << "new";
    CHECK(scratch.file_count() == 1);
  }
  CHECK(scratch.file_count() == 0);
}

TEST_CASE("output file: two writers of one name do not meet") {
  const test::ScratchFolder scratch;
  OutputFile first(scratch.path("a.txt")), second(scratch.path("a.txt"));
  CHECK(first.temporary_path() != second.temporary_path());
  CHECK_THROWS_AS(first.commit(), std::runtime_error);  // nothing was written
}

TEST_CASE("output file: names that cannot be files") {
  const test::ScratchFolder scratch;
  test::input_error_of([] { OutputFile output(""); });
  test::input_error_of([&] { OutputFile output(scratch.path("")); });
  CHECK_THAT(test::input_error_of([&] { write_whole_file(scratch.path("x/a"), "b", 1); }),
             Contains("expected an existing folder"));
  // A file in the place of a folder.
  scratch.write("f", "");
  test::input_error_of([&] { write_whole_file(scratch.path("f/a"), "b", 1); });
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
