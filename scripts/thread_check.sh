#!/usr/bin/env bash
# Runs what has threads under the thread sanitizer: ensembles, the store of predictions, a small diagnosis that is interrupted and resumed,
# and ensembles in Python. A sweep's worker has no threads; several are processes.
#
#     scripts/thread_check.sh [PART ...]      default: all of simulation diagnosis diagnose python
#
# Builds the preset tsan, which takes more than half an hour on two idle cores. ODE, Python and NumPy are not instrumented: races within them
# are not seen, and their locks are, so that what lies between two calls of ours is. Exit status 1 for a finding or a failed test.
set -euo pipefail
# GCC 12's thread sanitizer does not know where newer kernels put programs: addresses are not drawn at random. That counts for the build,
# too, which asks the test programs for their tests.
if [[ -z ${MUSCLESIM_FIXED_ADDRESSES-} ]]; then MUSCLESIM_FIXED_ADDRESSES=yes exec setarch "$(uname -m)" -R "${BASH_SOURCE[0]}" "$@"; fi
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
cd "$root"
build=build/tsan
parts=("$@")
((${#parts[@]})) || parts=(simulation diagnosis diagnose python)
export TSAN_OPTIONS=halt_on_error=0:second_deadlock_stack=1:exitcode=66:suppressions=$root/scripts/thread_suppressions.txt
status=0

# part NAME COMMAND...: runs it and counts the reports.
part() {
  local name=$1 log=$build/thread_check_$1.log ended=0
  shift
  "$@" >"$log" 2>&1 || ended=$?
  local found
  found=$(grep -c '^WARNING: ThreadSanitizer' "$log" || true)
  printf '%-11s exit status %d, %d reports, %s\n' "$name" "$ended" "$found" \
    "$(grep -aoE '[0-9]+ tests? from .* ran|Ran [0-9]+ tests? in .*' "$log" | tail -n 1)"
  ((ended == 0 && found == 0)) || { status=1; grep -A 12 '^WARNING: ThreadSanitizer' "$log" | head -n 60 || true; }
}

for name in "${parts[@]}"; do
  case $name in
    simulation) targets=simulation_tests ;;
    diagnosis) targets=diagnosis_tests ;;
    diagnose) targets=diagnose_tests ;;
    python) targets=musclesim_python ;;
    *) say "thread_check: unknown part '$name'"; exit 2 ;;
  esac
  build_preset tsan "$targets" || exit 1
  case $name in
    simulation) part "$name" "$build/tests/simulation/simulation_tests" '--gtest_filter=Ensemble.*:RunLoop.*' ;;
    diagnosis) part "$name" "$build/tests/diagnosis/diagnosis_tests" '--gtest_filter=PredictionStore.*' ;;
    diagnose) part "$name" "$build/tests/diagnosis/diagnose_tests" '--gtest_filter=ResumedDiagnosis.GoesOn*' ;;
    python)
      # The sanitizer must be there before Python is.
      part "$name" env PYTHONPATH="$build/python" PYTHONDONTWRITEBYTECODE=1 LD_PRELOAD="$(c++ -print-file-name=libtsan.so)" \
        /usr/bin/python3 tests/python/run.py test_ensemble ;;
  esac
done
exit "$status"
