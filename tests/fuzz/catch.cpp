// What tests/comparison needs of Catch2, without its main().

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
