// JSON text as setups, scenes and options have it, and as the files of a run's folder have it.

#include "tests/fuzz/target.h"

#include "host/input/file/json_file.h"
#include "host/output/run/run_json.h"

#include <cstdlib>

using namespace pmdsim;

FUZZ_TARGET(json) {
  const std::string_view text = fuzz::text_of(data, size);
  nlohmann::json json;
  const auto parsed = [&](Comments comments) {
    return fuzz::accepts([&] { json = parse_json(text, "file.json", comments); });
  };
  const bool with_comments = parsed(Comments::allowed);
  const bool without = parsed(Comments::refused);
  if (without && !with_comments)
    std::abort(); // comments are the only difference
  if (without) {
    const std::string written = json.dump();
    if (parse_json(written, "file.json", Comments::refused) != json)
      std::abort(); // what it wrote means another thing
  }
  fuzz::accepts([&] {
    if (const auto in_order = parsed_in_order(std::string(text), "document.json"))
      static_cast<void>(in_order->dump());
  });
  return 0;
}
