#!/usr/bin/env bash
# usage: fuzz.sh [--help] [READER...] [SECONDS]
# Builds the fuzzers (preset `fuzz`: clang, libFuzzer, AddressSanitizer, UBSan) and runs those of the
# readers named, else of all, for so many seconds each (60): an input that takes 30 s or 2 GB, a
# sanitizer's complaint, or anything thrown but InputError ends that reader's run and is kept in
# build/fuzz/findings. What grew of the seeds in tests/fuzz/corpus stays in build/fuzz/corpus, and the
# next run goes on with it. Prints what all runs since came to; exit status 1 where one found something.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seeds=tests/fuzz/corpus
refuse() { echo "fuzz.sh: $1" >&2; exit 2; }

seconds=60
readers=()
for word in "$@"; do
  case "$word" in
    --help)
      sed -n '2,/^[^#]/s/^# //p' scripts/fuzz.sh
      echo "Readers: $(ls $seeds | xargs)"
      exit 0 ;;
    -*) sed -n 's/^# usage: /usage: /p' scripts/fuzz.sh >&2; exit 2 ;;
    *[!0-9]*) readers+=("$word") ;;
    *[1-9]*) seconds=$word ;;
    *) refuse "SECONDS: got '$word', expected 1 or more" ;;
  esac
done
for reader in "${readers[@]}"; do
  ls $seeds | grep -Fxq -e "$reader" || refuse "$reader: no such reader, expected of: $(ls $seeds | xargs)"
done

. scripts/debian_packages.sh
install_missing clang libclang-rt-14-dev
scripts/setup.sh fuzz >&2

declare -A programs
names=()
for program in build/fuzz/bin/fuzz_*; do
  for reader in $("$program" --list); do
    programs[$reader]=$program
    names+=("$reader")
  done
done
for reader in "${readers[@]}"; do
  [ -n "${programs[$reader]:-}" ] || refuse "$reader: no such reader, expected of: ${names[*]}"
done

state=build/fuzz
mkdir -p $state/findings
scratch=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")" sgs-fuzz-XXXXXX)
trap 'rm -rf "$scratch"' EXIT

# One line of runs.tsv: reader, seconds, executions, inputs in the corpus, findings.
fuzz() {
  local reader=$1 corpus=$state/corpus/$1 log=$state/$1.log found=0 began=$SECONDS runs
  mkdir -p "$corpus" "$scratch/$reader"
  "${programs[$reader]}" --reader="$reader" --folder="$scratch/$reader" -max_total_time="$seconds" \
    -timeout=30 -rss_limit_mb=2048 -print_funcs=0 -print_final_stats=1 \
    -artifact_prefix="$state/findings/$reader-" "$corpus" "$seeds/$reader" \
    >"$log" 2>&1 </dev/null || found=1
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '%s\t%d\t%d\t%d\t%d\n' "$reader" $((SECONDS - began)) "${runs:-0}" \
    "$(find "$corpus" -type f | wc -l)" "$found" >>$state/runs.tsv
  [ $found -eq 0 ] || grep -m 1 -E 'ERROR:|SUMMARY:|runtime error|what\(\)' "$log" | sed "s/^/$reader: /" >&2
  return $found
}

status=0
for reader in "${readers[@]:-${names[@]}}"; do
  fuzz "$reader" || status=1
done
awk -F'\t' 'BEGIN { print "| reader | seconds | executions | corpus | findings |\n| --- | ---: | ---: | ---: | ---: |" }
  !($1 in s) { order[++n] = $1 }
  { s[$1] += $2; e[$1] += $3; c[$1] = $4; f[$1] += $5 }
  END { for (i = 1; i <= n; ++i) { r = order[i]; printf "| %s | %d | %d | %d | %d |\n", r, s[r], e[r], c[r], f[r]; t += s[r] }
        printf "%.2f hours\n", t / 3600 }' $state/runs.tsv
exit $status
