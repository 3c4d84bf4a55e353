#!/usr/bin/env bash
# Draws the figures of docs/user/controlling.md: every test signal, and the position loop with and without a dead time. Prints the loop's
# numbers.
# Usage: scripts/make_signal_docs.sh [musclesim]   (the program; default: build/release/musclesim)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=$(readlink -f "${1:-build/release/musclesim}")
[[ -x "$program" ]] || { echo "make_signal_docs.sh: there is no program $program; build it first or name it" >&2; exit 1; }
figures=$PWD/docs/user/figures
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"

for signal in steps ramp triangle sine chirp prbs multisine staircase reversals; do
  "$program" schedule "$signal" --robot rig -o "$signal.csv" --duration 20 --quiet
  "$program" figure "$signal.csv" --signals command_0 --title "$signal" -o "$figures/signal_$signal.svg"
done

track() { # NAME [option ...]: the elbow on a sine of 20 degrees and 0.5 Hz
  local name=$1
  shift
  "$program" --simple --robot elbow --controller position --set position.amplitude_elbow_deg=20 --set position.period_s=2 --duration 10 \
    --record "$name.csv" --json --quiet "$@" | tail -n 1 | python3 -c "
import json, sys
error = json.load(sys.stdin)['tracking']['elbow']
print(f'$name: largest error {error[\"largest_deg\"]:.2f} degrees, RMS {error[\"rmse_deg\"]:.2f} degrees, from {error[\"from_s\"]:g} s on')"
  "$program" figure "$name.csv" --signals 'target_elbow_deg,angle_elbow_deg,command_*' --title "${name//_/ }" -o "$figures/$name.svg"
}
track position_loop
effect() { echo "{\"format\": \"musclesim-effects-1\", \"effects\": [{\"id\": \"transport_delay\", \"component\": \"all\", \"parameters\": {\"delay_s\": $1}}]}"; }
for delay_s in 0.005 0.01 0.02; do
  effect "$delay_s" >late.json
  figures=$work track "delay_of_${delay_s}_s" --effects late.json
done
effect 0.1 >late.json
track position_loop_with_dead_time --effects late.json
