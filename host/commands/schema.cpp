#include "host/commands/commands.h"
#include "host/input/schema/schema_check.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_file.h"
#include "host/report/report.h"

namespace pmdsim {

void run_schema(const Options &options) {
  if (options.schema_file.empty())
    return print(std::string(setup_schema_text));
  refuse_what_is_no_file(options.schema_file);
  OutputFile file(options.schema_file);
  file.write(setup_schema_text);
  file.sync();
  file.close();
  file.publish();
  if (options.json)
    print(json_text({{"outputs", {options.schema_file.string()}}}));
}

} // namespace pmdsim
