#include "host/output/run/merge.h"
#include "engine/model/error.h"
#include "host/capture/progress.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/output/run/run_folder.h"
#include "host/output/sheets/sheets.h"
#include "host/report/report.h"

#include <fmt/format.h>
#include <string>
#include <vector>

namespace pmdsim {
namespace {

Merged manifest_made_again(const Options &options) {
  if (options.capture.frames)
    throw Error(ExitCode::usage, "--frames: expected -o beside it, a manifest tells of all frames");
  RunFolder folder = RunFolder::of_existing(options.merged.front(), throw_if_interrupted);
  return {folder.run().hash, folder.write_manifest()};
}

} // namespace

void run_merge(const Options &options) {
  const auto &into = options.capture.output_directory;
  const auto &folder = into.empty() ? options.merged.front() : into;
  const Merged merged =
      into.empty() ? manifest_made_again(options)
                   : merge_runs({options.merged, into, options.capture.frames}, throw_if_interrupted);
  if (merged.left)
    warn(*merged.left);
  std::vector<std::string> written;
  for (const std::string &sheet : write_sheets(folder, throw_if_interrupted))
    written.push_back((folder / sheet).string());
  written.push_back((folder / manifest_name).string());
  if (options.json)
    print(json_text({{"run", merged.run_hash},
                     {"frames", merged.frames},
                     {"linked", merged.linked},
                     {"copied", merged.copied},
                     {"outputs", written}}));
  else
    print(fmt::format("{} frames, {} files linked, {} copied\n\nwritten:\n  {}\n", merged.frames,
                      merged.linked, merged.copied, fmt::join(written, "\n  ")));
}

} // namespace pmdsim
