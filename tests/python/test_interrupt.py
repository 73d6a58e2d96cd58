"""Ctrl-C while a frame is measured."""

from __future__ import annotations

import signal
import subprocess
import time
import unittest

from setups import python

# A frame that takes minutes; the child tells when it is in the call, and what came of it.
code = """
import sys, threading, time
import pmdsim
from setups import small_setup
setup = small_setup()
setup["sensors"][0].update(resolution=[100, 1500], samples=16, focal_length_m=0.45)
setup["illuminators"][0]["diodes"]["rings"][0]["count"] = 60
print("ready", flush=True)
try:
    ACTION
except KeyboardInterrupt:
    print("interrupted", flush=True)
assert pmdsim.render(small_setup()).shape == (6, 8)
print("goes on", flush=True)
"""

actions = {
    "render": 'pmdsim.render(setup, device="reference")',
    "simulator": 'with pmdsim.Simulator(setup, device="reference") as simulator: simulator.render()',
    "sweep": 'list(pmdsim.sweep(setup, {"illuminators/0/intensity_w_sr": [1, 2, 3]}, workers=2, device="reference"))',
}


class Interrupt(unittest.TestCase):
    def test_ends_the_call(self) -> None:
        for name, action in actions.items():
            with self.subTest(name):
                child = python(code.replace("ACTION", action))
                self.assertEqual(child.stdout.readline(), "ready\n")
                time.sleep(1.0)
                child.send_signal(signal.SIGINT)
                begin = time.monotonic()
                first = child.stdout.readline()
                print(f"{name}: KeyboardInterrupt {1e3 * (time.monotonic() - begin):.0f} ms after Ctrl-C")
                try:
                    output, errors = child.communicate(timeout=60)
                except subprocess.TimeoutExpired:
                    child.kill()
                    raise
                self.assertEqual((first, output, errors, child.returncode), ("interrupted\n", "goes on\n", "", 0))


if __name__ == "__main__":
    unittest.main()
