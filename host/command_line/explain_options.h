#pragma once
// What `pmdsim explain` is asked about.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pmdsim {

struct ExplainRequest {
  std::vector<std::string> words; // none: everything, a line each
  bool markdown = false;          // everything, as docs/reference.md
};

void add_explain(CLI::App &command, ExplainRequest &request);

} // namespace pmdsim
