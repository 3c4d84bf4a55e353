#!/usr/bin/env bash
# Installs what is missing and checks what scripts/test.sh does not:
#
#     scripts/check.sh          layers (direction of the includes), format of the sources, links of the documents, clang-tidy, tests under
#                               the address and undefined-behaviour sanitizers; the sanitizers take more than half an hour
#                               and what has threads under the thread sanitizer (scripts/thread_check.sh), which takes another half hour
#     scripts/check.sh --sanitizers [FOLDER ...]   only the tests, or those of folders of tests/, under the address and undefined-behaviour
#                               sanitizers. ALL=1: slow tests, too, for hours. PRESET=fuzz: those of folders, compiled by clang for the
#                               fuzzer, which saves a build where scripts/fuzz.sh had one
#     scripts/check.sh --ci     all but the sanitizers, and clang-tidy only on sources that the last commits changed: what continuous
#                               integration has time for
#
# If a phase fails, the next ones run all the same. The script ends with a line per phase.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"

ci=false sanitizers_only=false folders=()
case "${1-}" in
  "") ;;
  --ci) ci=true ;;
  --sanitizers) sanitizers_only=true folders=("${@:2}") ;;
  *)
    say "check: unknown argument '$1'; allowed: --ci, --sanitizers"
    exit 2
    ;;
esac
cd "$root"
jobs=2
last_commits=25     # --ci checks the sources that these changed,
ci_limit_s=600      # as many of them as this time allows
database=build/tidy  # compile_commands.json that names each source by itself; nothing is built there
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

check_format() {
  local list status=0
  list=$(mktemp)
  git ls-files -z '*.h' '*.cpp' >"$list" 2>/dev/null || find . -name build -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 >"$list"
  xargs -0 clang-format --dry-run -Werror <"$list" || status=1
  rm "$list"
  return "$status"
}

# The sources of library and program, as the build lists them. Tests are left out: clang-tidy complains about gtest's macros.
sources() {
  sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$database/compile_commands.json"
}

# The sources that the last commits changed, or whose header they changed; all sources if the history is shorter than that.
recent_sources() {
  local changed
  if changed=$(git diff --name-only "HEAD~$last_commits" -- '*.cpp' '*.h' 2>/dev/null); then
    sources | grep -E -f <(sed -E 's|.*/||; s|[.][a-z]+$||; s|.*|/&[.]cpp$|' <<<"$changed") || true
  else
    sources
  fi
}

check_sources() {
  local status=0 messages findings
  cmake --preset release -B "$database" -DMUSCLESIM_UNITY=OFF -DMUSCLESIM_TESTS=OFF --log-level=WARNING >/dev/null || return 1
  messages=$(mktemp) findings=$(mktemp)
  if $ci; then recent_sources; else sources; fi | tr '\n' '\0' |
    timeout "$($ci && echo $ci_limit_s || echo 0)" xargs -0 -r -n 1 -P "$jobs" clang-tidy -p "$database" --quiet 2>"$messages" | tee "$findings" || status=$?
  if $ci && ((status == 124)); then
    say "check: clang-tidy did not get through all sources in $ci_limit_s s"
    if ! grep -q ' error: ' "$findings"; then status=0; fi
  fi
  grep -v 'warnings\{0,1\} \(generated\|treated as errors\)' "$messages" || true
  rm "$messages" "$findings"
  return "$status"
}

# Tests labelled "package" run only without sanitizers, those labelled "slow" only with ALL=1.
run_sanitized_tests() {
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
  local folder preset=${PRESET:-asan} excluded='slow|package' status=0
  if [[ -n ${ALL-} ]]; then excluded=package; fi
  if ((${#folders[@]} == 0)); then
    build_preset asan all && ctest --preset asan --parallel "$jobs" --label-exclude "$excluded"
    return
  fi
  for folder in "${folders[@]}"; do
    printf '%s: ' "$folder"
    build_preset "$preset" "tests/$folder/all" &&
      ctest --test-dir "build/$preset/tests/$folder" --no-tests=error --output-on-failure --parallel "$jobs" \
        --label-exclude "$excluded" || status=1
  done
  return "$status"
}

phase dependencies scripts/install_dependencies.sh --check || exit 1
if ! $sanitizers_only; then
  phase layers scripts/check_layers.py || true
  phase format check_format || true
  phase links scripts/check_docs.sh || true
  phase clang-tidy check_sources || true
fi
if ! $ci; then
  phase sanitizers run_sanitized_tests || true
fi
if ! $ci && ! $sanitizers_only; then
  phase threads scripts/thread_check.sh || true
fi

printf '\n=== summary ===\n'
printf '%s\n' "${summary[@]}"
if $failed; then exit 1; fi
