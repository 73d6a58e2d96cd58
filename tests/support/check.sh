# What scripts that test share: a scratch folder that goes when the script ends, however it ends, and checks.
set -euo pipefail
source_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
skipped=77 # CTest's SKIP_RETURN_CODE
scratch=$(mktemp -d "${TMPDIR:-/tmp}/pmdsim_test.XXXXXX")
leave() { rm -rf --one-file-system "$scratch"; }
trap leave EXIT
trap 'exit 129' HUP INT TERM

say() { printf '%s\n' "$*"; }
fail() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# need PROGRAM...: skips the test where one is not installed.
need() {
  local program
  for program in "$@"; do
    if ! command -v "$program" >/dev/null; then
      say "skipped: $program is not installed"
      exit $skipped
    fi
  done
}

# expect WHAT EXPECTED FOUND
expect() { [ "$2" = "$3" ] || fail "$1: expected '$2', found '$3'"; }
