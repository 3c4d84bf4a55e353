#!/usr/bin/env bash
# Writes docs/research/imported_files.md: what `musclesim import` and `fit` make of the files of other laboratories, and of small inputs after
# public reports of failures.
# Usage: scripts/make_import_docs.sh DATA [build folder]
#     DATA           folder with real/ and field/; they are not part of the project
#     build folder   default: build/release
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
data="${1:?usage: scripts/make_import_docs.sh DATA [build folder]}"
program="$PWD/${2:-build/release}/musclesim"
[[ -d "$data/real" && -d "$data/field" ]] ||
  { echo "make_import_docs.sh: there are no $data/real and $data/field; nothing is changed (the data are not part of the project)" >&2; exit 0; }
[[ -x "$program" ]] || { echo "make_import_docs.sh: there is no program $program; build it first" >&2; exit 1; }
data=$(realpath "$data")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Messages and results without folders, and without what would end a cell of the table.
clean() { sed -e "s#$data/[a-z]*/##g; s#$PWD/##g; s#$work/##g; s#docs/examples/import/##g; s#tests/log/mappings/##g; s/|/\\\\|/g"; }

# import_row FILE MAPPING KIND: imports, or shows the refusal.
import_row() {
  local file="$1" mapping="$2" kind="$3" result notes shown
  if result=$("$program" import "$data/$file" "$mapping" "$work/out.csv" --overwrite 2>"$work/messages"); then
    notes=$(wc -l <"$work/messages")
    result="${result#*: } (notes: $notes)"
  else
    result="refused: $(tail -n 1 "$work/messages" | sed 's/^musclesim: *\(error: *\)*//')"
  fi
  case "$mapping" in
    "$data"*) shown="\`$(basename "$mapping")\` beside it" ;;
    docs/*) shown="[$(basename "$mapping")](../examples/import/$(basename "$mapping"))" ;;
    *) shown="[$(basename "$mapping")](../../$mapping)" ;;
  esac
  printf '| `%s` | %s | %s | %s |\n' "${file#*/}" "$kind" "$shown" "$(clean <<<"$result")"
}
real() { import_row "real/$1" "docs/examples/import/$2.toml" "$3"; }
as_written() { import_row "field/$1" "$data/field/$2" "$3"; }
field() { import_row "field/$1" "tests/log/mappings/$2.toml" "$3"; }

# fit_row FILE KIND [options]: the law to take.
fit_row() {
  local file="$1" kind="$2" result
  shift 2
  if "$program" fit "$file" --out "$work/fit" --quiet "$@" >"$work/messages" 2>&1; then
    result=$(sed -n 's/^take *//p' "$work/messages")$(sed -n '/pushes/ { s/^ *warning: */; /p; q }' "$work/messages")
  else
    result="refused: $(tail -n 1 "$work/messages")"
  fi
  printf '| `%s` | %s | `fit%s` | %s |\n' "$(clean <<<"$file")" "$kind" "${*:+ $*}" "$(clean <<<"$result")"
}

# replay_row FILE KIND: a recording needs no mapping.
replay_row() {
  local file="$1" result
  if "$program" replay "$data/real/$file" --quiet >"$work/messages" 2>&1; then
    result="read as it is, $(($(wc -l <"$data/real/$file") - 1)) rows"
  else
    result="refused: $(tail -n 1 "$work/messages")"
  fi
  printf '| `%s` | %s | none | %s |\n' "$file" "$2" "$(clean <<<"$result")"
}

vented_law() {
  echo "pressure_kPa,length_mm,force_N"
  awk 'BEGIN { for (p = 300; p <= 600; p += 100) for (l = 200; l <= 270; l += 10) {
    f = p / 600 * (800 * (l / 270) ^ 2 - 360) - 30; if (f > 0) printf "%d,%d,%.2f\n", p, l, f } }'
}

real_rows() {
  for number in 7 9 11; do real "bellows/1606${number}V.txt" bellows "semicolons, no header, absolute hPa, pulse widths"; done
  for number in 7 9 11; do replay_row "bellows/rec_$number.csv" "recording"; done
  for load in 100 200 300 400 400_long 500; do replay_row "cavatappi/rec_$load.csv" "recording"; done
  fit_row "$data/real/cavatappi/static.csv" "18 of 26 points at one pressure"
  fit_row "$data/real/martens-dmsp-static/dmsp20_300.csv" "static map, slack points as 0 N"
  real porcaro-drum-arm/raw_step_response.csv wrist_step "two muscles, MPa"
  real porcaro-drum-arm/raw_step_response.csv wrist_release "another part of the same file"
  real porcaro-drum-arm/raw_sweep_0_2s.csv wrist_sweep_start "the same columns"
  real porcaro-drum-arm/fig1a_hysteresis_real.csv wrist_loop "no clock: rows of settled steps"
  real porcaro-drum-arm/fig1b_step_real.csv wrist_step_repeat "angle only; commands from another file"
  real porcaro-drum-arm/fig1c_sweep_real.csv wrist_sweep "commands from a second table, drawn lines"
  real porcaro-drum-arm/fig1c_sweep_command.csv sweep_command "commands without readings"
  real porcaro-drum-arm/authors_sim_vs_real_wrist_rmse.csv wrist_step "no measurement over time"
  for number in 1 4; do real "psu-bpa-fill-leak/fill_$number.csv" fill "pressure only"; done
  for number in 1 4; do real "psu-bpa-fill-leak/leak_$number.csv" leak "counts of a converter; the clock begins again"; done
  real psu-bpa10-isometric/raw_L20cm_l174.5mm_test10.csv isometric "clipped force, clock of 1 ms"
  real psu-bpa10-isometric/raw_L20cm_l182.0mm_test8.csv isometric_rest "the same at another length"
  fit_row "$data/real/psu-bpa10-isometric/static_points.csv" "several muscles in one table" --columns length=l_cm --where cut_length_cm=20 --censored-below 0
  real quadsegrity/Big3.csv tensile_test "units row, quoted numbers"
  real quadsegrity/Small4.csv tensile_test_thin "the same, another muscle and pressure"
  fit_row "$data/real/quadsegrity/big_static.csv" "no vented points" --rest-length 850
  fit_row "$data/real/quadsegrity/small_static.csv" "no vented points" --rest-length 815
  real zagreb-dmsp10-250/quasistatic_cycle1_0p1V.csv bench_loop "no clock, volts"
  real zagreb-dmsp10-250/step_up_0_to_4p074V_100Hz.csv bench_step "volts, a sensor with an offset"
  real zagreb-dmsp10-250/creep_down_median_profile.csv creep "shares without unit"
}

field_rows() {
  as_written 05/two_signals.csv 05/map.toml "two columns of one name"
  field 05/two_signals.csv 05_by_number "the same, columns by number"
  as_written 06/valve.csv 06/short.toml "second clock ends early"
  as_written 06/valve.csv 06/gap.toml "second clock has a gap"
  as_written 06/valve.csv 06/milliseconds.toml "second clock in ms"
  field 06/valve.csv 06_milliseconds "the same, with its factor"
  as_written 06/valve.csv 06/other_zero.toml "second clock with another zero"
  field 06/valve.csv 06_other_zero "the same, with its offset"
  as_written 06/valve.csv 06/early.toml "begin before the table"
  field 06/valve.csv 06_rest "the same, as a rest"
  as_written 07/merged.csv 07/map.toml "merged topics"
  as_written 07/merged.csv 07/even.toml "merged topics, even rows"
  as_written 08/tensile_tester.csv 08/tensile.toml "units row, quotes"
  field 08/tensile_tester.csv 08_tensile "the same, said so"
  as_written 08/oscilloscope.csv 08/scope.toml "units row, trailing commas"
  field 08/oscilloscope.csv 08_scope "the same, said so"
  as_written 08/decimal_comma.csv 08/comma.toml "semicolons, decimal commas"
  field 08/decimal_comma.csv 08_comma "the same, said so"
  as_written 08/latin1.csv 08/latin1.toml "header in Latin-1"
  field 08/latin1.csv 08_latin1 "the same, said so"
  as_written 09/no_header.csv 09/map.toml "no header"
  field 09/no_header.csv 09_no_header "the same, columns by number"
  field 09/percent_comment.csv 09_percent "comments with %"
  field 09/spaces.txt 09_spaces "blanks between cells"
  field 10/imu_logger.csv 10_imu "date and time"
  field 10/date_and_time.csv 10_date_and_time "date and time in two columns"
  as_written 10/micros_overflow.csv 10/map.toml "another file's mapping"
  field 10/micros_overflow.csv 10_overflow "a counter that begins again"
  as_written 11/cut.csv 11/map.toml "last line cut"
  fit_row "$data/field/12/weights.csv" "a small fold of the cross-validation"
  mkdir "$work/15"
  vented_law >"$work/15/points.csv"
  fit_row "$work/15/points.csv" "a muscle with a threshold: a law that pushes" --law braun
}

head_row='| file | kind | mapping | result |
|---|---|---|---|'
{
  cat <<TEXT
# Files of other laboratories

<!-- Made by scripts/make_import_docs.sh; do not edit. -->

Every file imports with a mapping alone, or is refused with the place of the fault and what helps. Notes are counted; \`musclesim import\` prints them. The tests \`RealFiles\` and \`FieldFiles\` (tests/log/measured_files_test.cpp) and \`MeasuredMuscles\` (tests/laboratory/measured_test.cpp) check the values. The measurements are not part of this project.

## Published measurements, as their authors wrote them

$head_row
TEXT
  real_rows
  cat <<TEXT

## Small inputs after public reports of failures

$head_row
TEXT
  field_rows
} >"$work/page.md"
cp "$work/page.md" docs/research/imported_files.md
chmod 644 docs/research/imported_files.md
echo "docs/research/imported_files.md"
