# Shared by the scripts that try things in a minimal Debian 12 in a folder; expects scripts/common.sh. Needs root, debootstrap and a network.
# shellcheck shell=bash

fail() {
  say "$(basename "$0" .sh): $*"
  exit 2
}

# enter_private_mounts DIR...: starts the script again where mounts are its own and vanish with it.
enter_private_mounts() {
  ((EUID == 0)) || fail "must run as root, because it enters another root folder"
  command -v debootstrap >/dev/null || fail "needs debootstrap (apt-get install debootstrap)"
  if [[ ${MUSCLESIM_PRIVATE_MOUNTS-} != yes ]]; then
    [[ ! -e $1/debian ]] || fail "$1/debian exists already"
    MUSCLESIM_PRIVATE_MOUNTS=yes exec unshare --mount --propagation private "$0" "$@"
  fi
}

# make_debian DIR: a minimal Debian 12 in DIR/debian, ready to be entered; sets $dir and $debian.
make_debian() {
  [[ $1 != *[[:space:]]* ]] || fail "debootstrap cannot work in a folder with a space in its name: $1"
  mkdir -p "$1"
  dir=$(cd "$1" && pwd)
  debian=$dir/debian
  say "Putting Debian 12 into $debian ..."
  local start=$SECONDS part
  debootstrap --variant=minbase bookworm "$debian" "${MIRROR:-http://deb.debian.org/debian}" >"$dir/debootstrap.log" ||
    fail "debootstrap failed, see $dir/debootstrap.log"
  say "  took $((SECONDS - start)) s"
  # If the host is a Debian 12 too, its settings of apt are used.
  if [[ -z ${MIRROR-} ]] && grep -qs '^VERSION_CODENAME=bookworm' /etc/os-release; then
    for part in sources.list sources.list.d apt.conf.d keyrings trusted.gpg.d; do
      if [[ -e /etc/apt/$part ]]; then
        cp -aT "/etc/apt/$part" "$debian/etc/apt/$part"
      fi
    done
    [[ -e /etc/apt/sources.list ]] || rm -f "$debian/etc/apt/sources.list"
  fi
  cp -L /etc/resolv.conf /etc/hosts "$debian/etc/"
  mount -t proc proc "$debian/proc"
  mount --bind /dev "$debian/dev"
}

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
