#!/usr/bin/env bash
# Makes the Debian packages and tries them on a machine that has nothing installed: a minimal Debian 12 in a folder.
#
#     scripts/debian_package_check.sh DIR [BUILD FOLDER]      default: the release preset, built first
#
# There it installs musclesim and runs it, reads the manual page, completes a command line, checks the desktop file; then installs
# libmusclesim-dev, builds and runs the examples with find_package, and one of them with pkg-config alone; then python3-musclesim by itself,
# whose example controls the elbow, plots and diagnoses, and writes the program's bits.
# Needs root, debootstrap, dpkg-dev, help2man, git and a network. MIRROR=URL chooses another Debian mirror.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"
command -v help2man >/dev/null || { say "debian_package_check: needs help2man (scripts/install_dependencies.sh --package)"; exit 2; }
# shellcheck source=scripts/fresh_debian.sh
source "$root/scripts/fresh_debian.sh"

(($# >= 1)) || fail "which folder? usage: scripts/debian_package_check.sh DIR [BUILD FOLDER]"
enter_private_mounts "$@"
build=${2-}
if [[ -z $build ]]; then
  build=$root/build/release
  build_preset release all -DMUSCLESIM_TESTS=OFF
else
  build=$(realpath "$build")
  cmake --build "$build" --target manual_page musclesim_python >&2
fi
make_debian "$1"
mkdir -p "$debian/packages"
(cd "$build" && cpack -G DEB -B "$debian/packages" >"$dir/cpack.log") || fail "cpack failed, see $dir/cpack.log"
rm -rf "$debian/packages/_CPack_Packages"
ls -l "$debian/packages"

cat >"$debian/packages/try.sh" <<'TRY'
#!/bin/bash
# Every step must succeed; each says what it shows.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
cd /packages
say() { printf '== %s\n' "$*"; }
# Small images of Debian leave manual pages out; here they are wanted.
rm -f /etc/dpkg/dpkg.cfg.d/*excludes* 2>/dev/null || true
say "installs: program alone"
apt-get -qq update
apt-get -qq install --yes --no-install-recommends ./musclesim_*.deb >/dev/null
musclesim --version
say "runs"
mkdir /tmp/run && cd /tmp/run
musclesim --simple --robot elbow --controller random --duration 1 --out out
test -s out/run.csv
musclesim replay out/run.csv
say "manual page"
apt-get -qq install --yes --no-install-recommends man-db bash-completion desktop-file-utils >/dev/null
man -w musclesim
man musclesim | grep -A2 '^NAME' | tail -n 1
test "$(man musclesim | grep -c 'SUB-COMMAND')" -ge 10
say "completion"
bash -c '
  source /usr/share/bash-completion/bash_completion
  _completion_loader musclesim
  try() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE="$*"; COMP_POINT=${#COMP_LINE}; COMPREPLY=(); _musclesim; echo "$* -> ${COMPREPLY[*]}"; }
  try musclesim dia | grep -x "musclesim dia -> diagnose"
  try musclesim replay --rob | grep -x "musclesim replay --rob -> --robot"
  try musclesim --robot el | grep -x "musclesim --robot el -> elbow"
  try musclesim effects valve | grep -x "musclesim effects valve -> valve_lag"
  try musclesim --set arm.muscle_c | grep -x "musclesim --set arm.muscle_c -> arm.muscle_count="
'
say "desktop file"
desktop-file-validate /usr/share/applications/musclesim.desktop
say "development package"
cd /packages
apt-get -qq install --yes --no-install-recommends ./libmusclesim-dev_*.deb cmake make g++ >/dev/null
cmake -S /usr/share/doc/musclesim/examples -B /tmp/examples >/dev/null
cmake --build /tmp/examples
ctest --test-dir /tmp/examples --output-on-failure
say "pkg-config"
# shellcheck disable=SC2046
g++ -std=c++20 /usr/share/doc/musclesim/examples/two_muscle_joint.cpp -o /tmp/with_pkg_config $(pkg-config --cflags --libs musclesim)
cd /tmp/run && /tmp/with_pkg_config >/dev/null
say "Python module alone"
cp /tmp/run/out/run.csv /tmp/program.csv
apt-get -qq remove --yes musclesim libmusclesim-dev >/dev/null
cd /packages
apt-get -qq install --yes --no-install-recommends ./python3-musclesim_*.deb python3-matplotlib >/dev/null
mkdir /tmp/python && cd /tmp/python
test "$(wc -l </usr/share/doc/python3-musclesim/examples/elbow.py)" -lt 25
MPLBACKEND=Agg python3 /usr/share/doc/python3-musclesim/examples/elbow.py | tee causes.txt
grep -x "causes: .'valve_lag@all'." causes.txt
test -s elbow.svg
python3 -c 'import musclesim; musclesim.run("elbow", "random", 1, record="run.csv")'
cmp run.csv /tmp/program.csv
say "goes away"
apt-get -qq remove --yes python3-musclesim >/dev/null
test ! -e /usr/bin/musclesim
test ! -e /usr/lib/python3/dist-packages/musclesim
say "all passed"
TRY
chmod +x "$debian/packages/try.sh"
inside "$dir/packages.log" /packages/try.sh
