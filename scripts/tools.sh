#!/usr/bin/env bash
# usage: tools.sh
# Installs the Debian packages that figures and searches need, beside those of setup.sh, if they are
# missing: Matplotlib, Optuna, and what it needs for PostgreSQL.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ $# -eq 0 ] || { echo "usage: tools.sh" >&2; exit 2; }
. scripts/debian_packages.sh
install_missing python3-matplotlib python3-optuna python3-psycopg2
