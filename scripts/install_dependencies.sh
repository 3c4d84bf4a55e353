#!/usr/bin/env bash
# Installs what building musclesim needs and is not there yet, with Debian's apt-get.
#
#     scripts/install_dependencies.sh          what the program needs
#     scripts/install_dependencies.sh --test      and what the tests need
#     scripts/install_dependencies.sh --check     and what the tests and scripts/check.sh need
#     scripts/install_dependencies.sh --cluster   and what all tests need, also those of sweeps under GNU parallel and Slurm
#     scripts/install_dependencies.sh --package   and what the Debian packages of musclesim need
#
# When everything is there it does nothing, needs no rights and no network. On a system without apt-get it says what is needed.
set -euo pipefail

# package and what it is for
build_packages=(
  "g++                    C++20 compiler"
  "cmake                  build description"
  "ninja-build            runs the build"
  "pkg-config             finds the physics engine"
  "libode-dev             physics engine"
  "libeigen3-dev          linear algebra"
  "libfmt-dev             text formatting"
  "nlohmann-json3-dev     JSON files"
  "libtomlplusplus-dev    configuration files"
  "libmuparser-dev        expressions in robot files"
  "libcli11-dev           command line"
  "libceres-dev           fits of force laws"
  "nettle-dev             fingerprints of sealed files"
  "libtinyxml2-dev        import of URDF and MuJoCo files"
  "libsdformat-dev        import of SDF files"
  "libmatio-dev           import of MATLAB files"
  "libgl-dev              drawing"
  "libosmesa6-dev         pictures without a display"
  "libpng-dev             pictures as files"
  "freeglut3-dev          window"
  "libx11-dev             whether there is a display"
  "libimgui-dev           sliders and plots in the window"
)
python_packages=(
  "pybind11-dev           the Python module"
  "python3-dev            the Python module"
  "python3-numpy          the Python module"
)
test_packages=(
  "libgtest-dev           test framework"
  "python3                the test of scripts/check_layers.py"
  "gnuplot-nox            draws figures from recordings"
  "librsvg2-bin           figures as PNG"
  "ffmpeg                 videos"
  "xvfb                   a display for the tests of the window"
  "xdotool                keys and mouse for the tests of the window"
  "fiu-utils              system calls that fail"
  "faketime               a clock that is set back"
  "chromium               a browser for the tests of the report"
  "chromium-driver        drives the browser"
  "python3-selenium       drives the browser"
  "${python_packages[@]}"
  "python3-matplotlib     the examples in Python"
)
check_packages=(
  "clang-format           checks the layout of the sources"
  "clang-tidy             looks for mistakes in the sources"
)
cluster_packages=(
  "parallel               GNU parallel"
  "munge                  authentication of Slurm"
  "slurm-wlm              Slurm"
)
package_packages=(
  "help2man               manual page"
  "dpkg-dev               Debian packages"
  "debootstrap            a fresh Debian to try them in"
  "${python_packages[@]}"
)

fail() {
  printf 'install_dependencies: %s\n' "$@" >&2
  exit 1
}

wanted=("${build_packages[@]}")
case "${1-}" in
  "") ;;
  --test) wanted+=("${test_packages[@]}") ;;
  --check) wanted+=("${test_packages[@]}" "${check_packages[@]}") ;;
  --cluster) wanted+=("${test_packages[@]}" "${cluster_packages[@]}") ;;
  --package) wanted+=("${package_packages[@]}") ;;
  *) fail "unknown argument '$1'; allowed: --test, --check, --cluster, --package" ;;
esac

if ! command -v apt-get >/dev/null; then
  echo "This system has no apt-get. musclesim needs (Debian's names):" >&2
  printf '  %s\n' "${wanted[@]}" >&2
  echo "Going on; the build says what it does not find." >&2
  exit 0
fi

is_installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed* ]]
}

missing=()
for line in "${wanted[@]}"; do
  package=${line%% *}
  is_installed "$package" && continue
  ((${#missing[@]})) || echo "Missing packages:" >&2
  missing+=("$package")
  printf '  %s\n' "$line" >&2
done
((${#missing[@]})) || exit 0

as_root=(env DEBIAN_FRONTEND=noninteractive)
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    fail "the packages above are missing, and installing them takes root; as root, run" "    apt-get install ${missing[*]}"
  fi
  as_root=(sudo "${as_root[@]}")
fi

# Runs a command quietly; its output appears only if it fails.
output=$(mktemp)
trap 'rm -f "$output"' EXIT
quietly() {
  "$@" </dev/null >"$output" 2>&1 && return
  cat "$output" >&2
  return 1
}

echo "Installing ${#missing[@]} packages with apt-get ..." >&2
if ((EUID != 0)); then
  sudo true || fail "sudo was refused; as root, run" "    apt-get install ${missing[*]}"
fi
apt=("${as_root[@]}" apt-get -o DPkg::Lock::Timeout=300)
quietly "${apt[@]}" update || fail "apt-get update failed (output above); is there a network connection?"
quietly "${apt[@]}" install --yes --no-install-recommends "${missing[@]}" ||
  fail "apt-get install failed (output above); musclesim is developed on Debian 12"
