#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

// libsystemc refers to sc_main even where Catch's main runs the tests.
extern "C" int sc_main(int, char*[]) { return 0; }
