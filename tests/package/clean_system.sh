#!/usr/bin/env bash
# A clean Debian in a folder: apt installs the .deb with what it depends on and nothing else, the program renders, Python
# imports the module, the consumers in C and C++ are built and run there; and the wheel works in an environment of its
# own. clean_system.sh REPOSITORY_COPY is not needed: clean_system.sh PACKAGE.deb WHEEL.whl
. "$(dirname "$0")/../support/check.sh"
