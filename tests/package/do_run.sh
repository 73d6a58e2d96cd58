#!/usr/bin/env bash
# What `./do run` adds to a program's output: nothing where nothing is to be built, else what ninja does. Ninja and the
# program are stand-ins, so that nothing is built.
. "$(dirname "$0")/../support/check.sh"
build=$scratch/build/release
mkdir -p "$build/bin" "$scratch/tools"
cp "$source_root/do" "$scratch/do"
printf '#!/bin/sh\necho "ran $*"\n' >"$build/bin/pmdsim"
touch "$build/build.ninja"

# stand_in STATUS LINE...: ninja prints these lines behind those that it always has, and ends with STATUS. A dry run stops
# where it would look for new files.
stand_in() {
  local status=$1
  shift
  {
    printf '#!/bin/sh\n'
    printf 'echo "ninja: Entering directory"; echo "[0/2] Re-checking globbed directories..."\n'
    printf 'case " $* " in *" -n "*) echo "[1/2] Re-running CMake..."; exit 0 ;; esac\n'
    printf 'echo "%s"\n' "$@"
    printf 'exit %s\n' "$status"
  } >"$scratch/tools/ninja"
  chmod +x "$scratch/tools/ninja" "$build/bin/pmdsim"
}

# told EXIT_CODE: what `./do run check a.json` prints on stderr; its stdout is in $scratch/output.
told() {
  local code=0
  PATH="$scratch/tools:$PATH" "$scratch/do" run check a.json >"$scratch/output" 2>"$scratch/errors" || code=$?
  expect "exit code" "$1" "$code"
  cat "$scratch/errors"
}

stand_in 0 'ninja: no work to do.'
expect "stderr where nothing is built" '' "$(told 0)"
expect "stdout" 'ran check a.json' "$(cat "$scratch/output")"

stand_in 0 '[1/1] Linking pmdsim'
expect "stderr of a build" $'do: building (a few minutes the first time)\n[1/1] Linking pmdsim' "$(told 0)"
expect "stdout" 'ran check a.json' "$(cat "$scratch/output")"

stand_in 1 'FAILED: pmdsim'
expect "stderr of a build that fails" $'do: building (a few minutes the first time)\nFAILED: pmdsim' "$(told 1)"
expect "stdout" '' "$(cat "$scratch/output")"
