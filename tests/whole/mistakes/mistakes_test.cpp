// Typical mistakes on the real binary: exit code, one line, file, place and remedy; and docs/mistakes.md,
// whose tables are what is tested here.

#include "tests/program/program.h"
#include "tests/whole/mistakes/mistakes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

using namespace pmdsim::test;

namespace {

std::vector<Mistakes> all_mistakes() {
  return {key_mistakes(),  value_mistakes(), reference_mistakes(), text_mistakes(),
          file_mistakes(), table_mistakes(), command_mistakes(),   option_mistakes()};
}

// A folder with what setups here name, and the row's files.
void fill(const Workspace &work, const Mistake &mistake) {
  work.write("setup.json", good_setup());
  work.write("wall.gltf", with(with(wall_gltf(), "\"wall\"", "\"Wall\""), "{\"primitives\"",
                               "{\"name\": \"Plane.001\", \"primitives\""));
  work.write("diodes.csv", "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n0,0,0,0,0,1,1,3\n");
  work.write("poses.csv", "time_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n");
  for (const auto &[name, text] : mistake.files)
    work.write(name, text);
}

Run run_of(const Mistake &mistake) {
  const Workspace work;
  fill(work, mistake);
  return run_pmdsim(mistake.arguments, {.directory = work.path()});
}

// What the program says, as the page shows it.
std::string answer_of(const Run &run) {
  if (run.errors.empty())
    return "(no error)";
  std::string line = run.errors.substr(0, run.errors.find('\n'));
  std::ranges::replace(line, '|', '/');
  return line.find('`') == line.npos ? "`" + line + "`" : "`` " + line + " ``";
}

std::string row_of(const Mistake &mistake, const Run &run) {
  return fmt::format("| {} | {} | {} |\n", mistake.written, answer_of(run), mistake.remedy);
}

std::string head_of(const Mistakes &mistakes) {
  return fmt::format("## {}\n\n| written | answer | remedy |\n|---|---|---|\n", mistakes.title);
}

std::string page() {
  std::ifstream file(PMDSIM_MISTAKES_PAGE);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void check_answer(const Mistake &mistake, const Run &run) {
  CHECK(run.exit_code == mistake.exit_code);
  CHECK(std::ranges::count(run.errors, '\n') == (mistake.told.empty() ? 0 : 1));
  for (const std::string &told : mistake.told) {
    INFO("expected in the answer: " << told);
    CHECK(run.errors.find(told) != std::string::npos);
  }
  if (mistake.exit_code != 0) {
    CHECK(run.errors.starts_with("pmdsim: error: "));
    CHECK(run.output.empty());
  }
}

} // namespace

TEST_CASE("every typical mistake is answered in one line, and the page shows it") {
  const std::string text = page();
  std::size_t rows = 0;
  for (const Mistakes &mistakes : all_mistakes()) {
    std::string table = head_of(mistakes);
    for (const Mistake &mistake : mistakes.rows) {
      const Run run = run_of(mistake);
      INFO(mistakes.title << ": " << mistake.written << "\n" << run.errors);
      check_answer(mistake, run);
      CHECK_FALSE(mistake.remedy.empty());
      table += row_of(mistake, run);
      ++rows;
    }
    INFO("expected in docs/mistakes.md (test_mistakes \"[page]\" writes it):\n" << table);
    CHECK((text + "\n").find(table + "\n") != std::string::npos);
  }
  CHECK(rows >= 60);
  CHECK(text.find("```json\n" + good_setup() + "```\n") != std::string::npos);
}

// Not run by itself: writes the page's tables anew, to be looked through by eye.
TEST_CASE("the page's tables are written", "[.][page]") {
  std::string text = page();
  text.erase(text.find("\n## ") + 1);
  std::string sections;
  for (const Mistakes &mistakes : all_mistakes()) {
    sections += (sections.empty() ? "" : "\n") + head_of(mistakes);
    for (const Mistake &mistake : mistakes.rows)
      sections += row_of(mistake, run_of(mistake));
  }
  std::ofstream(PMDSIM_MISTAKES_PAGE) << text << sections;
}
