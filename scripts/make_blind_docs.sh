#!/usr/bin/env bash
# Writes docs/research/blind.md and three figures: makes cases with withheld causes from a seed, diagnoses them without the key, scores.
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
# none: a check can go on on another machine, and anybody who has the archive can score it again. The page then names the archive's SHA-256; the
# archive itself does not belong into the repository.
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
"$program" blind score "$cases" --keys "$keys/$key_file" --docs docs/research
if [[ -n "${KEEP:-}" ]]; then
  keep
  cat >>docs/research/blind.md <<TEXT

## The answers

Seal, answers and follow-ups of this check are in the archive \`$(basename "$KEEP")\` ($(du --apparent-size -BK "$KEEP" | cut -f1 | tr -d K) KiB), which is not part of the repository: \`seal.json\` (seed, version and fingerprints of all recordings), and per case \`answers/caseNNN.json\` (the diagnosis), \`answers/caseNNN.effects.json\` (the chosen effects, where there are any) and \`answers/caseNNN.cost.json\` (replays and seconds), \`answers.json\` (fingerprint of all answers, versions, seconds per case), and \`follow_up/caseNNN.json\` for the cases that were followed up (the answer tried on a fresh recording, the diagnosis with the true effect left out of the catalogue, the diagnosis with the proposed recording added). Its SHA-256:

    $(sha256sum "$KEEP" | cut -d' ' -f1)

With the archive, \`KEEP=FILE scripts/make_blind_docs.sh SEED CASES KEYS\` makes the cases again from the seed and scores these answers.
TEXT
fi
