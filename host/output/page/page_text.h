#pragma once
// The page as text: the HTML, style and scripts of host/output/page/browser, and a run's data in it.

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// Compiled into the program.
extern const std::string_view page_html, page_style, page_script;

// JSON that may stand in a <script> element, whatever is in its strings: "<", ">" and "&" are escaped, and so
// is all beyond ASCII. Text that is not UTF-8 is replaced.
std::string json_for_script(const nlohmann::ordered_json &json);

// Calls `write` with the page piece by piece: its data is `run`, and block N has the id "block-N".
void write_page(const nlohmann::ordered_json &run, const std::vector<std::string> &blocks,
                const std::function<void(std::string_view)> &write);

} // namespace pmdsim
