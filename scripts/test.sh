#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests. With `full` also those on the big scenes and
# the long fuzzing; with `asan` the normal tests under AddressSanitizer and UBSan.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:-release}
case "$preset" in
  release | full) scripts/setup.sh ;;
  asan) SGS_PRESET=asan scripts/setup.sh ;;
  *) echo "usage: test.sh [release|full|asan]" >&2; exit 2 ;;
esac
exec ctest --preset "$preset"
