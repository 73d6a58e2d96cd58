#include "host/output/page/page_text.h"

#include <fmt/format.h>
#include <stdexcept>

namespace pmdsim {
namespace {

// The rest of the page after `mark`, and what comes before it is written.
std::string_view written_up_to(std::string_view mark, std::string_view page,
                               const std::function<void(std::string_view)> &write) {
  const std::size_t at = page.find(mark);
  if (at == std::string_view::npos)
    throw std::logic_error("the page has not all its marks");
  write(page.substr(0, at));
  return page.substr(at + mark.size());
}

} // namespace

std::string json_for_script(const nlohmann::ordered_json &json) {
  const std::string text = json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(text.size());
  for (const char character : text) // all three occur within strings only
    if (character == '<' || character == '>' || character == '&')
      escaped += fmt::format("\\u{:04x}", static_cast<int>(character));
    else
      escaped += character;
  return escaped;
}

void write_page(const nlohmann::ordered_json &run, const std::vector<std::string> &blocks,
                const std::function<void(std::string_view)> &write) {
  std::string_view rest = written_up_to("<!-- style -->", page_html, write);
  write(fmt::format("<style>\n{}</style>", page_style));
  rest = written_up_to("<!-- data -->", rest, write);
  write(fmt::format("<script type=\"application/json\" id=\"run\">{}</script>\n", json_for_script(run)));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    write(fmt::format("<script type=\"application/octet-stream;base64\" id=\"block-{}\">", i));
    write(blocks[i]);
    write("</script>\n");
  }
  rest = written_up_to("<!-- script -->", rest, write);
  write(fmt::format("<script type=\"module\">\n{}</script>", page_script));
  write(rest);
}

} // namespace pmdsim
