#!/usr/bin/env bash
# usage: tools.sh [verilog]
# Installs the Debian packages that figures and searches need, beside those of setup.sh, if they are
# missing: Matplotlib, Optuna, and what it needs for PostgreSQL. `verilog`: those with which the
# datapaths in Verilog are tested and synthesised.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/debian_packages.sh
case "$*" in
  '') install_missing python3-matplotlib python3-optuna python3-psycopg2 ;;
  verilog) install_missing verilator yosys qflow-tech-osu018 ;;
  *) echo "usage: tools.sh [verilog]" >&2; exit 2 ;;
esac
