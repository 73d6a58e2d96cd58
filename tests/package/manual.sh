#!/usr/bin/env bash
# Manual pages and completions as they are installed: manual.sh FOLDER, the build's packaging/manual. groff renders the
# pages without a warning, bash completes, and zsh and fish, where they are installed, read their scripts.
. "$(dirname "$0")/../support/check.sh"
folder=$1

check_pages() {
  local page count=0
  for page in "$folder"/man/man1/*.1.gz; do
    zcat "$page" >"$scratch/page"
    expect "warnings of $page" '' "$(groff -ww -man -z "$scratch/page" 2>&1)"
    LC_ALL=C.UTF-8 man --warnings -E UTF-8 -l "$scratch/page" >"$scratch/text" 2>"$scratch/errors"
    expect "man on $page" '' "$(cat "$scratch/errors")"
    grep -q '^NAME' "$scratch/text" || fail "$page has no NAME"
    count=$((count + 1))
  done
  ((count >= 9)) || fail "expected 9 pages and more, found $count"
}

# complete_in_bash WORD...: what bash offers for the last word, sorted, in one line.
complete_in_bash() {
  bash -c '
    source "$1"
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    _pmdsim
    printf "%s\n" "${COMPREPLY[@]}" | sort | tr "\n" " "' bash "$folder/bash-completion/completions/pmdsim" "$@"
}

check_bash() {
  expect 'a command' 'render ' "$(complete_in_bash pmdsim ren)"
  expect 'an option' '--max-amplitude-error --max-error --max-memory ' "$(complete_in_bash pmdsim render room.json --max)"
  expect 'a value' 'exact ' "$(complete_in_bash pmdsim render --mode ex)"
  expect 'a value behind =' 'fp32 fp64 ' "$(complete_in_bash pmdsim bench --precision = fp)"
  expect 'a list' 'exr,npy ' "$(complete_in_bash pmdsim render --format exr,npy)"
  expect 'a list behind =' 'exr,png ' "$(complete_in_bash pmdsim render --format = exr,pn)"
  expect 'a kind' 'star step ' "$(complete_in_bash pmdsim new st)"
  expect 'a channel in a list' 'lit,multipath_error_m lit,multipath_m ' "$(complete_in_bash pmdsim render --channels lit,multip)"
  expect 'a key' 'focal_length_m ' "$(complete_in_bash pmdsim explain focal)"
  expect 'a file' ' ' "$(complete_in_bash pmdsim render ro)"
  expect 'the hidden command' ' ' "$(complete_in_bash pmdsim manu)"
}

check_zsh() {
  command -v zsh >/dev/null || return 0
  zsh -n "$folder/zsh/vendor-completions/_pmdsim"
}

check_fish() {
  command -v fish >/dev/null || return 0
  local script=$folder/fish/vendor_completions.d/pmdsim.fish
  expect "fish's commands" 'render' \
    "$(HOME=$scratch fish --no-config -c "source $script; complete -C 'pmdsim ren'" | cut -f1)"
  expect "fish's values" 'exact' \
    "$(HOME=$scratch fish --no-config -c "source $script; complete -C 'pmdsim render --mode ex'" | cut -f1)"
}

need groff man
check_pages
check_bash
check_zsh
check_fish
say "manual pages and completions of bash$(command -v zsh >/dev/null && printf ', zsh')$(command -v fish >/dev/null && printf ', fish') are well"
