#!/usr/bin/env bash
# What packaging/hardening.cmake asks for is in the files that came of it, stripped or not: hardening.sh FILE..., programs
# and shared libraries. docs/install.md, "Hardening", says what each is for.
. "$(dirname "$0")/../support/check.sh"

# has WHAT PATTERN: the last listing has a line with the pattern.
has() { grep -qE -- "$2" "$scratch/listing" || fail "$file: $1: nothing like '$2'"; }
lacks() { ! grep -qE -- "$2" "$scratch/listing" || fail "$file: $1: $(grep -E -- "$2" "$scratch/listing" | head -1)"; }
list() { "$@" "$file" >"$scratch/listing"; }

check_layout() {
  list readelf -hW
  has 'no fixed address' 'Type: +DYN'
  list readelf -lW
  has 'tables that are read-only after the start (RELRO)' 'GNU_RELRO'
  has 'a stack' 'GNU_STACK'
  lacks 'a stack that is executed' 'GNU_STACK.* RWE '
  lacks 'memory that is written and executed' 'LOAD.* RWE '
  list readelf -dW
  has 'symbols bound at the start' 'FLAGS.*(BIND_NOW|NOW)'
  lacks 'text that is relocated' 'TEXTREL'
  case $file in
  *.so*) ;;
  *) has 'a program at any address (PIE)' 'FLAGS_1.*PIE' ;;
  esac
}

check_calls() {
  list readelf --dyn-syms -W
  has 'guards of the stack' ' UND __stack_chk_fail@'
  has 'calls with a known size (_FORTIFY_SOURCE)' ' UND __(mem|str|v?s?n?printf|fprintf|vfprintf|f?read|pread)[a-z0-9]*_chk@'
  has 'checked indices of the standard library' ' UND _ZSt21__glibcxx_assert_fail'
}

# Options of the compiler alone leave traces in the code and nowhere else.
check_code() {
  list objdump -d --no-show-raw-insn
  case $(uname -m) in
  x86_64)
    has 'large frames of the stack probed page by page' '\sorq? +\$0x0,(0x[0-9a-f]+)?\(%rsp(,%[a-z0-9]+,1)?\)'
    local marked
    marked=$(grep -cE '\sendbr64' "$scratch/listing")
    ((marked > 1000)) || fail "$file: only $marked places are marked for indirect jumps"
    ;;
  esac
}

need readelf objdump
for file; do
  check_layout
  check_calls
  check_code
done
say "hardened: $*"
