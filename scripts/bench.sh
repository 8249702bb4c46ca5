#!/usr/bin/env bash
# Builds the benchmarks and runs every one (build/release/bin/bench_*) on the real scenes
# of ../shared, or on the built-in scenes where those are missing. Each benchmark takes scenes as
# its arguments: .ply files with their cameras beside them (NAME.json), or builtin:NAME?n=COUNT.
# Arguments replace the scenes. Exit status 1 when a benchmark misses its budget.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh release benchmarks

shared=${SGS_SHARED:-../shared}
scenes=("$@")
if [ ${#scenes[@]} -eq 0 ] && [ -f "$shared/scenes/expand.sh" ]; then
  folder=build/release/scenes
  echo "unpacking the scenes of $shared to $folder"
  sh "$shared/scenes/expand.sh" "$folder"
  for ply in "$folder"/*.ply; do
    name=$(basename "$ply" .ply)
    cp -f "$shared/cameras/$name.json" "$folder/"
    scenes+=("$ply")
  done
fi
if [ ${#scenes[@]} -eq 0 ]; then
  scenes=('builtin:object' 'builtin:outdoor' 'builtin:outdoor?n=1000000')
fi

failed=0
for bench in build/release/bin/bench_*; do
  echo
  if [ "${bench##*/}" != bench_renderers ]; then
    "$bench" "${scenes[@]}" || failed=1
    continue
  fi
  for scene in "${scenes[@]}"; do
    cameras=${scene%.*}.json
    "$bench" "$scene" $([ -f "$cameras" ] && echo --cameras "$cameras") || failed=1
  done
done
exit $failed
