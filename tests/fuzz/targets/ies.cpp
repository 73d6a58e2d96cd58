// Radiation diagrams as IES LM-63.

#include "tests/fuzz/target.h"

#include "host/input/diagram/diagram_table.h"

using namespace pmdsim;

FUZZ_TARGET(ies) {
  const std::string text(fuzz::text_of(data, size));
  if (text.find('\0') != std::string::npos)
    return 0; // the reader of text files refuses it
  fuzz::accepts([&] {
    std::vector<Warning> warnings;
    diagram_of(read_ies("led.ies", text), warnings);
  });
  return 0;
}
