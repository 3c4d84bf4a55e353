#!/usr/bin/env bash
# Measures what the constants of `si` do to the arm's motion, and writes the table into docs/reference/parameters.md.
# Usage: scripts/measure_si_constants.sh RECORDING.csv [internal_step_study]
# RECORDING.csv: commands, their times are divided by sqrt(1000); the program's default is build/release/tests/bench/internal_step_study.
set -euo pipefail
recording="$(realpath "${1:?usage: scripts/measure_si_constants.sh RECORDING.csv [internal_step_study]}")"
program="$(realpath "${2:-$(dirname "${BASH_SOURCE[0]}")/../build/release/tests/bench/internal_step_study}")"
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
cd "$root"
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
document=docs/reference/parameters.md
require_section "$document" constants scripts/measure_si_constants.sh

# A row "description | distances | gap": the first internal step in ms against a run of its own with 0.05 ms.
row() {
  local description="$1" step_ms="$2"
  shift 2
  "$program" --recording "$recording" --steps "$step_ms,0.05" "$@" | awk -F' *[|] *' -v text="$description" '
    $2 ~ /^[0-9.]+$/ { print "| " text " | " $3 " | " $5 " | " $6 " | " $7 " |"; found = 1; exit } END { exit !found }'
}

stops() {
  echo "physics.slider_stop_compliance_mm_per_N=$1 physics.hinge_stop_compliance_rad_per_Nm=$2 physics.stop_time_constant_s=$3"
}
contacts() {
  echo "physics.contact_compliance_mm_per_N=$1 physics.contact_time_constant_s=$2"
}

# Compliance 0: as ODE has it, from error reduction and softness of the joints.
table() {
  local rate=physics.error_reduction_rate_per_s bare
  bare="physics.contacts=off $(stops 0 0 0.002)"
  echo '| varied; internal step 1 ms | at 0.1 s mm | at 0.3 s mm | largest until 0.3 s mm | joint gap mm |'
  echo '|---|---|---|---|---|'
  # Words are meant to be split.
  # shellcheck disable=SC2086,SC2046
  {
    row 'no contacts, stops as in ODE, error reduction 100/s' 1 $bare $rate=100
    for value in 250 500 1000; do row "the same, $value/s" 1 $bare $rate=$value; done
    row '500/s, stops 1e-5 mm/N, 1e-3 rad/(N m), 2 ms' 1 physics.contacts=off $(stops 1e-5 1e-3 0.002)
    row '500/s, stops 1e-3 mm/N, 0.1 rad/(N m), 2 ms' 1 physics.contacts=off $(stops 1e-3 0.1 0.002)
    row 'with contacts, rigid, 500/s, stops 10 ms' 1 $(contacts 0 0.002) $(stops 1e-4 0.03 0.01)
    row 'the same, internal step 0.5 ms' 0.5 $(contacts 0 0.002) $(stops 1e-4 0.03 0.01)
    row 'contacts 0.01 mm/N, 10 ms' 1 $(contacts 0.01 0.01)
    row 'contacts 0.1 mm/N, 10 ms' 1 $(contacts 0.1 0.01)
    row 'contacts 0.3 mm/N, 2 ms; stops 1e-4 mm/N, 0.03 rad/(N m), 2 ms (the defaults)' 1
    row 'contacts 1 mm/N, 2 ms' 1 $(contacts 1 0.002)
    row 'the defaults without the inertia that beads gain' 1 physics.geometric_inertia_ratio=0
    row 'the defaults with twice of it' 1 physics.geometric_inertia_ratio=0.5
  }
}

write_section "$document" constants scripts/measure_si_constants.sh "$(table)"
