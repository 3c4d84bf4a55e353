#!/usr/bin/env bash
# Speed at a glance, under 3 minutes on a quiet machine: the chain stepper against dWorldStep on the commands of a run (step_speed), and
# musclesim against the other engines that were installed when it was built (musclesim bench --peers), with ten muscles.
# Usage: scripts/bench.sh [BUILD_FOLDER]      default: build/release, with targets musclesim and step_speed
# All that docs/reference/performance.md shows is written by
#     musclesim bench --out docs/reference; musclesim bench --peers --out docs/reference
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
build=$(realpath "${1:-$root/build/release}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$build/musclesim" --simple --quiet --physics original --controller random --decision-interval 6 --duration 30 --out "$work/run" >"$work/out"
"$build/tests/bench/step_speed" --time-limit 8 "$work/run/run.csv"
"$build/musclesim" bench --peers --muscles 10 --time-limit 5 --quiet --out "$work/bench"
