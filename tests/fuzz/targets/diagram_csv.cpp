// Radiation diagrams as CSV.

#include "tests/fuzz/target.h"

#include "host/input/diagram/diagram_table.h"

using namespace pmdsim;

FUZZ_TARGET(diagram_csv) {
  const std::string text(fuzz::text_of(data, size));
  if (text.find('\0') != std::string::npos)
    return 0; // the reader of text files refuses it
  fuzz::accepts([&] {
    std::vector<Warning> warnings;
    diagram_of(read_diagram_csv("led.csv", text), warnings);
  });
  return 0;
}
