#!/usr/bin/env bash
# Installs what is missing, builds musclesim with its tests, and runs every check there is:
#
#     scripts/test.sh          layout of the sources, links of the documents, build, tests, clang-tidy, tests under the address and
#                              undefined-behaviour sanitizers
#     scripts/test.sh --ci     all but the sanitizers, and clang-tidy only on sources of the last commits: what continuous integration
#                              has time for
#     scripts/test.sh --fast   all but clang-tidy and sanitizers
#
# A failed phase does not keep the others from running. At the end: a line per phase, then how many tests ran and which failed.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"

fast=false
ci=false
case "${1-}" in
  "") ;;
  --ci) ci=true ;;
  --fast) fast=true ;;
  *)
    say "test: unknown argument '$1'; allowed: --ci, --fast"
    exit 2
    ;;
esac
cd "$root"
jobs=2
last_commits=25  # whose sources --ci looks through
build=build/release  # what users run is what is tested
test_log=$build/test_summary.txt
summary=()
failed=false

# phase NAME COMMAND...: runs a phase and notes how long it took and how it ended.
phase() {
  local name=$1 start=$SECONDS result=passed
  shift
  printf '\n=== %s ===\n' "$name"
  "$@" || result=FAILED
  [[ $result == passed ]] || failed=true
  summary+=("$(printf '%-12s %-7s %4d s' "$name" "$result" $((SECONDS - start)))")
  [[ $result == passed ]]
}

check_layout() {
  local list
  list=$(mktemp)
  git ls-files -z '*.h' '*.cpp' >"$list" 2>/dev/null || find . -name build -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 >"$list"
  xargs -0 clang-format --dry-run -Werror <"$list" || { rm "$list" && return 1; }
  rm "$list"
}

# One line per test; the output of failed tests; totals, which are kept for the end.
run_tests() {
  local status=0
  ctest --preset release --parallel "$jobs" 2>&1 | tee "$test_log.all" || status=$?
  sed -n '/^[0-9]*% tests passed/,$p' "$test_log.all" >"$test_log"
  rm "$test_log.all"
  return "$status"
}

# A build that scripts/run.sh has made has no tests.
build_all() {
  [[ ! -f $build/CMakeCache.txt ]] || sed -i 's/^MUSCLESIM_TESTS:BOOL=OFF$/MUSCLESIM_TESTS:BOOL=ON/' "$build/CMakeCache.txt"
  build_preset release all
}

# The sources of library and program, as the build lists them; tests are left out, their macros drown everything else.
sources() {
  sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$build/compile_commands.json" | grep -vF "$root/tests/"
}

# Those that the last commits changed, or whose header they changed; all where that many commits are not at hand.
recent_sources() {
  local changed
  if changed=$(git diff --name-only "HEAD~$last_commits" -- '*.cpp' '*.h' 2>/dev/null); then
    sources | grep -E -f <(sed -E 's|.*/||; s|[.][a-z]+$||; s|.*|/&[.]cpp$|' <<<"$changed")
  else
    sources
  fi
}

check_sources() {
  local status=0 messages
  messages=$(mktemp)
  if $ci; then recent_sources; else sources; fi | tr '\n' '\0' |
    xargs -0 -r -n 1 -P "$jobs" clang-tidy -p "$build" --quiet 2>"$messages" || status=$?
  grep -v 'warnings\{0,1\} \(generated\|treated as errors\)' "$messages" || true
  rm "$messages"
  return "$status"
}

# Tests labelled "slow" or "package" run only without sanitizers.
run_sanitized_tests() {
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
  build_preset asan all && ctest --preset asan --parallel "$jobs" --label-exclude 'slow|package'
}

phase dependencies scripts/install_dependencies.sh --test || exit 1
mkdir -p "$build"
rm -f "$test_log"
phase layout check_layout || true
phase documents scripts/check_docs.sh || true
if phase build build_all; then
  phase tests run_tests || true
  if ! $fast; then
    phase clang-tidy check_sources || true
    if ! $ci; then
      phase sanitizers run_sanitized_tests || true
    fi
  fi
fi

printf '\n=== summary ===\n'
printf '%s\n' "${summary[@]}"
echo
[[ -f $test_log ]] && cat "$test_log"
if $failed; then exit 1; fi
