// Files of variants: a line of changes each, made to a small setup.

#include "tests/fuzz/target.h"

#include "host/capture/variants.h"
#include "tests/fuzz/small_files.h"

using namespace pmdsim;

FUZZ_TARGET(variants) {
  static const SetupDocument setup = read_setup_document(fuzz::write_small_files() / "setup.json");
  const std::filesystem::path file = fuzz::write_file("variants.jsonl", fuzz::text_of(data, size));
  fuzz::accepts([&] { variants_of({setup}, file); });
  return 0;
}
