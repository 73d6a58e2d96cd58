#pragma once
// The line that an input error leaves on stderr.

#include "engine/model/error.h"

#include <catch2/catch.hpp>
#include <string>

namespace pmdsim::test {

// The message of what `action` throws, an Error with ExitCode::input in one line of bearable length.
template <class Action>
std::string input_error_of(Action action) {
  try {
    action();
  } catch (const Error &error) {
    const std::string message = error.what();
    CHECK(error.code() == ExitCode::input);
    CHECK(message.find('\n') == message.npos);
    CHECK(message.size() < 600);
    return message;
  }
  FAIL_CHECK("nothing was thrown");
  return {};
}

} // namespace pmdsim::test
