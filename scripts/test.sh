#!/usr/bin/env bash
# usage: test.sh [release|asan|full]
# Installs what is missing, builds, and runs the tests: `release` those of a normal build, `asan`
# the same ones under AddressSanitizer and UBSan; first one, then the other if neither is named.
# `full` also runs those on the big scenes and the long fuzzing. Stops at the first suite that fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case "${1:-}" in
  release | asan | full) suites=("$1") ;;
  '') suites=(release asan) ;;
  *) echo "usage: test.sh [release|asan|full]" >&2; exit 2 ;;
esac
scripts/tools.sh
. scripts/debian_packages.sh
# For the page that report.py makes, the studies of explore.py, and faults of write_faults.py.
install_missing chromium postgresql strace
for suite in "${suites[@]}"; do
  scripts/setup.sh "${suite/full/release}"
  ctest --preset "$suite"
done
