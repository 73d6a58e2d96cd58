"""Makes a wheel that carries libpmdsim, for any Python 3: the environment variable PMDSIM_LIBRARY names the library,
and the wheel has its version. `./do wheel` calls it; docs/install.md, "The wheel"."""

import ctypes
import os
import shutil
import sys
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

if not os.path.isfile(os.environ.get("PMDSIM_LIBRARY", "")):
    sys.exit("setup.py: expected the path of libpmdsim.so.0 in the environment variable PMDSIM_LIBRARY")
library_file = Path(os.environ["PMDSIM_LIBRARY"]).resolve()


def version_and_soname():
    library = ctypes.CDLL(str(library_file))
    library.pmdsim_version.restype = ctypes.c_char_p
    return library.pmdsim_version().decode(), f"libpmdsim.so.{library.pmdsim_abi()}"


version, soname = version_and_soname()


class BuildWithLibrary(build_py):
    """Puts the library into the package, where pmdsim looks for it first."""

    def run(self):
        super().run()
        folder = Path(self.build_lib, "pmdsim", "lib")
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(library_file, folder / soname)


class BinaryDistribution(Distribution):
    def has_ext_modules(self):
        return True


class WheelOfAnyPython(bdist_wheel):
    """ctypes needs no build for each version of Python."""

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


setup(
    version=version,
    distclass=BinaryDistribution,
    cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": WheelOfAnyPython},
)
