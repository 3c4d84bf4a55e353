#!/usr/bin/env bash
# Makes docs/user/figures/height_task.svg, the run that README.md and docs/user/getting_started.md describe, and prints what they say of it.
#
#     scripts/make_height_task_docs.sh [build folder]
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
program=$(readlink -f "${1:-$root/build/release}/musclesim")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$program" --simple --seed 5 --physics original --duration 300 --record-interval 0.1 --out "$folder"
cp "$folder/run.svg" "$root/docs/user/figures/height_task.svg"
python3 - "$folder/run.csv" <<'PYTHON'
import csv, sys
rows = [(float(r["time_s"]), float(r["hand_y_mm"]) - float(r["target_y_mm"])) for r in csv.DictReader(open(sys.argv[1]))]
print(f"at first {rows[0][1]:.0f} mm from the target; last more than 20 mm away at {max(t for t, error in rows if abs(error) > 20):.0f} s; "
      f"after 200 s within {max(abs(error) for t, error in rows if t > 200):.0f} mm")
PYTHON
