#!/usr/bin/env bash
# Tries what the README promises on a machine that has nothing installed: a minimal Debian 12 in a folder.
#
#     scripts/fresh_debian_check.sh DIR [ARGUMENT of scripts/test.sh ...]
#
# Puts Debian into DIR/debian (about 3 GB in the end), clones the last commit into it, under a path with a space, and calls there as a
# new user would, first scripts/run.sh and then scripts/test.sh (with --fast unless other arguments are given).
# Every line is printed with the seconds since its command began, and kept in DIR/run.log and DIR/test.log.
# Needs root, debootstrap, git and a network. Mounts live in a private namespace and vanish with the script; DIR stays and may be deleted.
# MIRROR=URL chooses another Debian mirror.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"

fail() {
  say "fresh_debian_check: $*"
  exit 2
}

(($# >= 1)) || fail "which folder? usage: scripts/fresh_debian_check.sh DIR [ARGUMENT of scripts/test.sh ...]"
((EUID == 0)) || fail "must run as root, because it enters another root folder"
command -v debootstrap >/dev/null || fail "needs debootstrap (apt-get install debootstrap)"
if [[ ${MUSCLESIM_PRIVATE_MOUNTS-} != yes ]]; then
  [[ ! -e $1/debian ]] || fail "$1/debian exists already"
  MUSCLESIM_PRIVATE_MOUNTS=yes exec unshare --mount --propagation private "$0" "$@"
fi

mkdir -p "$1"
dir=$(cd "$1" && pwd)
shift
debian=$dir/debian
test_arguments=("${@:---fast}")

say "Putting Debian 12 into $debian ..."
start=$SECONDS
debootstrap --variant=minbase bookworm "$debian" "${MIRROR:-http://deb.debian.org/debian}" >"$dir/debootstrap.log" ||
  fail "debootstrap failed, see $dir/debootstrap.log"
say "  took $((SECONDS - start)) s"

# Where this machine is a Debian 12 too, its settings of apt lead to a mirror that works from here.
if [[ -z ${MIRROR-} ]] && grep -qs '^VERSION_CODENAME=bookworm' /etc/os-release; then
  for part in sources.list sources.list.d apt.conf.d keyrings trusted.gpg.d; do
    if [[ -e /etc/apt/$part ]]; then
      cp -aT "/etc/apt/$part" "$debian/etc/apt/$part"
    fi
  done
  [[ -e /etc/apt/sources.list ]] || rm -f "$debian/etc/apt/sources.list"
fi
cp -L /etc/resolv.conf /etc/hosts "$debian/etc/"

clone="/home/new user/musclesim"
mkdir -p "$debian${clone%/*}"
git clone --quiet "$root" "$debian$clone"
mount -t proc proc "$debian/proc"
mount --bind /dev "$debian/dev"

# inside LOG COMMAND...: runs a command in the fresh system, from another folder, with a fresh environment and no terminal.
inside() {
  local log=$1 status=0 start=$SECONDS line
  shift
  say "Running $* ..."
  local TIMEFORMAT='%0R s elapsed, %0U s of processor time'
  { time env -i HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    chroot "$debian" "$@"; } </dev/null 2>&1 |
    while IFS= read -r line; do printf '[%4d s] %s\n' "$((SECONDS - start))" "$line"; done | tee "$log" || status=$?
  say "  ended with status $status"
  return "$status"
}

status=0
inside "$dir/run.log" "$clone/scripts/run.sh" || status=1
inside "$dir/test.log" "$clone/scripts/test.sh" "${test_arguments[@]}" || status=1
exit "$status"
