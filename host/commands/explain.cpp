#include "engine/model/error.h"
#include "host/commands/commands.h"
#include "host/explain/topics.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

namespace pmdsim {

void run_explain(const Options &options) {
  const ExplainRequest &request = options.explain;
  if (request.markdown && options.json)
    throw Error(ExitCode::usage, "--markdown: expected no --json beside it");
  if (request.markdown)
    return print(reference_page());
  const std::vector<Topic> topics = request.words.empty() ? all_topics() : topics_of(request.words);
  if (options.json)
    return print(json_text(topics_json(topics)));
  constexpr std::size_t most_in_full = 6; // keys of poses stand in many places
  const bool in_lines = request.words.empty() || topics.size() > most_in_full + request.words.size();
  print(in_lines ? topic_lines(topics) : topics_text(topics));
}

} // namespace pmdsim
