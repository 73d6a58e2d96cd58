// Writes the bytes of the repeatability frame to the file that its one argument names.

#include "tests/gpu_against_reference/frame_bytes.h"
#include "tests/support/simulator.h"

#include <exception>
#include <fstream>
#include <iostream>

int main(int argc, char **argv) {
  using namespace pmdsim;
  if (argc != 2)
    return 2;
  try {
    Simulator simulator = test::make_simulator({.device = {}, .keep_sample_tags = true});
    test::prepare_repeatability_frame(simulator);
    std::ofstream file(argv[1], std::ios::binary);
    file << test::bytes_of(simulator.measure()) << std::flush;
    return file ? 0 : 1;
  } catch (const std::exception &error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
