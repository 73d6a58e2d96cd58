#pragma once
// What people typically get wrong, and what the program has to answer: the tables of docs/mistakes.md.

#include <string>
#include <utility>
#include <vector>

namespace pmdsim::test {

// One row of a table. The program runs in a folder with good_setup() as setup.json, and the files beside it
// that good_setup() and some of the rows name; a row's own files take their places.
struct Mistake {
  std::string written;                                      // what somebody typed or wrote, for the page
  std::vector<std::string> arguments;                       // of the program
  std::vector<std::pair<std::string, std::string>> files{}; // name and text
  int exit_code = 3;
  std::vector<std::string> told{}; // parts of the answer: file, place, what was expected
  std::string remedy{};            // what to do, for the page
};

struct Mistakes {
  std::string title; // of the page's section
  std::vector<Mistake> rows;
};

// A setup that works, line by line as it is written by hand.
std::string good_setup();

Mistakes key_mistakes();
Mistakes value_mistakes();
Mistakes reference_mistakes();
Mistakes text_mistakes();
Mistakes file_mistakes();
Mistakes table_mistakes();
Mistakes command_mistakes();
Mistakes option_mistakes();

} // namespace pmdsim::test
