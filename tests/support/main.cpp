// The main function of the tests for version 2 of Catch2, apart from them since it is slow to compile.

#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
