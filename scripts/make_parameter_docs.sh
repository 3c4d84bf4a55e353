#!/usr/bin/env bash
# Writes the tables of all named parameters into docs/reference/parameters.md, below its hand-written introduction, as the program prints them, and
# the defaults into the tables of docs/reference/controllers.md.
# Usage: scripts/make_parameter_docs.sh [musclesim]   (the program; default: build/release/musclesim)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program="${1:-build/release/musclesim}"
document=docs/reference/parameters.md
marker='<!-- Below this line: made by scripts/make_parameter_docs.sh; do not edit. -->'
[[ -x "$program" ]] || { echo "make_parameter_docs.sh: there is no program $program; build it first or name it" >&2; exit 1; }
grep -qxF -- "$marker" "$document" || { echo "make_parameter_docs.sh: $document has no line \"$marker\"" >&2; exit 1; }

config() { "$program" --print-config "$@"; }

# "name<TAB>default<TAB>unit<TAB>range<TAB>meaning" of every parameter of the groups named first (a regular expression), from TOML on
# standard input: group headings, and lines "key = value  # meaning; range unit; default value".
rows() {
  awk -v groups="^($1)\$" '
    /^\[/ { group = substr($0, 2, length($0) - 2); next }
    / = / && group ~ groups {
      key = $0; sub(/ = .*/, "", key)
      words = $0; sub(/^[^#]*# /, "", words)
      match(words, /; default [^;]*$/)
      value = substr(words, RSTART + 10); words = substr(words, 1, RSTART - 1)
      match(words, /; [^;]*$/)
      range = substr(words, RSTART + 2); words = substr(words, 1, RSTART - 1)
      unit = ""
      if (range ~ / \.\. /) {
        unit = range; sub(/^[^ ]+ \.\. [^ ]+ ?/, "", unit)
        if (unit != "") range = substr(range, 1, length(range) - length(unit) - 1)
      }
      gsub(/ \| /, ", ", range)
      print group "." key "\t" value "\t" unit "\t" range "\t" words
    }'
}

# A Markdown table from rows.
table() {
  echo
  echo '| parameter | default | unit | range | meaning |'
  echo '|---|---|---|---|---|'
  awk -F'\t' '{ print "| `" $1 "` | " $2 " | " $3 " | " $4 " | " $5 " |" }'
}

# The parameters of the physics settings side by side: defaults differ.
physics_table() {
  echo
  echo '| parameter | `si` | `original` | `scaled` | unit | range | meaning |'
  echo '|---|---|---|---|---|---|---|'
  awk -F'\t' '
    FNR == 1 { file++ }
    !($1 in meaning) { order[++count] = $1; meaning[$1] = $3 " | " $4 " | " $5 }
    { value[$1, file] = $2 }
    END {
      for (i = 1; i <= count; ++i) {
        name = order[i]
        line = "| `" name "` |"
        for (f = 1; f <= 3; ++f) line = line " " ((name, f) in value ? value[name, f] : "-") " |"
        print line " " meaning[name] " |"
      }
    }' <(config --physics si --robot rig --controller hold | rows physics) \
    <(config --physics original --robot rig --controller hold | rows physics) \
    <(config --physics scaled --robot rig --controller hold | rows physics)
}

section() {
  echo
  echo "## $1"
}

tables() {
  section 'Physics'
  physics_table
  echo
  echo 'With `--stepper quick`, and with `--plane`, there are in addition:'
  config --robot rig --controller hold --stepper quick --plane | rows 'physics|world' |
    grep -vxF -f <(config --robot rig --controller hold | rows physics) | table
  section 'Muscles and linear actuators'
  config --robot rig --controller hold | rows muscle | table
  section 'Force laws'
  echo
  echo 'All muscles follow the law `force_law.name`. With `braun` (Eq. 1) there are:'
  config --robot rig --controller hold | rows force_law | table
  for law in chou-hannaford sarosi map; do
    echo
    echo "With \`$law\` there are in addition to the first two:"
    config --robot rig --controller hold --set "force_law.name=$law" | rows force_law | tail -n +3 | table
  done
  section 'Robot `rig`'
  config --robot rig --controller hold | rows rig | table
  section 'Robot `elbow`'
  config --robot elbow --controller hold | rows elbow | table
  section 'Robot `wrist`'
  config --robot wrist --controller hold | rows wrist | table
  section 'Robot `pulley_arm`'
  config --robot pulley_arm --controller hold | rows pulley_arm | table
  section 'Robot `spring_bench`'
  config --robot spring_bench --controller hold | rows spring_bench | table
  section 'Robot `arm`'
  echo
  echo 'In `original` and `scaled` physics the default of `arm.composite_inertia` is `summed`.'
  config --robot arm --controller hold | rows arm | table
  section 'Sensors'
  echo
  echo 'White noise, 0 unless given; [effects.md](effects.md) has what else sensors do.'
  config --robot elbow --controller hold | rows sensor | table
  section 'Height task'
  config --robot arm --controller asm --task height | rows height_task | table
  section 'Reach task'
  echo
  echo '`aasm` uses the target only.'
  config --robot arm --controller asm --task reach | rows reach_task | table
  section 'Controller `asm`'
  config --robot arm --controller asm | rows asm | table
  section 'Controller `aasm`'
  config --robot arm --controller aasm | rows aasm | table
  section 'Controller `hold`'
  echo
  echo 'There is one `hold.pressure_<i>` for each muscle; its default is the value of `hold.pressure`.'
  config --robot rig --controller hold | rows hold | table
  local signal
  for signal in steps ramp triangle sine chirp prbs multisine staircase reversals; do
    section "Controller \`$signal\`"
    echo
    echo "There is one \`$signal.level_<i>\` for each muscle and one \`$signal.amplitude_<k>\` for each channel; their defaults are the values without number."
    config --robot rig --controller "$signal" | rows "$signal" | grep -v '_0	' | table
  done
  section 'Controller `position`'
  echo
  echo 'There is one `position.level_<i>` for each muscle. For the elbow, and with `position.quantity` = `height`:'
  config --robot elbow --controller position | rows position | grep -v '\.level_' | table
  config --robot elbow --controller position --set position.quantity=height | rows position | grep per_mm | table
  section 'Controller `random`'
  echo
  echo 'It has no parameters.'
}

new="$(mktemp "$document.XXXXXX")"
trap 'rm -f "$new"' EXIT
{
  sed "/^$(printf '%s' "$marker" | sed 's/[.[\*^$/]/\\&/g')\$/q" "$document"
  tables
} >"$new"
chmod 644 "$new"
mv "$new" "$document"
trap - EXIT

# docs/reference/controllers.md: "| symbol | `parameter` | default |".
controllers=docs/reference/controllers.md
new="$(mktemp "$controllers.XXXXXX")"
trap 'rm -f "$new"' EXIT
{ config --controller asm --task height; config --controller asm --task reach; config --controller aasm
  config --robot elbow --controller position; config --robot elbow --controller position --set position.quantity=height; } | rows '.*' |
  awk -F'\t' '
    NR == FNR { text[$1] = $2 ($3 == "" ? "" : " " $3); next }
    split($0, cell, " [|] ") == 3 && cell[2] ~ /^`[a-z_.A-Z]+`$/ {
      name = substr(cell[2], 2, length(cell[2]) - 2)
      if (!(name in text)) { print FILENAME ": there is no parameter " name > "/dev/stderr"; exit 1 }
      print cell[1] " | " cell[2] " | " text[name] " |"
      next
    }
    { print }' - "$controllers" >"$new"
chmod 644 "$new"
mv "$new" "$controllers"
trap - EXIT
echo "$document: $(grep -c '^| `' "$document") parameters"
