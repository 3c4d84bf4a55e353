# Shared by the scripts in this folder; expects the project's folder in $root.
# shellcheck shell=bash disable=SC2154

say() { printf '%s\n' "$*" >&2; }

# build_preset PRESET TARGET [OPTION...]: configures and builds a preset; OPTIONs count only when it is configured for the first time.
# On a terminal the build shows its progress; elsewhere only what failed is printed.
build_preset() {
  local preset=$1 target=$2 folder="$root/build/$1" status=0 output
  shift 2
  local configure=(cmake --preset "$preset") configured_for
  configured_for=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$folder/CMakeCache.txt" 2>/dev/null) || true
  if [[ ! -f $folder/build.ninja ]]; then
    configure+=("$@")
  elif [[ ! $configured_for -ef $root ]]; then
    configure+=(--fresh "$@")  # the folder was copied or moved
  fi
  if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi

  say "Building the $preset preset in build/$preset ..."
  output=$(mktemp)
  (cd "$root" && "${configure[@]}" --log-level=WARNING) >"$output" 2>&1 || status=$?
  if ((status == 0)); then
    if [[ -t 2 ]]; then
      cmake --build "$folder" --target "$target" >&2 || status=$?
    else
      cmake --build "$folder" --target "$target" >"$output" 2>&1 || status=$?
    fi
  fi
  if ((status != 0)); then
    grep -v '^\[[0-9]*/[0-9]*\] [A-Z][a-z]*ing ' "$output" >&2 || true
    say "The $preset preset does not build (see above)."
  fi
  rm -f "$output"
  return "$status"
}

# section_line first|last NAME COMMAND: the lines between which COMMAND writes the section NAME of a document.
section_line() {
  case $1 in
    first) printf '<!-- %s: written by %s -->\n' "$2" "$3" ;;
    last) printf '<!-- end of %s -->\n' "$2" ;;
  esac
}

# require_section DOCUMENT NAME COMMAND: ends the script if the document has no such section.
require_section() {
  local first last
  first=$(section_line first "$2" "$3") last=$(section_line last "$2" "$3")
  grep -qxF -- "$first" "$1" && grep -qxF -- "$last" "$1" && return
  say "${0##*/}: $1 has no section \"$first\" .. \"$last\""
  exit 1
}

# write_section DOCUMENT NAME COMMAND TEXT: replaces what stands in the section.
write_section() {
  local document
  document=$(awk -v first="$(section_line first "$2" "$3")" -v last="$(section_line last "$2" "$3")" -v text="$4" '
    $0 == first { print; print ""; print text; print ""; inside = 1; next }
    $0 == last { inside = 0 }
    !inside { print }' "$1")
  printf '%s\n' "$document" >"$1"
}
