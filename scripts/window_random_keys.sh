#!/usr/bin/env bash
# Sends random keys and mouse events to the window of a run and says what is left of it.
# Usage: scripts/window_random_keys.sh [--seed N] [--minutes M] [--program FILE] [ARGUMENT...]
#   --seed N        which events (default: 1)
#   --minutes M     for how long, may be a fraction (default: 30)
#   --program FILE  default: build/asan/musclesim, so that the address sanitizer looks on
#   ARGUMENT...     of the program, for example --robot elbow
# Prints the number of events, the exit status, what the sanitizers found and whether every recording is complete; exits 1 unless all is
# well. Exit status 4 of the program (a run diverged, perhaps because it was pulled at) is well, too. Needs Xvfb and xdotool.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seed=1 minutes=30 program=build/asan/musclesim
while [[ $# -gt 0 ]]; do
  case "$1" in
    --seed) seed="$2"; shift 2 ;;
    --minutes) minutes="$2"; shift 2 ;;
    --program) program="$2"; shift 2 ;;
    *) break ;;
  esac
done
[[ -x "$program" ]] || { echo "window_random_keys.sh: there is no program $program; build it first" >&2; exit 1; }
program=$(realpath "$program")
suppressions="$PWD/scripts/window_leaks.txt"
for tool in Xvfb xdotool; do
  command -v "$tool" >/dev/null || { echo "window_random_keys.sh: $tool is not installed" >&2; exit 77; }  # a skipped test
done

width=1024 height=768
work=$(mktemp -d)
mkfifo "$work/number"
Xvfb -displayfd 3 -screen 0 "${width}x${height}x24" -noreset -nolisten tcp 3>"$work/number" 2>/dev/null &
server=$!
child=
trap 'kill "${child:-}" 2>/dev/null || true; kill "$server" || true; rm -rf "$work"' EXIT
read -r number <"$work/number"
export DISPLAY=":$number"
cp -r robots "$work/robots"  # the panel offers its files
cd "$work"
export ASAN_OPTIONS=detect_leaks=1 LSAN_OPTIONS="suppressions=$suppressions:print_suppressions=0" UBSAN_OPTIONS=print_stacktrace=1
"$program" --out run --window-log log.jsonl --quiet --picture-size "${width}x${height}" "$@" >out.txt 2>&1 &
child=$!
until [[ -s log.jsonl ]]; do
  kill -0 "$child" 2>/dev/null || { cat out.txt >&2; exit 1; }
  sleep 0.1
done

# Every key of the help except those that close the window.
keys=(i p space Right bracketleft bracketright 0 1 2 3 5 9 comma period plus plus plus minus r Prior Next k k b Home Up Down c t m a f s v
  Tab Tab h h F1 x Left End)
RANDOM=$seed
between() { echo $(($1 + RANDOM % ($2 - $1 + 1))); }
place() { echo "$(between 1 $((width - 2))) $(between 1 $((height - 2)))"; }
# event: the words of xdotool for one random event.
event() {
  case $((RANDOM % 10)) in
    0) echo "mousemove $(place) click 1" ;;
    1) echo "mousemove $(place) mousedown 1 mousemove $(place) mousemove $(place) mouseup 1" ;;
    2) echo "mousemove $(place) keydown ctrl mousedown 1 mousemove $(place) sleep 0.1 mousemove $(place) mouseup 1 keyup ctrl" ;;
    3) echo "mousemove $(place) click $(between 4 5)" ;;
    4) echo "mousemove $(place) mousedown 3 mousemove $(place) mouseup 3" ;;
    *) echo "key ${keys[RANDOM % ${#keys[@]}]}" ;;
  esac
}

end=$(($(date +%s) + $(awk "BEGIN { print int(60 * $minutes + 0.5) }")))
events=0
while [[ $(date +%s) -lt $end ]] && kill -0 "$child" 2>/dev/null; do
  words=
  for _ in 1 2 3 4 5; do words+=" $(event) sleep 0.1"; done
  # shellcheck disable=SC2086
  xdotool $words >/dev/null 2>&1 || true
  events=$((events + 5))
done
# A number that is being typed in the panel takes the first q. Several: a picture may take long under a sanitizer.
for _ in $(seq 120); do
  kill -0 "$child" 2>/dev/null || break
  xdotool mousemove 5 5 key Escape sleep 0.2 key q sleep 0.8 >/dev/null 2>&1 || true
done
status=124
kill -0 "$child" 2>/dev/null || { status=0; wait "$child" || status=$?; }

runs=$(find run -name "run*.json" | wc -l)
incomplete=$(grep -L '"complete": *true' run/run*.json | wc -l)
diverged=$(grep -l '"status": *"diverged"' run/run*.json | wc -l || true)
found=$(grep -c -E 'ERROR: (Address|Leak)Sanitizer|runtime error:' out.txt || true)
leaks=$(grep -c -E '^(Direct|Indirect) leak of' out.txt || true)
echo "seed $seed: $events events in $minutes minutes, exit status $status, $found reports of sanitizers ($leaks leaks), $runs recordings, $incomplete of them not complete ($diverged of them of runs that diverged)"
if [[ "$found" -gt 0 || ( "$status" -ne 0 && "$status" -ne 4 ) || "$incomplete" -ne "$diverged" || "$runs" -eq 0 ]]; then
  tail -n 200 out.txt >&2
  exit 1
fi
