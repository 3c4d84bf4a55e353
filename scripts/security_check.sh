#!/usr/bin/env bash
# No network and no shell: the program and the library may import no function of either. Usage: security_check.sh [PROGRAM]
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
program=${1:-$root/build/release/musclesim}
forbidden='socket|connect|bind|listen|accept|sendto|recvfrom|getaddrinfo|gethostbyname|system|popen|wordexp|execlp|execvp|posix_spawnp'
status=0
if nm -D --undefined-only "$program" | sed 's/@.*//' | grep -wE "U ($forbidden)"; then
  echo "the program imports these"
  status=1
else
  echo "of the network's and the shell's functions the program imports none: $(tr '|' ' ' <<<"$forbidden")"
fi
if grep -rnE '\b(std::)?(system|popen)\(' "$root"/{base,src,sweep,simulation,log,diagnosis,evaluation,laboratory,effect,robot,controller}; then
  echo "the sources call these"
  status=1
fi
echo "processes are started with argument vectors: $(nm -D --undefined-only "$program" | sed 's/@.*//' | grep -wE 'U (fork|execv|execve|posix_spawn)' | awk '{ print $2 }' | paste -sd ' ')"
report=$(mktemp -d)
trap 'rm -rf "$report"' EXIT
printf '%s\n' 'time_s,command_0,pressure_0,length_0_mm' >"$report/r.csv"
for ((i = 0; i < 60; ++i)); do echo "0.$(printf %02d $i),0.5,0.5,20$((i % 10))"; done >>"$report/r.csv"
printf '{"format": "musclesim-recording-1", "robot": "rig", "description": "<script>alert(1)</script>"}\n' >"$report/r.json"
if "$program" diagnose "$report/r.csv" --candidates force_gain --max-effects 1 --out "$report/out" --quiet >/dev/null 2>"$report/error"; then
  if grep -qE '<script>alert|(src|href)="https?:' "$report/out/report.html"; then
    echo "the report holds what a recording wrote, or loads something"
    status=1
  else
    echo "the report escapes a script in a recording's description and loads nothing"
  fi
else
  echo "the diagnosis refused the recording: $(head -c 200 "$report/error")"
fi
printf 'limits (files and rows): %s\n' "$(grep -rhoE '[a-z_]*limit_bytes = [^;]*|(row|column|cell)_count = [1-9][0-9\x27]+|line_bytes = std[^;]*|most_(sweep|argument)[a-z_]* = [1-9][^,;]*' "$root"/include "$root"/log "$root"/sweep "$root"/simulation "$root"/effect "$root"/laboratory | sort -u | paste -sd ';' | sed 's/;/; /g')"
exit "$status"
