// Manual pages and completions tell what the parser takes. That shells and groff accept them is tested with
// the installed files (tests/package/manual.sh).

#include "host/manual/manual.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>

using namespace pmdsim;

namespace {

// A program with one command of each kind of argument, and a hidden command and option.
struct Program {
  CLI::App app{"toy: does nothing", "toy"};
  std::string text;
  std::vector<std::string> list;
  int number = 0;

  Program() {
    CLI::App *draw = app.add_subcommand("draw", "draws: a 'picture' of 1 m²");
    draw->add_option("FILE", text, "what to draw")->required();
    draw->add_option("-c,--colours", list, "which [all]")
        ->delimiter(',')
        ->check(CLI::IsMember({"red", "blue"}));
    draw->add_option("--size", number, "of it");
    draw->add_option("--secret", text)->group("");
    draw->add_option("PARTS", list, "of the picture");
    draw->add_flag("--fast")->description("as `others` do");
    draw->footer("Colours:\n  red    m    warm\n  blue        cold\n");
    app.add_subcommand("internal", "not for people")->group("");
  }
};

bool holds(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("the table of a command line has what its help has") {
  const Program program;
  const CommandTable table = table_of(program.app);
  CHECK(table.program == "toy");
  REQUIRE(table.commands.size() == 1);
  const CommandRow &draw = table.commands.front();
  REQUIRE(draw.operands.size() == 2);
  CHECK(draw.operands.front().names == std::vector<std::string>{"FILE"});
  CHECK(draw.operands.front().is_required);
  CHECK_FALSE(draw.operands.front().is_repeated);
  CHECK(draw.operands.back().is_repeated);
  REQUIRE(draw.options.size() == 4); // --help is one
  CHECK(draw.options[1].names == std::vector<std::string>{"-c", "--colours"});
  CHECK(draw.options[1].is_list);
  std::vector<std::string> colours = draw.options[1].choices;
  std::ranges::sort(colours);
  CHECK(colours == std::vector<std::string>{"blue", "red"});
  CHECK(draw.options[2].value == "number");
  CHECK_FALSE(draw.options[2].is_list);
  CHECK(draw.options[3].value.empty());
  CHECK(find_command(table, "draw") == &draw);
  CHECK(find_command(table, "internal") == nullptr);
}

TEST_CASE("a manual page is ASCII, and none of its text is taken for a request") {
  const Program program;
  CommandTable table = table_of(program.app);
  table.commands.front().options[2].about = ".SH is text, and so is \\fB";
  const std::string page = man_page(table, table.commands.front(), "1.2.3");
  CHECK(std::ranges::all_of(page,
                            [](char c) { return std::isprint(static_cast<unsigned char>(c)) || c == '\n'; }));
  CHECK(holds(page, ".TH toy\\-draw 1 \"\" \"pmdsim 1.2.3\""));
  CHECK(holds(page, "\\fIFILE\\fR [\\fIPARTS\\fR ...] [\\fIOPTION\\fR ...]\n"));
  CHECK(holds(page, "1 m\\[u00B2]"));
  CHECK(holds(page, "\n\\&.SH is text, and so is \\efB\n"));
  CHECK(holds(page, "as \\fBothers\\fR do"));
  CHECK(holds(page, ".SH COLOURS\n.TP\n\\fBred\\fR\nm: warm\n.TP\n\\fBblue\\fR\ncold\n"));
  CHECK(holds(page, ".BR toy (1)"));
  CHECK_FALSE(holds(page, "secret"));
  CHECK(holds(man_page(table, "1.2.3"), ".BR toy\\-draw (1)"));
}

TEST_CASE("completions know commands, options and values") {
  const Program program;
  const CommandTable table = table_of(program.app);
  for (const std::string &script : {bash_completion(table), zsh_completion(table), fish_completion(table)}) {
    INFO(script);
    for (const char *word : {"draw", "colours", "red", "fast"})
      CHECK(holds(script, word));
    CHECK_FALSE(holds(script, "secret"));
    CHECK_FALSE(holds(script, "internal"));
  }
  CommandTable suggesting = table;
  suggest(suggesting, "--size", {"small", "large"});
  suggest(suggesting, "FILE", {"horse"});
  for (const std::string &script :
       {bash_completion(suggesting), zsh_completion(suggesting), fish_completion(suggesting)})
    for (const char *word : {"small large", "horse"})
      CHECK(holds(script, word));
  CHECK_FALSE(holds(man_page(suggesting, suggesting.commands.front(), "1"), "horse")); // it takes others, too
  CHECK(holds(zsh_completion(table), "a '\\''picture'\\'' of"));
  CHECK(holds(zsh_completion(table), "which \\[all\\]"));
  CHECK(holds(fish_completion(table), "a \\'picture\\' of"));
}
