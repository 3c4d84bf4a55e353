#!/usr/bin/env bash
# How the cost of a step grows with the number of muscles: counts instructions of the arm's steps in `si` with callgrind, whose counts do not
# depend on what else the machine does, and writes the table into docs/developer/stepper.md. Needs valgrind; some minutes.
# Usage: scripts/measure_growth.sh [BUILD_FOLDER]      default: build/release
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
cd "$root"
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
program="${1:-build/release}/musclesim"
document=docs/developer/stepper.md
require_section "$document" growth scripts/measure_growth.sh
command -v valgrind >/dev/null || { echo "measure_growth.sh: there is no valgrind" >&2; exit 1; }
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

duration_s=0.4
muscle_counts=(10 15 20 25 30)

# Millions of instructions per simulated second of an arm with so many muscles; further words are options.
instructions() {
  local muscles="$1"
  shift
  valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='musclesim::Simulation::step()*' "$program" --simple --quiet \
    --physics si --initial-state built --controller random --decision-interval 0.25 --duration "$duration_s" --muscles "$muscles" \
    --out "$work/run" "$@" 2>&1 | awk -v duration_s="$duration_s" '/Collected :/ { printf "%.0f\n", $NF / 1e6 / duration_s }'
}

# name OPTIONS: a row, with the exponent of a power law through its points (least squares of the logarithms).
row() {
  local name="$1" values=()
  shift
  for muscles in "${muscle_counts[@]}"; do values+=("$(instructions "$muscles" "$@")"); done
  paste <(printf '%s\n' "${muscle_counts[@]}") <(printf '%s\n' "${values[@]}") | awk -v name="$name" '
    { x = log($1); y = log($2); n++; sx += x; sy += y; sxx += x * x; sxy += x * y; cells = cells " " $2 " |" }
    END { printf "| %s |%s %.2f |\n", name, cells, (n * sxy - sx * sy) / (n * sxx - sx * sx) }'
}

measured="$(
  echo "| million instructions per simulated s |$(printf ' n = %s |' "${muscle_counts[@]}") exponent |"
  echo "|---|$(printf -- '---|%.0s' "${muscle_counts[@]}")---|"
  row 'no contacts' --set physics.contacts=off
  row 'with contacts'
  row 'with contacts, viscous joints' --joint-friction viscous
)"
write_section "$document" growth scripts/measure_growth.sh "$measured"
