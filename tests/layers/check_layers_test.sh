#!/usr/bin/env bash
# Writes a small project with two layers and checks what scripts/check_layers.py says about it: nothing without a fault; with an include
# of a higher layer, or with a cycle of includes, it fails and names both files.
# Usage: check_layers_test.sh SCRIPT. Exit status 77 (skipped) without python3.
set -euo pipefail
script=$1
command -v python3 >/dev/null || { echo "skipped: there is no python3"; exit 77; }
project=$(mktemp -d)
trap 'rm -rf "$project"' EXIT

# write FILE LINE...: a file of the project.
write() {
  local file=$project/$1
  shift
  mkdir -p "${file%/*}"
  printf '%s\n' "$@" >"$file"
}

# A project without a fault: robot includes base, effect includes robot.
write_project() {
  rm -rf "${project:?}"/*
  write docs/developer/architecture.md '```layers' 'base log' 'robot' 'effect' '```'
  write include/musclesim/base/error.h
  write base/error.cpp '#include "musclesim/base/error.h"'
  write base/text.h
  write log/row.h '#include <string>'
  write robot/muscle.h '#include "musclesim/base/error.h"' '#include "base/text.h"'
  write robot/muscle.cpp '#include "muscle.h"'
  write robot/joint.h
  write effect/creep.cpp '#include "robot/muscle.h"'
}

# expect WHAT STATUS PART...: the check must end with STATUS, and its output must hold every PART.
expect() {
  local what=$1 wanted=$2 status=0 output part
  shift 2
  output=$(python3 "$script" "$project" 2>&1) || status=$?
  printf '%s: status %s\n%s\n\n' "$what" "$status" "$output"
  [[ $status == "$wanted" ]] || { echo "FAILED: $what: expected status $wanted"; exit 1; }
  for part in "$@"; do
    [[ $output == *"$part"* ]] || { echo "FAILED: $what: \"$part\" is missing"; exit 1; }
  done
}

write_project
expect "no fault" 0 "0 faults"

write_project
write robot/muscle.cpp '#include "muscle.h"' '#include "effect/effect.h"'
write effect/effect.h
expect "include of a higher layer" 1 "robot/muscle.cpp:2: includes effect/effect.h" "1 faults"

write_project
write base/error.cpp '#include "musclesim/base/error.h"' '#include "log/row.h"'
expect "include of another folder of the same layer" 1 "base/error.cpp:2: includes log/row.h" "1 faults"

write_project
write robot/muscle.h '#include "joint.h"'
write robot/joint.h '#include "muscle.h"'
expect "cycle of two files" 1 "cycle of includes: robot/joint, robot/muscle" "1 faults"
