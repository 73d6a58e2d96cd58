#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace pmdsim {
namespace {

// A path as a shell takes it.
std::string for_shell(const std::string &path) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 ||
           std::string_view("/._-+,:=@").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (std::ranges::all_of(path, is_plain) && !path.starts_with('-'))
    return path;
  std::string quoted = path.starts_with('-') ? "'./" : "'";
  for (const char c : path)
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

struct NextStep {
  std::string command, about;
};

std::vector<NextStep> next_steps(const NewSetup &made, const NewFiles &files) {
  const std::string setup = for_shell(files.setup.string());
  const std::string out = for_shell((files.setup.parent_path() / "out").string());
  std::vector<NextStep> steps{
      {"pmdsim check " + setup, "is it valid, and what follows from it"},
      {fmt::format("pmdsim render {} -o {}", setup, out),
       fmt::format("measure it; then look at the pictures of {}", made.kind->look_at)}};
  if (made.kind->deforms)
    steps.push_back({fmt::format("pmdsim deform {} -o {}", setup,
                                 for_shell((files.setup.parent_path() / "deform").string())),
                     "what the light's place beside the lens adds to the distances"});
  return steps;
}

nlohmann::ordered_json new_json(const NewSetup &made, const NewFiles &files) {
  return {{"kind", made.kind->name},
          {"setup", files.setup.string()},
          {"scene", files.scene.string()},
          {"outputs", files.all},
          {"next", array_of(next_steps(made, files), [](const NextStep &step) { return step.command; })}};
}

std::string new_text(const NewSetup &made, const NewFiles &files) {
  std::string text = fmt::format("{}: {}\n", made.folder.string(), made.kind->about);
  for (const std::string &file : files.all)
    text += fmt::format("  {}\n", file);
  text += "\nNext:\n";
  for (const auto &[command, about] : next_steps(made, files))
    text += fmt::format("  {}\n      {}\n", command, about);
  return text +
         fmt::format("  pmdsim explain modulation_hz\n      what a key of {} means\n", files.setup.string());
}

} // namespace

void run_new(const Options &options) {
  const NewFiles files = write_new_setup(*options.fresh);
  print(options.json ? json_text(new_json(*options.fresh, files)) : new_text(*options.fresh, files));
}

} // namespace pmdsim
