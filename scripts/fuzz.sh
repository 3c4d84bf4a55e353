#!/usr/bin/env bash
# Fuzzes every reader of text and files with libFuzzer, address and undefined-behaviour sanitizers, starting from tests/fuzz/corpus.
#
#     scripts/fuzz.sh [SECONDS per target = 60] [TARGET ...]
#     RUNS=1000000 scripts/fuzz.sh 0 [TARGET ...]     so many executions per target; with SECONDS above 0 whatever ends first
#
# Prints executions and time per target, and which stayed below RUNS. What breaks a target is kept in build/fuzz/found; put it into
# tests/fuzz/corpus/TARGET, where the normal tests feed it to the target from then on. Needs clang. Exit status 1 if anything was found.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
seconds=${1:-60}
shift || true
command -v clang++ >/dev/null || { say "fuzz: needs clang (apt-get install clang)"; exit 2; }
build_preset fuzz fuzz
targets=("$@")
((${#targets[@]})) || mapfile -t targets < <(ls "$root/tests/fuzz/corpus")
found=$root/build/fuzz/found
mkdir -p "$found"
# Reports of leaks and messages of libraries go to the log.
limits=(-max_total_time="$seconds" -runs="${RUNS:--1}" -timeout=10 -report_slow_units=1 -rss_limit_mb=4096 -max_len=4096)
status=0
for target in "${targets[@]}"; do
  grown=$root/build/fuzz/corpus/$target log=$root/build/fuzz/$target.log
  mkdir -p "$grown"
  result="nothing found" start=$SECONDS
  FUZZ_TARGET=$target "$root/build/fuzz/tests/fuzz/fuzz" "$grown" "$root/tests/fuzz/corpus/$target" "${limits[@]}" \
    -artifact_prefix="$found/$target-" -print_final_stats=1 -close_fd_mask=1 >/dev/null 2>"$log" || { result="FOUND, see $log" status=1; }
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  ((${executions:-0} >= ${RUNS:-0})) || result+=", short of $RUNS"
  printf '%-20s %10s executions in %6s s  %s\n' "$target" "$executions" "$((SECONDS - start))" "$result"
done
exit "$status"
