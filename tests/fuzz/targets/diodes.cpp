// Tables of diodes, beside small files of diagrams that they may name.

#include "tests/fuzz/target.h"

#include "host/input/diagram/diode_file.h"
#include "tests/fuzz/small_files.h"

using namespace pmdsim;

FUZZ_TARGET(diodes) {
  static const std::filesystem::path folder = fuzz::write_small_files();
  const std::filesystem::path file = fuzz::write_file("table.csv", fuzz::text_of(data, size));
  fuzz::accepts([&] {
    DiagramFiles diagrams;
    read_diode_file(file, Place{folder / "setup.json"} / "illuminators", diagrams);
    for (const Warning &warning : diagrams.warnings())
      fuzz::check_line(warning.text);
  });
  return 0;
}
