#!/usr/bin/env bash
# Installs what is missing, builds the release preset with its tests, and runs all tests. scripts/check.sh does all other checks.
#
#     scripts/test.sh [ARGUMENT of ctest...]     for example scripts/test.sh -R Elbow: only tests whose name contains "Elbow"
#
# It says first how long it will take and ends with the totals of ctest.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
cd "$root"

say "This takes about 14 minutes from nothing on two idle cores, and 6 minutes if all is built."
scripts/install_dependencies.sh --test
installed=$SECONDS
# scripts/run.sh builds without tests.
[[ ! -f build/release/CMakeCache.txt ]] || sed -i 's/^MUSCLESIM_TESTS:BOOL=OFF$/MUSCLESIM_TESTS:BOOL=ON/' build/release/CMakeCache.txt
build_preset release all
built=$SECONDS
output=$(mktemp)
trap 'rm -f "$output"' EXIT
status=0
ctest --preset release --parallel 2 "$@" 2>&1 | tee "$output" || status=$?
printf '\nIt took %d s: packages %d s, build %d s, tests %d s.\n' $SECONDS $installed $((built - installed)) $((SECONDS - built))
sed -n '/^[0-9]*% tests passed/,$p' "$output"
exit "$status"
