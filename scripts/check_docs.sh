#!/usr/bin/env bash
# Checks the project's Markdown files: every relative link leads to a file, and to a heading where it names one; every file and every test
# that docs/developer/equations.md names exists.
# Usage: scripts/check_docs.sh [folder]   (default: the project). Exit status 1 if something is missing; each is listed.
set -euo pipefail
cd "${1:-"$(dirname "${BASH_SOURCE[0]}")/.."}"

# The anchors of a file's headings, as GitHub makes them: lower case, spaces to hyphens, punctuation dropped.
anchors_of() {
  awk '/^(```|~~~)/ { in_code = !in_code } !in_code && /^#+ / { sub(/^#+ +/, ""); print }' "$1" |
    tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

# "line<TAB>target" of every inline link and image outside code blocks and code spans.
links_of() {
  awk '
    /^(```|~~~)/ { in_code = !in_code; next }
    in_code { next }
    {
      text = $0
      gsub(/`[^`]*`/, "", text)
      while (match(text, /\]\([^()[:space:]]+( +"[^"]*")?\)/)) {
        target = substr(text, RSTART + 2, RLENGTH - 3)
        sub(/ +"[^"]*"$/, "", target)
        print NR "\t" target
        text = substr(text, RSTART + RLENGTH)
      }
    }' "$1"
}

broken=0 checked=0
complain() {
  echo "$1"
  broken=$((broken + 1))
}

while IFS= read -r document; do
  while IFS=$'\t' read -r line target; do
    case "$target" in http://* | https://* | mailto:*) continue ;; esac
    checked=$((checked + 1))
    path="${target%%#*}" anchor=""
    [[ "$target" == *#* ]] && anchor="${target#*#}"
    file="$document"
    [[ -n "$path" ]] && file="$(dirname "$document")/$path"
    if [[ ! -e "$file" ]]; then
      complain "$document:$line: there is no $target"
    elif [[ -n "$anchor" && "$file" == *.md ]] && ! anchors_of "$file" | grep -qxF -- "$anchor"; then
      complain "$document:$line: $file has no heading #$anchor"
    fi
  done < <(links_of "$document")
done < <(find . -name '*.md' -not -path './build/*' -not -path './.git/*' -not -path './log/runs/*' | sort)

equations=docs/developer/equations.md
if [[ -e "$equations" ]]; then
  while IFS= read -r name; do
    checked=$((checked + 1))
    grep -rqE "^TEST(_F|_P)?\\(${name%.*}, ${name#*.}\\)" tests || complain "$equations: there is no test $name"
  done < <(grep -oE '`[A-Z][A-Za-z0-9]*\.[A-Z][A-Za-z0-9]*`' "$equations" | tr -d '`' | sort -u)
  while IFS= read -r file; do
    checked=$((checked + 1))
    [[ -e "$file" ]] || complain "$equations: there is no file $file"
  done < <(grep -oE '`[a-z_]+/[a-z_/]+\.(cpp|h)`' "$equations" | tr -d '`' | sort -u)
fi

echo "$checked links and names checked, $broken broken"
[[ "$broken" -eq 0 ]]
