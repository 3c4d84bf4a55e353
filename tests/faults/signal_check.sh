#!/usr/bin/env bash
# Sends SIGINT and SIGTERM at random times of a run. The run must end with 130 or 143 within a step and half a second and leave
# readable files.
# Usage: signal_check.sh [PROGRAM] [runs per signal = 20]       SEED=N chooses other instants
set -euo pipefail
root=$(dirname "$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")")
program=$(realpath "${1:-$root/build/release/musclesim}")
count=${2:-20}
RANDOM=${SEED:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
slowest_ms=0 cut=0
for signal in INT TERM; do
  expected=130
  [[ $signal == TERM ]] && expected=143
  for ((i = 0; i < count; ++i)); do
    # Without job control bash makes background jobs ignore SIGINT.
    set -m
    "$program" --simple --robot elbow --controller random --duration 1e6 --quiet --out "$signal$i" >/dev/null 2>&1 &
    set +m
    pid=$!
    for ((wait = 0; wait < 2000; ++wait)); do
      [[ -s $signal$i/run.csv ]] && break
      sleep 0.01
    done
    sleep "0.$((RANDOM % 40 + 10))"
    begin=$(date +%s%N)
    kill -"$signal" "$pid"
    status=0
    wait "$pid" || status=$?
    elapsed_ms=$((($(date +%s%N) - begin) / 1000000))
    ((elapsed_ms > slowest_ms)) && slowest_ms=$elapsed_ms
    ((status == expected)) || { echo "exit status $status instead of $expected"; exit 1; }
    grep -q '"complete": false' "$signal$i/run.json" || { echo "an interrupted run looks complete"; exit 1; }
    "$program" replay "$signal$i/run.csv" --quiet >/dev/null 2>replay_error || { cat replay_error; exit 1; }
    cut=$((cut + 1))
  done
done
echo "$cut runs interrupted by SIGINT or SIGTERM: exit status 130 or 143, recordings readable and not complete, the slowest took $slowest_ms ms"
((slowest_ms <= 510)) || { echo "slower than a step and half a second"; exit 1; }
