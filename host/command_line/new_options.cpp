#include "host/command_line/new_options.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

namespace pmdsim {
namespace {

// Whoever asks for a target without a name gets the one with most to see.
constexpr std::string_view any_target = "target", first_target = "star";

std::vector<std::string> setup_kind_names() {
  std::vector<std::string> names;
  for (const StartKind &kind : start_kinds())
    names.emplace_back(kind.name);
  names.emplace_back(any_target);
  return names;
}

// "2, of a ring 1": the defaults of the kinds that have the size, where they differ.
template <class Number>
std::string defaults_text(Number StartSizes::*size) {
  std::vector<std::string> texts;
  for (const StartKind &kind : start_kinds())
    if (kind.defaults.*size != Number{})
      texts.push_back(fmt::format("{} {}", kind.name, kind.defaults.*size));
  return fmt::format("{}", fmt::join(texts, ", "));
}

// The table of kinds below the options.
std::string kind_list() {
  std::string text = "Kinds:\n";
  for (const StartKind &kind : start_kinds())
    text += fmt::format("  {:<14}{}\n", kind.name, kind.about);
  return text +
         fmt::format("  {:<14}the {}; others are the wall, the step and so on\n", any_target, first_target);
}

} // namespace

void add_new(CLI::App &command, WrittenNew &written) {
  command.add_option("KIND", written.kind, "what is seen, see below [room]")
      ->type_name(fmt::format("TEXT:{{{}}}", fmt::join(setup_kind_names(), ",")));
  command.add_option("DIR", written.folder, "the new folder [KIND]");
  command.add_option("--distance-m", written.wishes.distance_m,
                     "from the lens to a target, of a ball to its centre, metres, 0.1 to 100 [2]");
  command.add_option("--size-m", written.wishes.size_m,
                     fmt::format("a target's width and height, metres, 0.01 to 1000 [of the distance: {}]",
                                 defaults_text(&StartSizes::size_m)));
  command.add_option("--depth-m", written.wishes.depth_m,
                     fmt::format("how much farther one half of a step is, metres, 0.0001 to 100 [{}]",
                                 find_start_kind("step")->defaults.depth_m));
  command.add_option(
      "--spokes", written.wishes.spokes,
      fmt::format("dark spokes of a star, 2 to 1000 [{}]", find_start_kind("star")->defaults.spokes));
  command.add_option("--squares", written.wishes.squares,
                     fmt::format("squares in a row of a checkerboard, 3 to 200 [{}]",
                                 find_start_kind("checkerboard")->defaults.squares));
  command.add_flag("--force", written.force, "replace files of the same names in a folder that is not empty");
  command.footer(kind_list());
}

NewSetup new_setup_of(const WrittenNew &written) {
  const StartKind *kind = find_start_kind(written.kind == any_target ? first_target : written.kind);
  if (!kind)
    throw Error(
        ExitCode::usage,
        fmt::format("KIND: expected one of {}, found {}; a folder of another name comes behind it, as in "
                    "`pmdsim new room {}`",
                    fmt::join(setup_kind_names(), ", "), in_quotes(written.kind), in_quotes(written.kind)));
  return {kind, written.folder.empty() ? std::filesystem::path(written.kind) : written.folder,
          sizes_of(*kind, written.wishes), written.force};
}

} // namespace pmdsim
