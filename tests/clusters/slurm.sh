#!/usr/bin/env bash
# A cluster of Slurm's real daemons on this machine: an array of 8 tasks measures 40 frames by the script that is
# shipped. One task's program is killed, another's node is lost, a third's time is over; all begin again, and the shares
# together are the same bytes as one run. slurm.sh PROGRAM
. "$(dirname "$0")/../support/check.sh"
program=$1
nodes=4
need munged slurmctld slurmd sbatch squeue scontrol sinfo pgrep ps
[ "$(id -u)" -eq 0 ] || { say "skipped: slurmd needs root"; exit $skipped; }
here=$(hostname -s)
cluster=$scratch/cluster
export SLURM_CONF=$cluster/slurm.conf

# is_alive PID; a process that has ended and that nobody has asked for is dead.
is_alive() { [ -n "$1" ] && [ -d "/proc/$1" ] && ! grep -q '^State:[[:space:]]*Z' "/proc/$1/status" 2>/dev/null; }

# Waits some seconds for the end of the process of a pid file, and ends it if need be.
await_end() {
  local pid t
  pid=$(cat "$1" 2>/dev/null || true)
  for t in {1..50}; do
    is_alive "$pid" || return 0
    sleep 0.1
  done
  kill -9 "$pid" || true
}

# Stops every job and every process that was started, whatever state it is in, before the folder goes.
stop_cluster() {
  [ -f "$SLURM_CONF" ] || return 0
  local file t jobs
  for t in {1..50}; do
    jobs=$(squeue -h -o %A 2>/dev/null | sort -u || true)
    [ -n "$jobs" ] || break
    scancel $jobs 2>/dev/null || true
    sleep 0.1
  done
  scontrol shutdown >/dev/null 2>&1 || true
  for file in "$cluster"/ctld.pid "$cluster"/n*.pid; do [ ! -f "$file" ] || await_end "$file"; done
  kill "$(cat "$cluster/munge.pid")" 2>/dev/null || true
  await_end "$cluster/munge.pid"
}
trap 'stop_cluster; leave' EXIT

write_configuration() {
  local port=$((20000 + $$ % 10000))
  printf '%s\n' ClusterName=pmdsim "SlurmctldHost=$here" SlurmUser=root SlurmdUser=root \
    "AuthInfo=socket=$cluster/munge.socket" "SlurmctldPort=$port" "SlurmctldPidFile=$cluster/ctld.pid" \
    "SlurmdPidFile=$cluster/%n.pid" "StateSaveLocation=$cluster/state" "SlurmdSpoolDir=$cluster/spool/%n" \
    "SlurmctldLogFile=$cluster/log/ctld" "SlurmdLogFile=$cluster/log/%n" ProctrackType=proctrack/linuxproc \
    TaskPlugin=task/none JobAcctGatherType=jobacct_gather/none AccountingStorageType=accounting_storage/none \
    SwitchType=switch/none MpiDefault=none SelectType=select/cons_tres SelectTypeParameters=CR_CPU \
    SchedulerParameters=sched_interval=1,batch_sched_delay=0 ReturnToService=2 MinJobAge=3600 KillWait=2 \
    RequeueExit=137 SlurmdParameters=config_overrides \
    "NodeName=n[1-$nodes] NodeHostname=$here Port=[$((port + 1))-$((port + nodes))] CPUs=1 State=UNKNOWN" \
    'PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP' >"$SLURM_CONF"
}

start_cluster() {
  mkdir -p "$cluster"/{state,spool,log,munge}
  chmod 700 "$cluster/munge"
  head -c 1024 /dev/urandom >"$cluster/munge/key"
  chmod 400 "$cluster/munge/key"
  munged --force --key-file="$cluster/munge/key" --socket="$cluster/munge.socket" --pid-file="$cluster/munge.pid" \
    --log-file="$cluster/munge/log" --seed-file="$cluster/munge/seed" 2>/dev/null
  write_configuration
  slurmctld -f "$SLURM_CONF"
  local i t
  for ((i = 1; i <= nodes; i++)); do
    mkdir -p "$cluster/spool/n$i"
    slurmd -f "$SLURM_CONF" -N "n$i"
  done
  for t in {1..300}; do
    [ "$(sinfo -h -t idle -o %D 2>/dev/null)" = $nodes ] && return
    sleep 0.1
  done
  fail "the cluster did not start: $(sinfo 2>&1; tail -5 "$cluster/log/ctld")"
}

# The setup of the test: a moving scene, 40 frames of about 0.6 s.
write_setup() {
  cp "$source_root/scenes/moving.gltf" "$scratch"
  sed -e 's/"resolution": \[160, 120\]/"resolution": [320, 240], "samples": 6/' -e 's/45e-6, 45e-6/22.5e-6, 22.5e-6/' \
    -e 's/"count": 20}/"count": 40}/' "$source_root/scenes/motion.json" >"$scratch/setup.json"
  grep -q '"count": 40' "$scratch/setup.json" || fail 'scenes/motion.json is not as this test expects'
}

# shard N: the folder of task N. records FOLDER: how many of its frames are done.
shard() { printf '%s/out/shard_%04d' "$scratch" "$1"; }
records() { find "$1" -name '*.record.json' 2>/dev/null | wc -l; }

# Waits until task $1 has measured a frame and is at the next.
wait_for_a_frame_of() {
  local t
  for t in {1..2400}; do
    (($(records "$(shard "$1")") > 0)) && return
    sleep 0.05
  done
  fail "task $1 measured no frame within two minutes: $(squeue -r; cat "$scratch"/log.* 2>/dev/null)"
}

program_of() { pgrep -f -- "-o $(shard "$1") " || fail "the program of task $1 is not there: $(squeue -r)"; }

# Kills the program of task $1 as a node without memory would.
kill_program_of() { kill -9 "$(program_of "$1")"; }

# Signals the script of task $1, and it alone, as Slurm does shortly before its time is over.
end_time_of() { kill -USR1 "$(ps -o ppid= -p "$(program_of "$1")" | tr -d ' ')"; }

# Node failure: Slurm takes the node out, and its task begins again on another.
lose_node_of() {
  local node
  node=$(squeue -h -j "${job}_$1" -o %N)
  [ -n "$node" ] || fail "task $1 runs nowhere"
  scontrol update "nodename=$node" state=down reason=lost
}

state_of() { scontrol show job "$1" | tr ' ' '\n' | sed -n 's/^JobState=//p'; }
restarts_of() { scontrol show job "${job}_$1" | tr ' ' '\n' | sed -n 's/^Restarts=//p'; }

# Waits for all tasks; those that were requeued would wait for two minutes, and are let go at once.
wait_for_job() {
  local t waiting
  for t in {1..6000}; do
    [ -n "$(squeue -h -r -j "$job" -o %i 2>/dev/null)" ] || return 0
    for waiting in $(squeue -h -r -j "$job" -t PD -o '%i %r' | awk '$2 == "BeginTime" { print $1 }'); do
      scontrol update "jobid=$waiting" StartTime=now 2>/dev/null || true
    done
    sleep 0.1
  done
  fail "the job did not end within ten minutes: $(squeue -r)"
}

# All files but records, which have times in them.
data_of() { (cd "$1" && find . -type f ! -name '*.record.json' ! -name run.json -print0 | sort -z | xargs -0 sha256sum); }

write_setup
"$program" render "$scratch/setup.json" -o "$scratch/one" --format npy >"$scratch/log" 2>&1 || fail "$(cat "$scratch/log")"
start_cluster
export PMDSIM=$program
job=$(sbatch --parsable --array=0-7 --cpus-per-task=1 -o "$scratch/log.%a" "$source_root/host/clusters/pmdsim.sbatch" \
  "$scratch/setup.json" "$scratch/out" --format npy)
wait_for_a_frame_of 0
kill_program_of 0
wait_for_a_frame_of 1
lose_node_of 1
wait_for_a_frame_of 2
end_time_of 2
wait_for_job

for task in {0..7}; do
  expect "state of task $task" COMPLETED "$(state_of "${job}_$task")"
  expect "frames of task $task" 5 "$(records "$(shard "$task")")"
done
expect 'restarts of task 0' 1 "$(restarts_of 0)"
expect 'restarts of task 1' 1 "$(restarts_of 1)"
expect 'restarts of task 2' 1 "$(restarts_of 2)"
grep -q 'out of time, to be continued' "$scratch/log.2" || fail "task 2 says nothing of its time: $(cat "$scratch/log.2")"
"$program" merge "$scratch"/out/shard_* -o "$scratch/merged" >/dev/null
expect 'files of the merged run' "$(data_of "$scratch/one")" "$(data_of "$scratch/merged")"
expect 'leftovers' '' "$(find "$scratch/out" -name '*.partial')"
say "8 tasks on $nodes nodes of Slurm measured 40 frames, three of them begun again: the same bytes as one run"
