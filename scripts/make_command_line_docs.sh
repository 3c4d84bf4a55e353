#!/usr/bin/env bash
# Writes docs/reference/command_line.md: the help of the program and of all its sub-commands.
#
#     scripts/make_command_line_docs.sh [build folder]   (default: build/release)
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
program=$(readlink -f "${1:-$root/build/release}/musclesim")
[[ -x $program ]] || { echo "make_command_line_docs.sh: there is no program $program; build it first" >&2; exit 1; }

# sub_commands [SUB-COMMAND]: the names in the help's last section.
sub_commands() {
  "$program" "$@" --help | awk '/^Subcommands:/ { listed = 1; next } listed && /^  [a-z]/ { print $1 }'
}
# describe SUB-COMMAND...: its help, and that of its own sub-commands.
describe() {
  printf '\n## musclesim%s\n\n```\n' "${*:+ $*}"
  "$program" "$@" --help | sed -e 's/[[:space:]]*$//' | cat -s
  printf '```\n'
  local name
  for name in $(sub_commands "$@"); do describe "$@" "$name"; done
}

{
  cat <<'TEXT'
# Command line

<!-- Made by scripts/make_command_line_docs.sh; do not edit. -->

`musclesim COMMAND --help` prints the same. `--set` and `--config` change [parameters](parameters.md), `--effects` adds [effects](effects.md). [Exit statuses](../user/getting_started.md#exit-status) are the same for all commands.
TEXT
  describe
} >"$root/docs/reference/command_line.md.partial"
mv "$root/docs/reference/command_line.md.partial" "$root/docs/reference/command_line.md"
echo "docs/reference/command_line.md" >&2
