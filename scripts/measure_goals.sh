#!/usr/bin/env bash
# Cost and accuracy of the automatic internal step of `si`, for ten and thirty muscles, with contacts and without, on the commands of a
# recording and under random pressures; writes the table into docs/developer/stepper.md. A few minutes; run it while the machine does nothing else.
# Usage: scripts/measure_goals.sh RECORDING.csv [BUILD_FOLDER]
#     RECORDING.csv    commands; their times are divided by sqrt(1000)
#     BUILD_FOLDER     default: build/release, with target internal_step_study
set -euo pipefail
recording="$(realpath "${1:?usage: scripts/measure_goals.sh RECORDING.csv [BUILD_FOLDER]}")"
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
program="$(realpath "${2:-$root/build/release}")/tests/bench/internal_step_study"
cd "$root"
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
document=docs/developer/stepper.md
require_section "$document" goals scripts/measure_goals.sh

# row COMMANDS MUSCLES CONTACTS [OPTION...]: the arm's automatic step, 10 ms / 12, against 0.05 ms.
row() {
  local commands="$1" muscles="$2" contacts="$3"
  shift 3
  "$program" --muscles "$muscles" --steps 0.8333333333,0.05 "$@" "physics.contacts=$contacts" |
    awk -F' *[|] *' -v head="| $commands | $muscles | $contacts |" '
      $2 ~ /^0[.]83/ { print head " " $8 " | " $3 " | " $5 " | " $7 " |"; found = 1; exit } END { exit !found }'
}

table() {
  echo '| commands | muscles | contacts | r | hand at 0.1 s mm | at 0.3 s mm | joint gap mm |'
  echo '|---|---|---|---|---|---|---|'
  for muscles in 10 30; do
    for contacts in on off; do
      row 'steps' "$muscles" "$contacts" --recording "$recording"
      row 'random' "$muscles" "$contacts"
    done
  done
}

write_section "$document" goals scripts/measure_goals.sh "$(table)"
