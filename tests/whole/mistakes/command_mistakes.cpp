// Mistakes on the command line.

#include "tests/program/program.h"
#include "tests/whole/mistakes/mistakes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim::test {
namespace {

constexpr int usage = 2;

Mistake typed(const std::vector<std::string> &arguments, const std::vector<std::string> &told,
              const std::string &remedy, int exit_code = usage) {
  return {fmt::format("`pmdsim{}{}`", arguments.empty() ? "" : " ", fmt::join(arguments, " ")),
          arguments,
          {},
          exit_code,
          told,
          remedy};
}

// `render` of the good setup with more.
Mistake rendered(std::vector<std::string> more, const std::vector<std::string> &told,
                 const std::string &remedy, int exit_code = usage) {
  more.insert(more.begin(), {"render", "setup.json"});
  return typed(more, told, remedy, exit_code);
}

Mistake set(const std::string &change, const std::vector<std::string> &told, const std::string &remedy,
            int exit_code = 3) {
  return typed({"check", "setup.json", "--set", change}, told, remedy, exit_code);
}

} // namespace

Mistakes command_mistakes() {
  return {
      "Commands and operands",
      {typed({"help"}, {"unknown command \"help\"", "pmdsim --help"}, "`pmdsim --help`, or `pmdsim` alone"),
       typed({"rendr", "setup.json"}, {"unknown command \"rendr\"", "did you mean \"render\"?"}, "`render`"),
       typed({"Render", "setup.json"}, {"unknown command \"Render\"", "did you mean \"render\"?"},
             "`render`"),
       typed({"setup.json"}, {"expected a command before \"setup.json\"", "pmdsim check setup.json"},
             "`pmdsim check setup.json`"),
       typed({"--samples", "4", "render", "setup.json"}, {"--samples: expected the command first"},
             "`pmdsim render setup.json --samples 4`"),
       typed({"render"}, {"render: expected SETUP", "found none"}, "The setup's file"),
       typed({"check", "setup.json", "other.json"}, {"check: expected one SETUP", "\"other.json\""},
             "One after the other; `render` takes several"),
       typed({"devices", "setup.json"}, {"devices: expected options alone", "\"setup.json\""},
             "`pmdsim devices`"),
       typed({"check", "setup.json", "--format", "exr"}, {"check has no option --format", "render, deform"},
             "`check` writes no files"),
       typed({"deform", "setup.json", "--variants", "v.jsonl"},
             {"deform has no option --variants, which belongs to render", "--set"},
             "`deform` once for each, with `--set`"),
       typed({"diodes", "setup.json", "--tolerance", "0.1mm"},
             {"diodes has no option --tolerance", "--position 0.1mm", "--axis", "--intensity", "--phase"},
             "`--position 0.1mm`"),
       rendered({"--sample", "4"}, {"render has no option --sample", "did you mean --samples?"},
                "`--samples 4`"),
       rendered({"-output", "out"}, {"unknown option -output", "did you mean --output?"},
                "`--output`, or `-o`"),
       rendered({"\xe2\x80\x93-json"}, {"two short dashes"},
                "`--json`: a text program has joined the dashes"),
       rendered({"--colour"}, {"render has no option --colour", "pmdsim render --help"},
                "`pmdsim render --help`"),
       rendered({"--json=out.json"}, {"--json: expected no value", "out.json"}, "`--json > out.json`"),
       rendered({"--samples"}, {"--samples: expected a value behind it"}, "`--samples 4`")}};
}

Mistakes option_mistakes() {
  return {
      "Values of options",
      {rendered({"--format", "exr,jpg"}, {"--format: expected", "found \"jpg\""}, "`png`, for example"),
       rendered({"--mode", "fast"}, {"--mode: expected exact, reduced, auto", "found \"fast\""},
                "`--mode auto`"),
       rendered({"--precision", "double"}, {"--precision: expected fp32, fp64"}, "`--precision fp64`"),
       rendered({"--samples", "0"}, {"--samples: expected a whole number from 1 to 16, or auto, found \"0\""},
                "1 or more"),
       rendered({"--max-error", "0.1"}, {"--max-error: expected a length", "with its unit", "found \"0.1\""},
                "`--max-error 0.1mm`"),
       rendered({"--max-error", "-1mm"}, {"--max-error: expected a length", "found \"-1mm\""},
                "A length above 0"),
       rendered({"--frames", "3"}, {"--frames: expected A:B", "found \"3\""},
                "`--frames 3:4` is frame 3 alone"),
       rendered({"--frames", "0-3"}, {"--frames: expected A:B", "found \"0-3\""}, "`--frames 0:4`"),
       rendered({"--frames", "5:2"}, {"--frames: expected A:B", "A below B", "found \"5:2\""},
                "`--frames 2:5`"),
       rendered({"--frames", "0:5"}, {"--frames 0:5: expected B at most 1", "setup.json"},
                "As many as the setup has, or a larger `count` there"),
       rendered({"--shard", "8/8"}, {"--shard: expected I/N", "I from 0 to N - 1", "found \"8/8\""},
                "`0/8` to `7/8`"),
       rendered({"--channels", "distance"},
                {"--channels: unknown channel \"distance\"", "did you mean \"distance_m\"?"},
                "`--channels distance_m`"),
       rendered({"--channels", "depth"}, {"--channels: unknown channel \"depth\"", "z_m"},
                "`z_m` along the axis, `range_m` from the lens, `distance_m` as measured"),
       rendered({"--device", "nvidia"}, {"no Vulkan device", "nvidia", "pmdsim devices"},
                "A name or an index of `pmdsim devices`", 4),
       rendered({"-o", "diodes.csv"}, {"diodes.csv", "directory"}, "A folder: each frame is a file in it", 7),
       rendered({"-o", "/proc/pmdsim"}, {"/proc/pmdsim"}, "A folder where you may write", 7),
       set("sensors/0/taps", {"--set: expected PATH=VALUE", "found \"sensors/0/taps\""}, "`sensors/0/taps=4`",
           usage),
       set("sensors/0/tabs=4", {"setup.json: /sensors/0 (by --set):", "\"tabs\"", "did you mean \"taps\"?"},
           "`sensors/0/taps=4`"),
       set("sensors/1/taps=4",
           {"setup.json:3:14: /sensors: --set cannot set \"sensors/1/taps\"", "found \"1\""},
           "The first is `sensors/0`"),
       set("sensors/pdm/taps=4", {"--set cannot set", "did you mean \"pmd\"?"}, "`sensors/pmd/taps=4`"),
       set("sensors/0/focal_lengt_m=null",
           {"--set cannot set", "no key \"focal_lengt_m\" to remove", "did you mean \"focal_length_m\"?"},
           "`null` takes a key out, so that its default holds"),
       set("sensors/0/taps=2", {"setup.json: /sensors/0/taps (by --set):", "found 2"}, "3 to 16"),
       set("sensors/0/modulation_hz=30MHz",
           {"setup.json: /sensors/0/modulation_hz (by --set):", "write [30000000]"},
           "`sensors/0/modulation_hz=[30e6]`"),
       typed({"import-calibration", "camera.yaml", "--pixel-pitch-m", "45um"},
             {"--pixel-pitch-m: expected a number", "\"45um\""}, "Metres: `45e-6`")}};
}

} // namespace pmdsim::test
