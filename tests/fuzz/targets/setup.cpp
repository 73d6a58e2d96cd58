// A setup's text beside small files that it may name, loaded with its scene and without, at several times.
// Behind a line of four dashes stand changes to it, as --set and a file of variants make them. What does not
// look like JSON is read as a file, which may be of another kind.

#include "tests/fuzz/target.h"

#include "host/input/file/json_file.h"
#include "host/input/setup/setup.h"
#include "tests/fuzz/small_files.h"

using namespace pmdsim;

namespace {

constexpr std::string_view before_changes = "\n----\n";

void load(const SetupDocument &document) {
  const Setup setup = SetupLoader().load(document);
  static_cast<void>(setup.as_used.dump());
  for (const double time_s : {-1.0, 0.0, 0.37, 1e6})
    fuzz::accepts([&] { setup.at(time_s); });
  for (const Warning &warning : setup.warnings) {
    fuzz::check_line(warning.text);
    fuzz::check_line(warning.place);
  }
}

} // namespace

FUZZ_TARGET(setup) {
  static const std::filesystem::path file = fuzz::write_small_files() / "setup.json";
  const std::string_view text = fuzz::text_of(data, size);
  if (!text.starts_with('{') && !text.starts_with('/')) { // nor a comment
    fuzz::accepts([&] { read_setup_document(fuzz::write_file("other.csv", text)); });
    return 0;
  }
  const std::size_t end = std::min(text.find(before_changes), text.size());
  fuzz::accepts([&] {
    SetupDocument document = parse_setup_document(text.substr(0, end), file);
    if (end < text.size())
      fuzz::accepts([&] {
        change(document, parse_json(text.substr(end + before_changes.size()), "--set", Comments::refused),
               "--set");
      });
    fuzz::accepts([&] { SetupLoader::load_without_scene(document); });
    load(document);
  });
  return 0;
}
