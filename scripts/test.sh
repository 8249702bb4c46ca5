#!/usr/bin/env bash
# usage: test.sh [release|asan|full]
# Installs what is missing, builds, and runs the tests: `release` those of a normal build, `asan`
# most of them under AddressSanitizer and UBSan (tests/README.md); first one, then the other if
# neither is named. `full` is release with those on the big scenes, the long fuzzing, and a build of
# each source by itself. Stops at the first suite that fails.
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
