#!/bin/sh
# Writes the manual page: help2man's, with the options of every sub-command.
# Usage: make_man_page.sh PROGRAM PAGE
set -eu
program=$1 page=$2
include=$(mktemp)
trap 'rm -f "$include"' EXIT
{
  echo '[NAME]'
  echo 'musclesim \- simulator of robots driven by pneumatic artificial muscles'
  "$program" --help | sed -n '/^Subcommands:/,$ s/^  \([a-z][a-z-]*\) .*/\1/p' | while read -r subcommand; do
    printf '\n[SUB-COMMAND %s]\n.nf\n' "$subcommand"
    # Backslashes, leading dots and quotes mean something to troff.
    "$program" "$subcommand" --help | sed -e 's/\\/\\e/g' -e "s/^\\([.']\\)/\\\\\\&\\1/" -e 's/-/\\-/g'
    printf '.fi\n'
  done
  printf '\n[EXIT STATUS]\n0 done, 1 internal error, 2 usage, 3 bad input file, 4 simulation diverged, 5 input/output error,\n'
  printf '6 incomplete sweep, 130/143 interrupted (files complete up to then).\n'
  printf '\n[EXAMPLES]\n.nf\nmusclesim \\-\\-simple \\-\\-seed 2 \\-\\-physics original \\-\\-duration 300 \\-\\-out height\n'
  printf 'musclesim replay height/run.csv\nmusclesim diagnose monday.csv tuesday.csv\n.fi\n'
} >"$include"
help2man --no-info --no-discard-stderr --section=1 --include="$include" --output="$page" "$program"
