#pragma once
// The commands of the program, one file each. All throw Error.

#include "host/command_line/options.h"

namespace pmdsim {

void run_render(const Options &options);
void run_deform(const Options &options);
void run_check(const Options &options);
void run_bench(const Options &options);
void run_tradeoff(const Options &options);
void run_noise(const Options &options);
void run_correct(const Options &options);
void run_diodes(const Options &options);
void run_merge(const Options &options);
void run_report(const Options &options);
void run_import_calibration(const Options &options);
void run_devices(const Options &options);
void run_new(const Options &options);
void run_schema(const Options &options);
void run_explain(const Options &options);

} // namespace pmdsim
