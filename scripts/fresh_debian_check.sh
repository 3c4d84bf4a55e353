#!/usr/bin/env bash
# Tries what the README promises on a machine that has nothing installed: a minimal Debian 12 in a folder.
#
#     scripts/fresh_debian_check.sh DIR
#
# Puts Debian into DIR/debian (about 3 GB in the end), clones the last commit into it, under a path with a space, and calls there as a
# new user would, first scripts/run.sh and then scripts/test.sh.
# Every line is printed with the seconds since its command began, and kept in DIR/run.log and DIR/test.log.
# Needs root, debootstrap, git and a network. Mounts live in a private namespace and vanish with the script; DIR stays and may be deleted.
# MIRROR=URL chooses another Debian mirror.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"

# shellcheck source=scripts/fresh_debian.sh
source "$root/scripts/fresh_debian.sh"

(($# == 1)) || fail "which folder? usage: scripts/fresh_debian_check.sh DIR"
enter_private_mounts "$@"
make_debian "$1"

clone="/home/new user/musclesim"
mkdir -p "$debian${clone%/*}"
git clone --quiet "$root" "$debian$clone"
status=0
inside "$dir/run.log" "$clone/scripts/run.sh" || status=1
inside "$dir/test.log" "$clone/scripts/test.sh" || status=1
exit "$status"
