// Writes the bytes of the repeatability frame that its first argument names to the file that its second
// names.

#include "tests/comparison/frame_bytes.h"
#include "tests/support/simulator.h"

#include <exception>
#include <fstream>
#include <iostream>

int main(int argc, char **argv) {
  using namespace pmdsim;
  if (argc != 3)
    return 2;
  try {
    Simulator simulator = test::make_simulator(test::keep_everything());
    std::ofstream file(argv[2], std::ios::binary);
    file << test::bytes_of(test::measure(simulator, test::repeatability_frame(argv[1]))) << std::flush;
    return file ? 0 : 1;
  } catch (const std::exception &error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
