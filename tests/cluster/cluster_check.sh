#!/usr/bin/env bash
# Checks that sweeps under GNU parallel and under a real Slurm, disturbed on purpose, give the table of an undisturbed sweep.
#
#     tests/cluster/cluster_check.sh parallel|slurm|mpirun [PROGRAM]      default: build/release/musclesim
#
# slurm: starts munged, slurmctld and slurmd on this machine with a configuration of their own in a temporary folder, submits the batch file
# of docs/user/sweeps.md as an array of three workers, kills one worker (SIGKILL) in mid-row and lets one run crash (SIGSEGV). Needs root.
# Exit status 77, with a line that says why, if the tool is not available.
set -euo pipefail
root=$(dirname "$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")")
tool=${1:?usage: cluster_check.sh parallel|slurm|mpirun [PROGRAM]}
program=$(realpath "${2:-$root/build/release/musclesim}")
start=$SECONDS

say() { printf 'cluster_check: %s\n' "$*"; }
skip() {
  say "SKIPPED $tool: $*"
  exit 77
}
fail() {
  say "FAILED $tool: $*"
  [[ ! -d $work/log ]] || tail -n 20 "$work"/log/* || true
  exit 1
}

daemons=()
work=$(mktemp -d)
chmod 755 "$work"
clean_up() {
  local pid
  for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${daemons[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap clean_up EXIT
mkdir "$work/bin" "$work/log"
ln -s "$program" "$work/bin/musclesim"
PATH=$work/bin:$PATH
cd "$work"

cat >sweep.toml <<'TEXT'
format = "musclesim-sweep-1"
command = ["run", "--simple", "--robot", "elbow", "--controller", "random", "--duration", "4", "--seed", "{seed}", "--out", "{out}",
           "--record-interval", "0.1", "--json", "--quiet"]
seed = 5
[repeats]
count = 24
TEXT

plan_and_reference() {
  musclesim plan sweep.toml -o undisturbed >/dev/null
  cp -r undisturbed RUNS
  musclesim work undisturbed --quiet
  musclesim collect undisturbed >/dev/null || fail "the undisturbed sweep is not complete"
}

# Kills one worker in the middle of a row, and the run of another worker as if it had crashed.
disturb() {
  local found=() pid run
  for ((i = 0; i < 600; ++i)); do
    mapfile -t found < <(for pid in $(pgrep -x musclesim); do
      [[ $(readlink "/proc/$pid/cwd") == "$work" ]] && [[ -n $(pgrep -P "$pid") ]] && echo "$pid"
    done || true)
    ((${#found[@]} >= 2)) && break
    sleep 0.05
  done
  ((${#found[@]} >= 2)) || fail "no two workers were seen at work"
  # Runs are halted first, so that they are killed within a row and not after it.
  run=$(halted_run "${found[0]}")
  kill -9 "${found[0]}" "$run"
  say "killed worker ${found[0]}"
  run=$(halted_run "${found[1]}")
  kill -SEGV "$run"
  kill -CONT "$run"
  say "crashed a run of worker ${found[1]}"
}

# Halts the present run of a worker and prints its process; a run that has ended cannot be halted, though it can be signalled.
halted_run() {
  local run i
  for ((i = 0; i < 200; ++i)); do
    run=$(pgrep -P "$1" | head -n 1 || true)
    if [[ -n $run ]] && kill -STOP "$run" 2>/dev/null; then
      sleep 0.02
      [[ $(ps -o stat= -p "$run" 2>/dev/null) == T* ]] && echo "$run" && return
    fi
    sleep 0.02
  done
  fail "no run of worker $1 could be halted" >&2
}

compare() {
  musclesim collect RUNS >/dev/null || fail "the disturbed sweep is not complete"
  cmp undisturbed/collected.csv RUNS/collected.csv && cmp undisturbed/collected.json RUNS/collected.json || fail "the tables differ"
  local repeated
  repeated=$(grep -l '"attempts": [2-9]' RUNS/results/*.json | wc -l)
  ((repeated >= 2)) || fail "only $repeated rows were repeated: the disturbance was none"
  say "passed $tool: same tables, $repeated rows repeated, $((SECONDS - start)) s"
}

with_processes() {
  "$@" >"$work/log/launcher" 2>&1 &
  local launcher=$!
  disturb
  wait "$launcher" || true  # one worker was killed, and the launcher says so
  compare
}

start_slurm() {
  local host
  host=$(hostname -s)
  mkdir -p "$work/etc" "$work/munge" "$work/state" "$work/spool"
  chmod 700 "$work/munge"
  (umask 077 && dd if=/dev/urandom of="$work/munge/key" bs=128 count=1 status=none)
  chmod 711 "$work/munge"
  munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
    --log-file="$work/log/munged" --seed-file="$work/munge/seed" >"$work/log/munged.out" 2>&1 &
  daemons+=($!)
  cat >"$work/etc/slurm.conf" <<TEXT
ClusterName=musclesim
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
SlurmctldPort=$((20000 + $$ % 10000))
SlurmdPort=$((30000 + $$ % 10000))
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/etc/slurmctld.pid
SlurmdPidFile=$work/etc/slurmd.pid
SlurmctldLogFile=$work/log/slurmctld
SlurmdLogFile=$work/log/slurmd
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
SchedulerParameters=sched_interval=2,sched_min_interval=100000
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
TEXT
  export SLURM_CONF=$work/etc/slurm.conf
  local i
  for ((i = 0; i < 50; ++i)); do
    [[ -S $work/munge/socket ]] && break
    sleep 0.1
  done
  slurmctld -D >"$work/log/slurmctld.out" 2>&1 &
  daemons+=($!)
  slurmd -D -N "$host" >"$work/log/slurmd.out" 2>&1 &
  daemons+=($!)
  for ((i = 0; i < 300; ++i)); do
    [[ $(sinfo -h -o %t 2>/dev/null) == idle ]] && return
    sleep 0.1
  done
  fail "Slurm's node does not become idle: $(sinfo 2>&1)"
}

under_slurm() {
  start_slurm
  say "Slurm runs after $((SECONDS - start)) s: $(sinfo -h -o '%P %D node, %c processors, %t')"
  # The batch file from the documentation.
  awk '/^```/ { inside = !inside; text = ""; next } inside { text = text $0 "\n" } inside && /^musclesim work RUNS --time-limit/ { printf "%s", text }' \
    "$root/docs/user/sweeps.md" >workers.sh
  grep -q '^#SBATCH --array' workers.sh || fail "docs/user/sweeps.md has no batch file"
  local job state
  job=$(sbatch --parsable --array=1-3 --time=00:02:00 --output="$work/log/worker-%a" workers.sh)
  sbatch --parsable --dependency="afterany:$job" --output="$work/log/collect" --wrap "musclesim collect RUNS" >/dev/null
  disturb
  for ((i = 0; i < 1500; ++i)); do
    state=$(squeue -h -o %T)
    [[ -z $state ]] && break
    sleep 0.1
  done
  [[ -z $state ]] || fail "jobs do not end: $state"
  grep -q 'done     24' "$work/log/collect" || fail "the dependent job has not collected: $(cat "$work/log/collect")"
  compare
}

case $tool in
  parallel)
    command -v parallel >/dev/null || skip "there is no GNU parallel (apt-get install parallel)"
    plan_and_reference
    with_processes sh -c 'seq 3 | parallel -n0 -j3 musclesim work RUNS'
    ;;
  mpirun)
    command -v mpirun >/dev/null || skip "there is no mpirun (apt-get install openmpi-bin)"
    plan_and_reference
    with_processes mpirun --allow-run-as-root --oversubscribe -n 3 musclesim work RUNS
    ;;
  slurm)
    for needed in munged slurmctld slurmd sbatch; do
      command -v "$needed" >/dev/null || skip "there is no $needed (apt-get install slurm-wlm munge)"
    done
    ((EUID == 0)) || skip "slurmd must be started by root"
    plan_and_reference
    under_slurm
    ;;
  *) fail "unknown tool" ;;
esac
