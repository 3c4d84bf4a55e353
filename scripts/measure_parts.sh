#!/usr/bin/env bash
# Where a step's time goes: samples a running simulation with perf, times the parts with google-benchmark, and writes both tables into
# docs/developer/stepper.md.
# Usage: scripts/measure_parts.sh [BUILD_FOLDER]      default: build/release, with targets robustness_study and parts_benchmark
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
cd "$root"
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
programs="${1:-build/release}/tests/bench"
document=docs/developer/stepper.md
require_section "$document" parts scripts/measure_parts.sh
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# "share part" of an arm with so many muscles; further words are parameters.
shares() {
  local muscles="$1" steps="$2"
  shift 2
  perf record -q -F 2000 -o "$work/data" "$programs/robustness_study" --seeds 1 --muscles "$muscles" --steps "$steps" "$@" >/dev/null 2>&1
  perf report -i "$work/data" --stdio -g none --sort dso,symbol 2>/dev/null | awk '
    /^ *[0-9.]+%/ {
      share = $1 + 0
      if (/ChainBundle/) part = "chains"
      else if (/Tile|solveLower|solveUpper|subtractProduct|subtractTransposed|SkeletonCore|CoreOrder|solveSixRows|subtractCombination|addProduct/) part = "core: solve"
      else if (/addChain|addContact|addShared|addSkeleton|addBones|throughBead|numberRows|chooseBand|findStiff|assembleCore/) part = "core: assembly"
      else if (/makeRows|Rows\(|planeAcross|turnOf|axisVelocity|setAxisRow|hingeAngle|atan2|readLimits|ContactSet/) part = "rows"
      else if (/BodyState|dBody|dGeomMoved|dRfromQ|dxSafeNormalize|gapOf/) part = "bodies: read, move, write"
      else if (/libode|Contacts::/) part = "collision"
      else if (/BoxActiveSet|giveForces|takeStates|collectRow|setUpBorders|setUpContactBorder/) part = "bounded rows"
      else if (/Actuator|ForceLaw|exp|tanh|Effect/) part = "forces"
      else part = "everything else"
      sum[part] += share
    }
    END { for (part in sum) printf "%s\t%.0f\n", part, sum[part] }'
}

profile() {
  shares 10 6000 physics.contacts=off >"$work/1"
  shares 10 4000 >"$work/2"
  shares 30 2000 physics.contacts=off >"$work/3"
  shares 30 1000 >"$work/4"
  echo '| share of CPU time in % | n = 10, no contacts | n = 10 | n = 30, no contacts | n = 30 |'
  echo '|---|---|---|---|---|'
  awk -F'\t' 'FNR == 1 { file++ } { value[$1, file] = $2; total[$1] += $2 }
    END {
      for (part in total) {
        line = total[part] "\t| " part " |"
        for (f = 1; f <= 4; ++f) line = line " " (value[part, f] == "" ? 0 : value[part, f]) " |"
        print line
      }
    }' "$work"/[1-4] | sort -rn | cut -f 2
}

benchmarks() {
  echo '| part | argument | CPU time us |'
  echo '|---|---|---|'
  "$programs/parts_benchmark" --benchmark_format=csv --benchmark_min_time=0.2 2>/dev/null | awk -F, '
    /^"/ {
      name = $1; gsub(/"/, "", name)
      argument = name; sub(/.*\//, "", argument); sub(/\/[^\/]*$/, "", name)
      printf "| %s | %s | %.2f |\n", name, argument, $4 * ($5 == "ns" ? 1e-3 : 1)
    }'
}

measured="$(profile; echo; benchmarks)"
write_section "$document" parts scripts/measure_parts.sh "$measured"
