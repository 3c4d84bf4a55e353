#!/usr/bin/env bash
# Writes rig_line.toml, elbow_line.toml, wrist_line.toml and pulley_arm.toml into a folder: shipped robots with massless muscles and a damped
# joint. A plant of such a robot takes a few seconds to make and 10 to 30 to diagnose, a tenth of what chains take, so that checks on
# withheld causes can be large: make_blind_docs.sh SEED CASES KEYS build/release --robot "$(scripts/make_line_robots.sh FOLDER)".
# `blind make` copies the files. Prints the paths, separated by commas.
# Usage: scripts/make_line_robots.sh FOLDER
set -euo pipefail
folder="${1:?usage: scripts/make_line_robots.sh FOLDER}"
mkdir -p "$folder"
folder=$(readlink -f "$folder")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
line() { # ROBOT, line with the damping of its joint
  sed -e "s/^name = \"$1\"\$/name = \"$1_line\"/" -e "s/^\[\[muscle\]\].*/&\nmodel = \"line\"/" \
    -e "/^\[\[joint\]\]/,/^\$/s/^axis = .*/&\n$2/" "robots/$1.toml" >"$folder/$1_line.toml"
}
line rig 'damping_Ns_per_m = 20'
line elbow 'damping_Nms_per_rad = 0.06'
line wrist 'damping_Nms_per_rad = 0.02'
cp robots/pulley_arm.toml "$folder/"
echo "$folder/rig_line.toml,$folder/elbow_line.toml,$folder/wrist_line.toml,$folder/pulley_arm.toml"
