#!/usr/bin/env bash
# Frames a second of one machine by 1, 2 and 4 processes that share its cores, in one folder and in a folder each, as a
# table in Markdown. To be run by hand on a machine that has nothing else to do: shard_rates.sh PROGRAM [FRAMES]
. "$(dirname "$0")/../support/check.sh"
program=$(realpath "$1") frames=${2:-128}
cores=$(nproc)

# The scenes: a static one, and one that moves, both with many pixels.
write_setups() {
  cp "$source_root"/scenes/{wall_2m,moving}.gltf "$scratch"
  sed "0,/{/s//{ \"frames\": {\"rate_hz\": 10, \"count\": $frames},/" "$source_root/scenes/paper_ring.json" \
    >"$scratch/paper_ring.json"
  sed -e 's/"resolution": \[160, 120\]/"resolution": [640, 480]/' -e 's/45e-6, 45e-6/11.25e-6, 11.25e-6/' \
    -e "s/\"count\": 20}/\"count\": $frames}/" "$source_root/scenes/motion.json" >"$scratch/motion.json"
}

now_ms() { printf '%s' $((${EPOCHREALTIME/./} / 1000)); }

# measure SETUP PROCESSES FOLDERS FRAMES: milliseconds until all have ended. Each process has its share of the cores.
measure() {
  local setup=$1 processes=$2 folders=$3 i first last out begin pids=()
  rm -rf "$scratch/out"
  begin=$(now_ms)
  for ((i = 0; i < processes; i++)); do
    first=$((i * cores / processes)) last=$(((i + 1) * cores / processes - 1))
    ((last >= first)) || last=$first
    out=$scratch/out/$([ "$folders" = one ] && echo all || echo "shard_$i")
    LP_NUM_THREADS=$((last - first + 1)) taskset -c "$first-$last" "$program" render "$scratch/$setup.json" -o "$out" \
      --format npy --frames "0:$4" --shard "$i/$processes" >/dev/null 2>&1 &
    pids+=($!)
  done
  for i in "${pids[@]}"; do wait "$i" || fail "a process ended with $?"; done
  printf '%s' $(($(now_ms) - begin))
}

need taskset
write_setups
say "$(date -u +%F), $cores cores, load before $(cut -d' ' -f1 /proc/loadavg), $frames frames as NPY"
say '| setup | processes | folders | all, s | frames/s | of it before the first frame, s |'
say '|---|---|---|---|---|---|'
for setup in paper_ring motion; do
  for run in '1 one' '2 one' '2 own' '4 one' '4 own'; do
    set -- $run
    all=$(measure "$setup" "$1" "$2" "$frames")
    start=$(measure "$setup" "$1" "$2" "$1") # a frame each
    awk -v setup="$setup" -v n="$1" -v folders="$2" -v all="$all" -v start="$start" -v frames="$frames" \
      'BEGIN { printf "| %s | %d | %s | %.2f | %.1f | %.2f |\n", setup, n, folders, all / 1000, 1000 * frames / all, start / 1000 }'
  done
done
measure motion 4 own "$frames" >/dev/null
begin=$(now_ms)
"$program" merge "$scratch"/out/shard_* -o "$scratch/merged" >/dev/null
say "merging $frames frames of 4 folders: $(($(now_ms) - begin)) ms"
