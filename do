#!/usr/bin/env bash
# All the set-up there is: ./do demo | run ARGS | test [--long|--smoke] | bench [ARGS] | build | package | wheel |
# lint [--long] | fuzz [TARGET|all [SECONDS]] | sanitize [address|thread]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$root/build/release
program=$build/bin/pmdsim

# Debian's packages, by what needs them: the build, Vulkan at run time, the libraries, the tests.
packages=(
  g++ cmake ninja-build pkg-config
  libvulkan-dev libvulkan1 mesa-vulkan-drivers vulkan-validationlayers glslang-tools spirv-tools
  libglm-dev libeigen3-dev libfftw3-dev libembree-dev libtinygltf-dev nlohmann-json3-dev libvalijson-dev libfccp-dev libyaml-cpp-dev libpugixml-dev libxxhash-dev
  libcli11-dev libfmt-dev
  libmeshoptimizer-dev libpng-dev libturbojpeg0-dev
  libopenexr-dev libisal-dev libdeflate-dev libarchive-dev libhdf5-dev libcairo2-dev fonts-dejavu-core libtbb-dev
  catch2 python3-numpy
)

# What long tests of packages, manual pages, clusters, fuzzers and pages need; all but the last are skipped where there are
# no such packages.
packages_of_long_tests=(
  mmdebstrap groff-base man-db zsh fish
  slurm-wlm munge procps python3-distributed python3-dask
  clang-19 libclang-rt-19-dev
  chromium chromium-driver python3-selenium
  python3-pil
)

say() { printf '%s\n' "do: $*" >&2; }

usage() {
  cat >&2 <<'END'
usage: ./do COMMAND
  demo       install what is missing, build, compute a furnished room and the paper's figures 6, 11 and 13
  run ARGS   run pmdsim with ARGS, e.g. ./do run deform scenes/paper_ring.json
  test       build and run what every change must pass, some minutes; prints the accuracy tables
             --smoke  only a few cases of each kind, within a minute
             --long   all tests there are, and lint --long, for hours
  bench      measure the throughput of the paper's ring and how time grows; ./do bench SETUP for a setup alone
  build      install what is missing and build
  package    build and make a Debian package of program, library and Python module: build/pmdsim_VERSION_ARCHITECTURE.deb
  wheel      build and make a Python wheel that carries the library: build/pmdsim-VERSION-py3-none-PLATFORM.whl
  lint       check the formatting and look for mistakes with clang-tidy
             --long   each source by itself: builds it, and looks at it with clang's analyzer
  fuzz       feed the readers of files, the C interface and the device what nobody writes: all targets of tests/fuzz,
             60 s each; ./do fuzz TARGET [SECONDS] one of them, ./do fuzz all SECONDS
  sanitize   build with sanitizers and run the tests of every day under them, for hours: address, which is also for
             leaks and undefined behavior, or thread
END
  exit 2
}

install() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  say "installing with apt: $*"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >&2
}

update_package_lists() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  "${as_root[@]}" apt-get update -qq >&2
}

# apt's own tools say what is missing; on another system the packages are the user's business.
install_missing() {
  command -v dpkg-query >/dev/null || return 0
  local missing=() status package
  status=$(dpkg-query -W -f='${binary:Package} ${db:Status-Abbrev}\n' "${packages[@]}" 2>/dev/null || true)
  for package in "${packages[@]}"; do
    grep -qE "^${package//+/\\+}(:[a-z0-9]+)? ii" <<<"$status" || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  update_package_lists
  install "${missing[@]}"
}

# Installs those of $@ that are missing, as far as there are such packages; what needs the others says so itself.
install_if_possible() {
  command -v apt-get >/dev/null || return 0
  local package missing=() known=()
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null | grep -q '^ii' || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  update_package_lists || true
  for package in "${missing[@]}"; do
    if apt-cache show "$package" >/dev/null 2>&1; then known+=("$package"); else say "no such package: $package"; fi
  done
  ((${#known[@]})) || return 0
  install "${known[@]}" || say "not installed: ${known[*]}"
}

# Debian has clang-tidy-22 beside its clang-tidy, which is version 14: that takes more than twice the time and calls
# some of C++20 an error, so it is taken only where there is no other.
clang_tidy() { command -v clang-tidy-22 || command -v clang-tidy; }

install_linters() {
  if command -v clang-tidy-22 >/dev/null && command -v clang-format >/dev/null; then return; fi
  command -v apt-get >/dev/null || return 0
  update_package_lists
  if apt-cache show clang-tidy-22 >/dev/null 2>&1; then
    install clang-format clang-tidy-22
  else
    install clang-format clang-tidy
  fi
}

# Prepares the build folder of the preset $1.
configure() {
  local folder=$root/build/$1
  if [ -f "$folder/build.ninja" ]; then return; fi
  install_missing
  say "configuring in ${folder#"$PWD"/}"
  (cd "$root" && cmake --preset "$1") >&2
}

# Passes on what ninja says, to stderr, from the first step of a build on; on a terminal its steps share a line.
tell_of_build() {
  local line told=
  while IFS= read -r line; do
    case $line in
    'ninja: Entering directory'* | '[0/'*'Re-checking globbed directories...' | 'ninja: no work to do.') continue ;;
    esac
    [ "$told" ] || say "building (a few minutes the first time)"
    told=yes
    if [ -t 2 ] && [[ $line == \[* ]]; then
      printf '\r\033[K%.*s' "$(($(tput cols 2>/dev/null || echo 80) - 1))" "$line" >&2
    else
      printf '%s\n' "$line" >&2
    fi
  done
  if [ "$told" ] && [ -t 2 ]; then printf '\n' >&2; fi
}

# Builds $1, a ninja target; silent where there is nothing to do. What has to be installed follows from this file alone.
build_target() {
  if [ ! -f "$build/build.ninja" ] || [ "$root/do" -nt "$build/build.ninja" ]; then install_missing; fi
  configure release
  ninja -C "$build" "$1" 2>&1 | tell_of_build
}

# Debian's own tools make packages; stripped, since nobody debugs with them.
make_package() {
  install_if_possible dpkg-dev file
  build_target all
  rm -f "$root"/build/pmdsim_*.deb
  (cd "$build" && cpack --config CPackConfig.cmake) >&2
  ls "$root"/build/pmdsim_*.deb
}

# From copies, as setuptools writes beside what it reads.
make_wheel() {
  local folder=$root/build/wheel
  install_if_possible python3-build python3-setuptools python3-wheel binutils
  build_target libpmdsim
  rm -rf "$folder" "$root"/build/pmdsim-*.whl
  mkdir -p "$folder"
  cp -r "$root/host/python/." "$folder/source"
  strip --strip-unneeded -o "$folder/libpmdsim.so.0" "$build/lib/libpmdsim.so.0"
  PMDSIM_LIBRARY=$folder/libpmdsim.so.0 /usr/bin/python3 -m build --wheel --no-isolation -o "$root/build" \
    "$folder/source" >&2
  ls "$root"/build/pmdsim-*.whl
}

demo() {
  local out=$root/out/demo figure
  printf '\n'
  "$program" render "$root/scenes/showroom/showroom.json" --format png,ply -o "$out/showroom"
  printf '\n'
  "$program" deform "$root/scenes/showroom/showroom.json" -o "$out/showroom_deformation"
  for figure in paper_ring paper_half_ring; do
    printf '\n'
    "$program" deform "$root/scenes/$figure.json" -o "$out/$figure"
  done
  for figure in paper_moire room; do
    printf '\n'
    "$program" render "$root/scenes/$figure.json" -o "$out/$figure"
  done
  printf '\nThe pictures are in %s:\n' "$out"
  (cd "$out" && find . -name '*.png' | sort | sed 's,^\./,  ,')
  printf '%s\n' "Look first at showroom/pmd_0000.amplitude.png, a room with its shadows, at what the light's place adds to its" \
    "distances, showroom_deformation/pmd_0000.deformation_mm.png, and at its points, showroom/pmd_0000.cloud.png and .ply."
  printf '%s\n' "Figure 11 of the paper is paper_ring/, figure 13 paper_half_ring/, figure 6's pattern paper_moire/."
}

# ctest with arguments $@; then all that the tests print, accuracy tables above all; ctest's summary comes last.
run_tests() {
  local summary=$build/ctest_summary.txt
  ctest --test-dir "$build" --output-on-failure --parallel 2 "$@" | tee "$summary"
  cat "$build/Testing/Temporary/LastTest.log"
  sed -n '/tests passed/,$p' "$summary"
}

run_smoke_tests() { ctest --test-dir "$build" --output-on-failure --parallel 2 --label-regex smoke; }

check_format() {
  local folders=("$root/engine" "$root/host" "$root/tests")
  find "${folders[@]}" -name '*.cpp' -o -name '*.h' | xargs clang-format --dry-run -Werror
}

# The program's sources as they are compiled in the preset $1: each room as one, or each by itself.
sources_of() {
  grep -oE '"file": "[^"]*"' "$root/build/$1/compile_commands.json" | cut -d'"' -f4 |
    grep -E "^$root/(build/$1/)?(engine|host)/" | sort -u
}

# clang-tidy over the sources of the preset $1 with the checks $2 beside those of .clang-tidy, the longest first.
tidy() {
  local sources=()
  mapfile -t sources < <(sources_of "$1" | xargs wc -c | sort -rn | awk '$2 != "total" { print $2 }')
  say "$(clang_tidy) over ${#sources[@]} files"
  printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$(nproc)" "$(clang_tidy)" -p "$root/build/$1" --quiet --checks="$2" \
    2> >(grep -v ' warnings generated' >&2)
}

# A room's sources together are parsed once, but the analyzer passes over what is included: it needs each by itself.
lint() {
  install_linters
  configure release
  check_format
  tidy release '-clang-analyzer-*,-bugprone-suspicious-include,-clang-diagnostic-shadow'
}

# The build comes first, as an include that a source or a test lacks is not seen in a room.
lint_long() {
  install_linters
  configure dev
  ninja -C "$root/build/dev" 2>&1 | tell_of_build
  check_format
  tidy dev ''
}

# Clang with libFuzzer, from version 19 on: older ones do not know the processor's features by the names that the engine asks
# for.
fuzzing_clang() {
  local clang version
  for clang in clang++-19 clang++; do
    command -v "$clang" >/dev/null || continue
    version=$("$clang" -dumpversion)
    if ((${version%%.*} >= 19)) && ls "$("$clang" -print-resource-dir)"/lib/*/*fuzzer-* >/dev/null 2>&1; then
      echo "$clang"
      return
    fi
  done
  return 1
}

install_fuzzing_clang() {
  if fuzzing_clang >/dev/null; then return; fi
  install_if_possible clang-19 libclang-rt-19-dev
  if fuzzing_clang >/dev/null; then return; fi
  say "fuzz needs clang++ with libFuzzer, from version 19 on"
  exit 1
}

fuzz_targets() { basename -s .cpp "$root"/tests/fuzz/targets/*.cpp; }

configure_fuzzers() {
  if [ -f "$root/build/fuzz/build.ninja" ]; then return; fi
  install_missing
  install_fuzzing_clang
  say "configuring in build/fuzz"
  (cd "$root" && cmake --preset fuzz -DCMAKE_CXX_COMPILER="$(fuzzing_clang)") >&2
}

# Frames of lavapipe take more memory. Of damaged files HDF5 asks for memory of any size and takes the answer that there is
# none.
options_of_fuzz_target() {
  case $1 in
  setups) echo -rss_limit_mb=6144 -timeout=300 -report_slow_units=300 ;;
  library) echo -rss_limit_mb=2048 -timeout=10 ;;
  hdf5 | array) echo -rss_limit_mb=1024 -malloc_limit_mb=1000000 -timeout=5 ;;
  *) echo -rss_limit_mb=1024 -timeout=5 ;;
  esac
}

# Lavapipe's compiler and, of damaged files, HDF5 free not all that they have. Without long stacks of allocations, and stacks
# that are looked at after a function's return, twice as much is executed in the same time.
sanitizer_options_of_fuzz_target() {
  local options=quarantine_size_mb=16:allocator_may_return_null=1:malloc_context_size=1:detect_stack_use_after_return=0
  case $1 in
  setups | hdf5 | array) options+=:detect_leaks=0 ;;
  esac
  echo "$options"
}

# One line of what libFuzzer wrote to the file $2 of target $1.
fuzz_summary() {
  awk -v target="$1" '
    / cov: / { for (i = 1; i < NF; ++i) if ($i == "cov:") cov = $(i + 1) }
    /stat::number_of_executed_units/ { runs = $2 }
    /stat::average_exec_per_sec/ { rate = $2 }
    END { printf "%-14s %12d executions %8d/s   cov %6d\n", target, runs, rate, cov }' "$2"
}

# Target $1 for $2 seconds, from the repository's inputs and those that earlier runs have found.
fuzz_one() {
  local folder=$root/build/fuzz dictionary=$root/tests/fuzz/dictionaries/$1.dict status=0 arguments=()
  local program=$folder/tests/fuzz/fuzz_$1 log=$folder/logs/$1.log files options
  mkdir -p "$folder/corpus/$1" "$folder/found" "$folder/logs"
  [ ! -f "$dictionary" ] || arguments+=("-dict=$dictionary")
  read -r -a options <<<"$(options_of_fuzz_target "$1")"
  files=$(mktemp -d "$([ -d /dev/shm ] && echo /dev/shm || echo /tmp)/pmdsim-fuzz-XXXXXX")
  TMPDIR=$files ASAN_OPTIONS=$(sanitizer_options_of_fuzz_target "$1") UBSAN_OPTIONS=print_stacktrace=1 \
    "$program" "${options[@]}" "${arguments[@]}" -max_total_time="$2" -print_final_stats=1 -close_fd_mask=1 \
    -artifact_prefix="$folder/found/$1-" "$folder/corpus/$1" "$root/tests/fuzz/corpus/$1" >/dev/null 2>"$log" || status=$?
  rm -rf "$files"
  fuzz_summary "$1" "$log"
  if ((status == 0)); then return; fi
  sed -n '/ERROR\|runtime error\|terminate called\|what():\|in the line:\|^SUMMARY\|Test unit written/p' "$log" >&2
  say "$1 failed; all that it said is in ${log#"$PWD"/}; again with" \
    "$program $(sed -n 's/.*Test unit written to //p' "$log" | tail -n 1)"
  return 1
}

fuzz() {
  local target failed=() targets=()
  mapfile -t targets < <(fuzz_targets)
  if [ "$1" != all ]; then
    if ! printf '%s\n' "${targets[@]}" | grep -qxF -- "$1"; then
      say "no fuzz target $1; there are all, ${targets[*]}"
      exit 2
    fi
    targets=("$1")
  fi
  configure_fuzzers
  ninja -C "$root/build/fuzz" "${targets[@]/#/fuzz_}" 2>&1 | tell_of_build
  for target in "${targets[@]}"; do
    fuzz_one "$target" "$2" || failed+=("$target")
  done
  ((!${#failed[@]}))
}

# The tests of every day under the sanitizers of the preset $1; tests/sanitizers has their options.
sanitize() {
  configure "$1"
  ninja -C "$root/build/$1" all 2>&1 | tell_of_build
  if [ "$1" = thread ]; then "$root/tests/sanitizers/tbb_for_threads.sh" "$root/build/thread/tbb" >&2; fi
  ctest --test-dir "$root/build/$1" --output-on-failure --parallel 2 --timeout 7200 --label-exclude 'long|smoke'
}

command=${1:-}
[ $# -gt 0 ] && shift
case $command in
demo)
  build_target pmdsim
  demo
  ;;
run)
  build_target pmdsim
  exec "$program" "$@"
  ;;
test)
  build_target all
  case ${1:-} in
  --smoke) run_smoke_tests ;;
  --long)
    lint_long
    install_if_possible "${packages_of_long_tests[@]}"
    make_package
    make_wheel
    run_tests --label-exclude smoke
    ;;
  '') run_tests --label-exclude 'long|smoke' ;;
  *) usage ;;
  esac
  ;;
bench)
  build_target pmdsim
  exec "$program" bench "$@"
  ;;
build) build_target all ;;
package) make_package ;;
wheel) make_wheel ;;
lint)
  case ${1:-} in
  --long) lint_long ;;
  '') lint ;;
  *) usage ;;
  esac
  ;;
fuzz) fuzz "${1:-all}" "${2:-60}" ;;
sanitize)
  case ${1:-address} in
  address) sanitize sanitize ;;
  thread) sanitize thread ;;
  *) usage ;;
  esac
  ;;
*) usage ;;
esac
