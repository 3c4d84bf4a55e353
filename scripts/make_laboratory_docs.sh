#!/usr/bin/env bash
# Writes docs/research/laboratory_results.md: errors of all force laws on measured muscles, coverage of the intervals, the load-frame experiment; and
# the figures docs/user/figures/fit_festo.svg and docs/user/figures/experiment_medium.svg.
# Usage: scripts/make_laboratory_docs.sh DATA [build folder]
#     DATA           folder with martens-dmsp-static/dmsp20_300.csv and psu-bpa10-isometric/static_points.csv
#     build folder   default: build/release; holds musclesim and tests/bench/fit_coverage
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
data="${1:?usage: scripts/make_laboratory_docs.sh DATA [build folder]}"
build="${2:-build/release}"
festo="$data/martens-dmsp-static/dmsp20_300.csv"
braided="$data/psu-bpa10-isometric/static_points.csv"
for file in "$festo" "$braided"; do
  [[ -e "$file" ]] || { echo "make_laboratory_docs.sh: there is no $file; nothing is changed (the measurements are not part of the project)" >&2; exit 0; }
done
for program in "$build/musclesim" "$build/tests/bench/fit_coverage"; do
  [[ -x "$program" ]] || { echo "make_laboratory_docs.sh: there is no program $program; build it first" >&2; exit 1; }
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fit() { "$build/musclesim" fit "$@" --quiet; }
table() { grep '^|'; }

{
  cat <<'TEXT'
# Results of the laboratory

<!-- Made by scripts/make_laboratory_docs.sh; do not edit. -->

[Force laws and their fits](../reference/force_law_fits.md) explains laws, error function, cross-validation and experiment.

## Measured muscles

Relative squared errors, sum((m - s)^2) / sum(m^2), of all laws. Cross-validated: inner lengths and inner pressures together. `l_max` of Eq. 1 is the longest measured length; a, b, c and l_min are fitted. No point of these sets was left out as an outlier.

### Festo DMSP-20-300

126 points of a static map, 66 of them 0 N and counted as "not above 0 N".

TEXT
  fit "$festo" --out "$work/festo" >"$work/festo.txt"
  table <"$work/festo.txt"
  cat <<'TEXT'

The constants, with 95 % intervals:

```
TEXT
  sed -n '/^braun:/,/^map:/p' "$work/festo.txt"
  cat <<'TEXT'
```

### Braided muscle, 10 mm, six cut lengths

`--columns length=l_cm --where cut_length_cm=... --censored-below 0`: only forces above 0 N are compared, because the sensor is clipped at -8.74 N and its zero is uncertain.
TEXT
  for cut in 10 15 20 25 30 40; do
    printf '\nCut length %s cm:\n\n' "$cut"
    fit "$braided" --columns length=l_cm --where "cut_length_cm=$cut" --censored-below 0 --out "$work/cut$cut" | table
  done
  cat <<'TEXT'

## Coverage of the 95 % intervals

Points of Eq. 1 with the paper's constants and noise, fitted 1000 times each.

TEXT
  "$build/tests/bench/fit_coverage" 1000
  cat <<'TEXT'

## The load frame

Relative squared error of the force between the simulated rig and the law F(p, l) that drives it, at the pressures and lengths where the rig came to rest.

TEXT
  "$build/musclesim" experiment --out "$work/experiment" --quiet | table
} >"$work/results.md"
mkdir -p docs/user/figures
cp "$work/festo/sarosi.svg" docs/user/figures/fit_festo.svg
cp "$work/experiment/medium.svg" docs/user/figures/experiment_medium.svg
cp "$work/results.md" docs/research/laboratory_results.md
chmod 644 docs/research/laboratory_results.md docs/user/figures/fit_festo.svg docs/user/figures/experiment_medium.svg
echo "docs/research/laboratory_results.md and two figures"
