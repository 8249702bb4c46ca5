// An installed prefix stands on its own: moved away, its programs read its files and no others.
#include <catch2/catch.hpp>
#include <string>

#include "tests/system/shell.h"

namespace sgs::test {
namespace {

// Of a shell line that may use $P, a prefix that was moved after it was installed.
class Prefix {
 public:
  Prefix() {
    const ShellOutcome made =
        run(SGS_CMAKE " --install '" SGS_BINARY_DIR "' --prefix first >log && mv first moved");
    INFO(made.out << made.err);
    REQUIRE(made.status == 0);
  }
  ShellOutcome run(const std::string& line) const {
    return shell(scratch_,
                 "P=./moved; IN=$P/" SGS_BIN_FOLDER "; DATA=$P/" SGS_DATA_FOLDER "\n" + line);
  }

 private:
  ScratchFolder scratch_;
};

void contains(const ShellOutcome& outcome, int status, const std::string& word) {
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == status);
  CHECK((status == 0 ? outcome.out : outcome.err).find(word) != std::string::npos);
}

TEST_CASE("install: a moved prefix simulates with a preset and a memspec of its own") {
  const Prefix prefix;
  contains(prefix.run("$IN/streaminggs --version"), 0, "streaminggs 0.");
  contains(prefix.run("$IN/streaminggs simulate --help"), 0, "exact_vq_packed");
  contains(prefix.run("$IN/streaminggs simulate $B --config exact_half --set "
                      "dram.memspec=lpddr4_3200_8gb --out o && ls o/view_0"),
           0, "frame.png");
  contains(prefix.run("grep memspec o/report.json"), 0, "lpddr4_3200_8gb");
  contains(prefix.run("$IN/tb_dram --transactions 20"), 0, "PASS");
}

TEST_CASE("install: the prefix's files are the ones that are read") {
  const Prefix prefix;
  contains(prefix.run("echo '{\"machine\": \"paper\", \"group_width_px\": 16, \"group_height_px\": "
                      "16}' >$DATA/presets/mine.json && "
                      "$IN/streaminggs simulate $B --config mine --print-config"),
           0, "\"group_width_px\": 16");
  contains(prefix.run("echo '{\"base\": \"paper_no_vq\"}' >$DATA/presets/paper.json; "
                      "$IN/streaminggs simulate $B --config paper_no_cgf"),
           2, "preset paper_no_vq: base: got paper, expected a preset without it as its base");
  contains(prefix.run("rm $DATA/presets/paper.json; $IN/streaminggs simulate $B --config paper"), 2,
           "mine");
  contains(prefix.run("echo '{' >$DATA/published.json; $IN/tb_dram --table"), 2,
           "moved/" SGS_DATA_FOLDER "/published.json");
  contains(prefix.run("echo '{' >$DATA/memspecs/lpddr3_1600_4gb.json; $IN/tb_dram"), 2,
           "moved/" SGS_DATA_FOLDER "/memspecs/lpddr3_1600_4gb.json");
  contains(prefix.run("echo '{' >$DATA/technology_32nm.json; $IN/streaminggs simulate $B --set "
                      "dram.memspec=lpddr4_3200_8gb --out p"),
           2, "moved/" SGS_DATA_FOLDER "/technology_32nm.json");
}

TEST_CASE("install: programs without their files say so") {
  const Prefix prefix;
  for (const char* line : {"$IN/streaminggs simulate $B --out o", "$IN/tb_dram"}) {
    INFO(line);
    const ShellOutcome outcome = prefix.run(std::string("rm -rf $DATA; ") + line);
    contains(outcome, 2, "moved/" SGS_DATA_FOLDER ": not there, expected");
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
  }
}

TEST_CASE("install: a command whose program was not built is refused with what builds it") {
  const Prefix prefix;
  contains(prefix.run("$IN/streaminggs info $S"), 0, "median opacity");
  const ShellOutcome outcome = prefix.run("rm $IN/streaminggs-commands; $IN/streaminggs info $S");
  contains(outcome, 2, "scripts/setup.sh release streaminggs-commands");
  CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
  contains(prefix.run("$IN/streaminggs --help"), 0, "print what a scene holds");
}

TEST_CASE("install: no program names the data of the source tree") {
  const Prefix prefix;
  for (const char* place : {"testbench/configs", "testbench/cost/technology_32nm",
                            "modules/dram/memspecs", "testbench/dram/published.json"}) {
    for (const char* program : {"$IN/streaminggs", "$IN/streaminggs-commands", "$IN/tb_dram"}) {
      INFO(place << " in " << program);
      const std::string line = std::string("grep -c '" SGS_SOURCE_DIR "/") + place + "' " + program;
      CHECK(prefix.run(line).out == "0\n");
    }
  }
}

TEST_CASE("install: another project draws a frame on its own bus, over the prefix's package") {
  const Prefix prefix;
  contains(
      prefix.run("cp -r '" SGS_SOURCE_DIR "/testbench/embed' . && cd embed && " SGS_CMAKE
                 " -B b -DCMAKE_PREFIX_PATH=$PWD/../moved && " SGS_CMAKE " --build b && b/embed"),
      0, "frame equal to the golden picture");
  contains(prefix.run("rm $P/" SGS_LIB_FOLDER "/streaminggs/libsgs_merge.a; " SGS_CMAKE
                      " -S embed -B c -DCMAKE_PREFIX_PATH=$PWD/moved"),
           1, "libsgs_merge.a");
}

TEST_CASE("install: another project has the libraries as a folder of its own", "[nightly]") {
  ScratchFolder scratch;
  scratch.write("CMakeLists.txt",
                "cmake_minimum_required(VERSION 3.25)\nproject(over LANGUAGES CXX)\n"
                "add_subdirectory(" SGS_SOURCE_DIR
                " streaminggs)\nadd_executable(over over.cpp)\n"
                "target_link_libraries(over PRIVATE streaminggs::tlm)\n");
  scratch.write("over.cpp",
                "#include \"tlm/time_resolution.h\"\n"
                "int sc_main(int, char**) { sgs::use_femtosecond_resolution(); return 0; }\n");
  contains(shell(scratch, SGS_CMAKE " -B b && " SGS_CMAKE " --build b --target over && b/over && "
                                    "echo done"),
           0, "done");
}

}  // namespace
}  // namespace sgs::test
