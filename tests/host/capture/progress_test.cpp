#include "host/capture/progress.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

TEST_CASE("the bar shows the share that is done and the time that is left") {
  CHECK(progress_text(0.0, 7.0) == "[--------------------] 0 %");
  CHECK(progress_text(0.15, 7.4) == "[###-----------------] 15 %, 42 s left");
  CHECK(progress_text(0.5, 600.0) == "[##########----------] 50 %, 10 min left");
  CHECK(progress_text(0.01, 100.0) == "[--------------------] 1 %, 2.8 h left");
  CHECK(progress_text(1.0, 100.0) == "[####################] 100 %, 0 s left");
}

TEST_CASE("in a log the same is a line") {
  CHECK(progress_line("frame 3/20, pmd", 0.15, 7.4) == "pmdsim: frame 3/20, pmd: 15 %, 42 s left\n");
  CHECK(progress_line("measuring pmd", 0.0, 60.0) == "pmdsim: measuring pmd: 0 %\n");
  CHECK(progress_line("warming up", 1.1, 7200.0) == "pmdsim: warming up: 100 %, 0 s left\n");
}
