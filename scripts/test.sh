#!/usr/bin/env bash
# usage: test.sh [release|asan|nightly]
# Installs what is missing, builds, and runs the tests. `release`: those of a normal build. `asan`:
# readers, fabric, units and a frame of each preset under AddressSanitizer and UBSan. Without an
# argument both, which is what CI runs. `nightly`: all that these leave out. tests/README.md says
# which is where. Stops at the first suite that fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/debian_packages.sh
release() {
  scripts/setup.sh release
  ctest --preset release
}
asan() {
  install_missing clang libclang-rt-14-dev lld
  scripts/setup.sh asan sanitized_tests
  ctest --preset asan
}
nightly() {
  # For the page that report.py makes, shared studies of explore.py, and faults of write_faults.py.
  install_missing chromium postgresql strace clang libclang-rt-14-dev lld
  scripts/setup.sh release
  ctest --preset release_nightly
  scripts/setup.sh asan
  ctest --preset asan_nightly
}
case "$*" in
  release | asan | nightly) suites=("$1") ;;
  '') suites=(release asan) ;;
  *) echo "usage: test.sh [release|asan|nightly]" >&2; exit 2 ;;
esac
scripts/tools.sh
scripts/tools.sh verilog
for suite in "${suites[@]}"; do "$suite"; done
