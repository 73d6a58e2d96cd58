#include "host/input/calibration/yaml_file.h"

#include "host/input/file/input_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>
#include <yaml-cpp/eventhandler.h>

namespace pmdsim {
namespace {

// Ends the parsing of a document that would take too much memory as a tree. An alias counts once, as it takes
// the memory of one.
class ValueCount final : public YAML::EventHandler {
public:
  void OnDocumentStart(const YAML::Mark &) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark &mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark &mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark &mark, const std::string &, YAML::anchor_t, const std::string &) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark &mark, const std::string &, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark &mark, const std::string &, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnMapEnd() override {}

private:
  void count(const YAML::Mark &mark) {
    if (++values_ > max_yaml_values)
      throw YAML::ParserException(mark, fmt::format("more than {} values", max_yaml_values));
  }

  std::size_t values_ = 0;
};

std::string reason(const YAML::Exception &error) {
  if (error.msg == YAML::ErrorMsg::BAD_FILE) // yaml-cpp's name for what is nested deeper than it follows
    return "nested too deep";
  std::string text = error.msg; // may quote a byte that is no text
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

} // namespace

YAML::Node parse_yaml(const std::string &text, const std::filesystem::path &file) {
  try {
    std::istringstream in(text);
    ValueCount count;
    YAML::Parser(in).HandleNextDocument(count);
    return YAML::Load(text);
  } catch (const YAML::Exception &error) {
    const std::string message = "not valid YAML or JSON: " + reason(error);
    if (error.mark.is_null())
      throw input_error(Place{file}, message);
    throw input_error(TextPlace{file, static_cast<std::size_t>(error.mark.line) + 1,
                                static_cast<std::size_t>(error.mark.column) + 1},
                      message);
  }
}

} // namespace pmdsim
