#!/bin/sh
# Makes manual pages and completions by the program itself: manual.sh PROGRAM FOLDER, which is made anew and then holds
# what belongs below share/.
set -eu
program=$1 folder=$2
rm -rf "$folder"
mkdir -p "$folder/man/man1" "$folder/bash-completion/completions" "$folder/zsh/vendor-completions" \
  "$folder/fish/vendor_completions.d"
"$program" manual bash >"$folder/bash-completion/completions/pmdsim"
"$program" manual zsh >"$folder/zsh/vendor-completions/_pmdsim"
"$program" manual fish >"$folder/fish/vendor_completions.d/pmdsim.fish"
"$program" manual man >"$folder/man/man1/pmdsim.1"
for command in $("$program" manual commands); do
  "$program" manual man "$command" >"$folder/man/man1/pmdsim-$command.1"
done
gzip -9n "$folder"/man/man1/*.1
