#!/usr/bin/env bash
# Failing disks: full, read-only, and a failure of every single system call that writes. A run whose files cannot be written must
# end with exit status 5, report it, and leave no file that looks complete. Usage: disk_check.sh [PROGRAM]
# The full disk is a tmpfs in a private mount namespace (root); the failing calls need libfiu (fiu-utils). Checks that cannot run are named;
# the exit status is then 77 if all others pass.
set -euo pipefail
root=$(dirname "$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")")
program=$(realpath "${1:-$root/build/release/musclesim}")
if [[ ${MUSCLESIM_PRIVATE_MOUNTS-} != yes && $EUID -eq 0 ]]; then
  MUSCLESIM_PRIVATE_MOUNTS=yes exec unshare --mount --propagation private "$0" "$program"
fi
work=$(mktemp -d)
trap 'umount "$work/full" "$work/read_only" 2>/dev/null || true; rm -rf "$work"' EXIT
cd "$work"
failed=0 untried=0
wrong() {
  echo "WRONG: $*"
  failed=1
}
run=("$program" --simple --robot rig --controller hold --duration 3 --quiet)

# never_complete FOLDER STATUS WHAT: checks the files that a run with this exit status left.
check() {
  local folder=$1 status=$2 what=$3
  if ((status == 0)); then
    grep -q '"complete": true' "$folder/run.json" 2>/dev/null || wrong "$what: exit status 0, but the run is not complete"
  elif ((status == 5)); then
    [[ -s error ]] || wrong "$what: exit status 5 without a message"
    ! grep -q '"complete": true' "$folder/run.json" 2>/dev/null || [[ ! -s $folder/run.svg ]] || wrong "$what: failed, but looks complete"
  else
    wrong "$what: exit status $status: $(cat error)"
  fi
}

if [[ $EUID -eq 0 ]]; then
  mkdir full read_only
  sizes=0
  for size in 4 8 16 24 32 48 64 96 128; do
    mount -t tmpfs -o "size=${size}k" tmpfs full
    status=0
    "${run[@]}" --out full/run >/dev/null 2>error || status=$?
    check full/run "$status" "a disk of $size KiB"
    ((size > 32)) || ((status == 5)) || wrong "a disk of $size KiB: exit status $status"
    umount full
    sizes=$((sizes + 1))
  done
  echo "full disk: $sizes sizes of disk, exit status 5 wherever the run does not fit"
  mount -t tmpfs -o ro tmpfs read_only
  status=0
  "${run[@]}" --out read_only/run >/dev/null 2>error || status=$?
  ((status == 5)) || wrong "read-only: exit status $status"
  echo "read-only disk: $(cat error)"
else
  echo "full and read-only disks: NOT TRIED, needs root"
  untried=1
fi

status=0
"$program" effects >/dev/full 2>error || status=$?
((status == 5)) || wrong "standard output on /dev/full: exit status $status"
echo "standard output full: $(cat error)"

if command -v fiu-run >/dev/null; then
  calls=0 ends_5=0
  for call in rw/write sync/fsync dir/rename oc/close oc/open; do
    for nth in 1 2 3 4 5 6 8 10 14 20 30; do
      rm -rf out error
      status=0
      fiu-run -x -c "enable_random name=posix/io/$call,probability=$(awk "BEGIN { print 1 / $nth }")" \
        "${run[@]}" --out out >/dev/null 2>error || status=$?
      check out "$status" "$call fails with probability 1/$nth"
      calls=$((calls + 1))
      ((status != 5)) || ends_5=$((ends_5 + 1))
    done
  done
  echo "failing calls (write, fsync, rename, close, open): $calls runs, $ends_5 ended with exit status 5, the others wrote everything"
else
  echo "failing calls: NOT TRIED, needs fiu-run (apt-get install fiu-utils)"
  untried=1
fi
((failed || !untried)) || exit 77
exit "$failed"
