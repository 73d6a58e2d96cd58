#!/usr/bin/env bash
# What `cmake --install` installs works from whatever place it is moved to: the program, the library, which shows its C
# interface alone, and the consumers in C and C++ by find_package and by pkg-config. installed.sh BUILD
. "$(dirname "$0")/../support/check.sh"
build=$1
consumer=$source_root/tests/consumer
prefix=$scratch/moved

install_and_move() {
  cmake --install "$build" --prefix "$scratch/first" >/dev/null
  mv "$scratch/first" "$prefix"
  library=$(find "$prefix" -name 'libpmdsim.so.0')
  [ -n "$library" ] || fail 'libpmdsim.so.0 is not installed'
}

check_symbols() {
  local declared
  declared=$(sed -nE 's/^PMDSIM_API .*[ *](pmdsim_[a-z_]+)\(.*/\1/p' "$prefix/include/pmdsim.h" | sort)
  expect 'what the library shows' "$declared" "$(nm -DC --defined-only "$library" | cut -d' ' -f3- | sort)"
  expect 'soname' libpmdsim.so.0 "$(readelf -d "$library" | sed -nE 's/.*SONAME.*\[(.*)\]/\1/p')"
}

# Nothing of the build's folders and flags is in what others read.
check_traces() {
  expect 'run paths' '' "$(readelf -d "$library" "$prefix/bin/pmdsim" | grep -E 'RPATH|RUNPATH' || true)"
  expect 'files with the build in them' '' "$(grep -rIl -e "$build" -e "$scratch/first" "$prefix" || true)"
  expect 'files with warnings in them' '' "$(grep -rIl -e -Werror "$prefix/lib" || true)"
}

check_program() {
  local setup=$prefix/share/doc/pmdsim/examples/scenes/analytic/inverse_square.json
  "$prefix/bin/pmdsim" check "$setup" >"$scratch/log" 2>&1 || fail "$(cat "$scratch/log")"
  "$prefix/bin/pmdsim" render "$setup" -o "$scratch/out" --format npy >"$scratch/log" 2>&1 || fail "$(cat "$scratch/log")"
  [ -f "$scratch/out/manifest.json" ] || fail 'render wrote no manifest'
}

# consume_by_cmake LANGUAGE: the build sets the run path, so that no variable is needed.
consume_by_cmake() {
  cmake -S "$consumer" -B "$scratch/$1" -DCONSUMER_LANGUAGE="$1" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_C_FLAGS='-std=c99 -Wall -Wextra -Wpedantic -Werror' -DCMAKE_CXX_FLAGS='-Wall -Wextra -Wpedantic -Werror' \
    >"$scratch/log" 2>&1 || fail "cmake: $(cat "$scratch/log")"
  cmake --build "$scratch/$1" >"$scratch/log" 2>&1 || fail "build: $(cat "$scratch/log")"
  "$scratch/$1/consumer"
}

# consume_by_pkg_config COMPILER SOURCE
consume_by_pkg_config() {
  local flags
  flags=$(PKG_CONFIG_PATH=$(dirname "$library")/pkgconfig pkg-config --cflags --libs pmdsim)
  "$1" "$consumer/$2" -o "$scratch/$2.out" -Wall -Wextra -Werror $flags -lm
  LD_LIBRARY_PATH=$(dirname "$library") "$scratch/$2.out"
}

# find_package finds the version that is installed, and none that is newer.
check_versions() {
  local version
  version=$("$prefix/bin/pmdsim" --version | cut -d' ' -f2)
  mkdir "$scratch/versions"
  printf '%s\n' 'cmake_minimum_required(VERSION 3.20)' 'project(versions NONE)' "find_package(pmdsim $version REQUIRED)" \
    'find_package(pmdsim 99 QUIET)' 'if(pmdsim_FOUND)' '  message(FATAL_ERROR "found as version 99")' 'endif()' \
    >"$scratch/versions/CMakeLists.txt"
  cmake -S "$scratch/versions" -B "$scratch/versions/build" -DCMAKE_PREFIX_PATH="$prefix" >"$scratch/log" 2>&1 ||
    fail "versions: $(cat "$scratch/log")"
}

need cmake cc c++ pkg-config nm readelf
install_and_move
check_symbols
check_traces
check_program
consume_by_cmake C
consume_by_cmake CXX
consume_by_pkg_config cc consumer.c
consume_by_pkg_config c++ consumer.cpp
check_versions
say 'program, library and both consumers work from where they were moved to'
