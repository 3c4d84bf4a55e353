#!/usr/bin/env bash
# Draws the pictures of docs/user/own_robot.md with the program of the release build.
#
#     scripts/make_robot_docs.sh
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
# shellcheck source=scripts/common.sh
source "$root/scripts/common.sh"

program=$root/build/release/musclesim
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$program" robot new lever
"$program" robot show lever.toml --picture-size 640x480
cp lever.png "$root/docs/user/figures/own_robot.png"
cp lever-moment-arms.svg "$root/docs/user/figures/own_robot_moment_arms.svg"
