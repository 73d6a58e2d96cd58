#pragma once
// The program's exit codes in words, for manual pages and `pmdsim explain`.

#include <array>
#include <string_view>

namespace pmdsim {

struct ExitCodeRow {
  int code;
  std::string_view about;  // "an input is wrong"
  std::string_view remedy; // what to do then, in whole sentences; empty where there is nothing to do
};

inline constexpr std::array<ExitCodeRow, 11> exit_code_rows{
    {{0, "done", ""},
     {1, "internal error",
      "The program has a mistake. Please report it with the command line, the setup and the message."},
     {2, "the command line is wrong",
      "The message names the option or operand and what was expected; `pmdsim COMMAND --help` lists them."},
     {3, "an input is wrong",
      "The message names the file, the place in it and what was expected; `pmdsim check SETUP` reads all "
      "inputs and measures nothing, and `pmdsim explain KEY` tells what a key may hold."},
     {4, "no usable device",
      "`pmdsim devices` lists the devices and what they lack. Mesa's lavapipe runs on every processor; "
      "--device reference needs no Vulkan at all and is slow."},
     {5, "out of memory", "Fewer pixels, samples, diodes or triangles take less, as do fewer --channels."},
     {6, "the device was lost",
      "The driver gave up, and gave up again after the device was set up anew: its log says why. Frames that "
      "were "
      "whole stay, and --resume goes on."},
     {7, "an output cannot be written",
      "The message names the path and the operating system's reason. Nothing half-written is left."},
     {8, "the accuracy asked for cannot be reached",
      "Ask for less by a larger --max-error, take --precision fp64 or --mode exact, or leave out --strict: "
      "then "
      "the channel error_bound_m tells which pixels are off by more."},
     {130, "interrupted",
      "By SIGINT, SIGTERM or SIGHUP. Frames of render and deform that were whole stay, and --resume goes on; "
      "other commands begin anew."},
     {141, "nobody reads standard output any more",
      "As after `pmdsim explain | head -1`; nothing is said. Files that the command was to write are "
      "whole."}}};

} // namespace pmdsim
