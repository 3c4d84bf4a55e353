#!/usr/bin/env bash
# Diagnoses practice plants with two to four causes (recordings of an independent program) and writes docs/research/practice_several.md.
#
#     scripts/make_several_causes_docs.sh PRACTICE ANSWERS [build folder]
#
# PRACTICE holds caseNN/r*.csv and keys.json; caseNN/case.json names numbers that nobody measured, for --tune. Answers are kept in
# ANSWERS/caseNN with the version that made them; those that are there already are not made again. Four to fifteen minutes per case on one
# core.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
if (($# < 2)) || [[ ! -e $1/keys.json ]]; then
  echo "usage: make_several_causes_docs.sh PRACTICE ANSWERS [build folder]; PRACTICE must hold keys.json" >&2
  exit 2
fi
practice=$(readlink -f "$1")
mkdir -p "$2"
answers=$(readlink -f "$2")
program=$(readlink -f "${3:-$root/build/release}/musclesim")

for folder in "$practice"/case*; do
  name=$(basename "$folder")
  [[ -e $answers/$name/diagnosis.json ]] && continue
  echo "$name" >&2
  tuned=""
  [[ -e $folder/case.json ]] && tuned=$(python3 -c "import json, sys; print(','.join(json.load(open(sys.argv[1])).get('tune', [])))" "$folder/case.json")
  "$program" diagnose "$folder"/r?.csv ${tuned:+--tune "$tuned"} --jobs 1 --out "$answers/$name" --quiet || { echo "$name failed" >&2; continue; }
  git -C "$root" rev-parse --short HEAD >"$answers/$name/version"
done

python3 "$root/scripts/several_causes.py" "$practice/keys.json" "$answers" >"$root/docs/research/practice_several.md"
echo "docs/research/practice_several.md" >&2
