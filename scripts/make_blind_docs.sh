#!/usr/bin/env bash
# Writes docs/blind.md and three figures: makes cases with withheld causes from a seed, diagnoses them without the key, scores.
# Resumable: the same call goes on where it was stopped. On two free cores, recordings of 4 s: 300 cases on rig and elbow and 12 on the arm
# took 22 minutes to make, two hours and three quarters (rig and elbow) and an hour and a half (arm) to diagnose; following up takes about a
# minute each (FOLLOW=no leaves that out, an interrupt ends it where it is). The defaults, 120 and 12 cases of 6 s: by that about four hours
# without follow-ups.
# Usage: scripts/make_blind_docs.sh SEED CASES KEYS [build folder] [options of `blind make`]
#     SEED           of all draws; one that has not been used since the diagnosis was changed last. That of the cases where there are any
#     CASES          folder for the cases; new, or of a call that was stopped
#     KEYS           folder for the key, out of reach of the diagnosis: not in CASES, beside it or in the project
#     build folder   default: build/release; holds musclesim
# KEEP=FILE.tar.xz keeps seal, answers and follow-ups in an archive too, whenever the call ends, and takes them from there where CASES has
# none: a check can go on on another machine, and anybody can score it again. docs/blind_answers.tar.xz is that of docs/blind.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
usage='usage: scripts/make_blind_docs.sh SEED CASES KEYS [build folder] [options of `blind make`]'
seed="${1:?$usage}" cases="${2:?$usage}" keys="${3:?$usage}" build="${4:-build/release}"
program="$build/musclesim"
[[ -x "$program" ]] || { echo "make_blind_docs.sh: there is no program $program; build it first" >&2; exit 1; }
commit="$(git describe --always --dirty --abbrev=40 2>/dev/null || true)"
noted=()
[[ -z "$commit" ]] || noted=(--commit "$commit")

if [[ ! -e "$cases/seal.json" ]]; then
  "$program" blind make "$cases" --keys "$keys" --seed "$seed" "${noted[@]}" "${@:5}"
fi
sealed_seed="$(sed -n 's/.*"seed": \([0-9]*\).*/\1/p' "$cases/seal.json")"
[[ "$sealed_seed" == "$seed" ]] || { echo "make_blind_docs.sh: $cases holds cases of seed $sealed_seed, not $seed" >&2; exit 2; }

keep() {
  [[ -n "${KEEP:-}" && -d "$cases/answers" ]] || return 0
  local parts=(seal.json answers)
  for part in answers.json follow_up; do [[ ! -e "$cases/$part" ]] || parts+=("$part"); done
  tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX -C "$cases" -cJf "$KEEP.partial" "${parts[@]}"
  mv "$KEEP.partial" "$KEEP"
}
trap keep EXIT
if [[ -n "${KEEP:-}" && -e "$KEEP" && ! -d "$cases/answers" ]]; then
  # The key's name is drawn anew whenever cases are made.
  cmp -s <(tar -xJf "$KEEP" -O seal.json | grep -v '"key_file"') <(grep -v '"key_file"' "$cases/seal.json") ||
    { echo "make_blind_docs.sh: $KEEP holds answers to other cases or of another program than $cases/seal.json names" >&2; exit 2; }
  tar -xJf "$KEEP" -C "$cases" --exclude=seal.json
fi

key_file="$(sed -n 's/.*"key_file": "\([0-9a-f]*\.json\)".*/\1/p' "$cases/seal.json")"
"$program" blind run "$cases" "${noted[@]}"
[[ ${FOLLOW:-yes} == no ]] || "$program" blind follow "$cases" --keys "$keys/$key_file"
"$program" blind score "$cases" --keys "$keys/$key_file" --docs docs
