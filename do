#!/usr/bin/env bash
# All the set-up there is: ./do demo | run ARGS | test | bench [ARGS] | build | lint
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$root/build/release
program=$build/bin/pmdsim

# Debian's packages, by what needs them: the build, Vulkan at run time, the libraries, the tests, the linters.
packages=(
  g++ cmake ninja-build pkg-config
  libvulkan-dev libvulkan1 mesa-vulkan-drivers vulkan-validationlayers glslang-tools spirv-tools
  libglm-dev libeigen3-dev libembree-dev libtinygltf-dev nlohmann-json3-dev libvalijson-dev libfccp-dev libyaml-cpp-dev
  libcli11-dev libfmt-dev
  libmeshoptimizer-dev libpng-dev libturbojpeg0-dev
  libopenexr-dev libcairo2-dev fonts-dejavu-core libtbb-dev
  catch2
  clang-format clang-tidy
)

say() { printf '%s\n' "do: $*" >&2; }

usage() {
  cat >&2 <<'END'
usage: ./do COMMAND
  demo       install what is missing, build, compute the paper's figures 11 and 13
  run ARGS   run pmdsim with ARGS, e.g. ./do run deform scenes/paper_ring.json
  test       build and run all tests; prints the accuracy tables
  bench      measure the throughput of the paper's ring and how time grows; ./do bench SETUP for a setup alone
  build      install what is missing and build
  lint       check the formatting and run the static analysis
END
  exit 2
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
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  say "installing with apt: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
}

# Builds $1 (a ninja target); silent where there is nothing to do.
build_target() {
  if [ -f "$build/build.ninja" ] && ninja -C "$build" -n "$1" 2>/dev/null | grep -q 'no work to do'; then return; fi
  install_missing
  if [ ! -f "$build/build.ninja" ]; then
    say "configuring in ${build#"$PWD"/}"
    (cd "$root" && cmake --preset release) >&2
  fi
  say "building (a few minutes the first time)"
  cmake --build "$build" --target "$1" >&2
}

demo() {
  local out=$root/out/demo figure
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
  printf '%s\n' "Figure 11 of the paper is paper_ring/, figure 13 paper_half_ring/, figure 6's pattern paper_moire/."
}

# The quick ones first; then those that print accuracy tables, which are shown in full.
run_tests() {
  ctest --test-dir "$build" --output-on-failure --label-exclude table --parallel 2
  ctest --test-dir "$build" --output-on-failure --label-regex table --parallel 2
  cat "$build/Testing/Temporary/LastTest.log"
}

lint() {
  local folders=("$root/engine" "$root/host" "$root/tests") sources=()
  find "${folders[@]}" -name '*.cpp' -o -name '*.h' | xargs clang-format --dry-run -Werror
  mapfile -t sources < <(find "$root/engine" "$root/host" -name '*.cpp' | sort)
  say "clang-tidy over ${#sources[@]} files"
  printf '%s\0' "${sources[@]}" | xargs -0 -n 2 -P "$(nproc)" clang-tidy -p "$build" --quiet \
    2> >(grep -v ' warnings generated' >&2)
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
  run_tests
  ;;
bench)
  build_target pmdsim
  exec "$program" bench "$@"
  ;;
build) build_target all ;;
lint)
  build_target all
  lint
  ;;
*) usage ;;
esac
