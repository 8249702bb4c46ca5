#!/usr/bin/env bash
# usage: sbatch [--array=1-N] scripts/explore_array.sh --study NAME --storage URL EXPLORE_ARGUMENT...
# Workers of one study of explore.py on the machines of a cluster that Slurm runs: each task of the
# array is one. URL: a database that all of them reach, postgresql://USER@HOST/NAME. A task that is
# killed, or whose machine dies, may be started again; its configuration is taken up by the others.
#SBATCH --job-name=explore
#SBATCH --array=1-4
#SBATCH --cpus-per-task=2
#SBATCH --requeue
set -euo pipefail
[ -n "${SLURM_ARRAY_TASK_ID:-}" ] || { echo "explore_array.sh: expected to be started by sbatch" >&2; exit 2; }
# Slurm runs a copy of this file from a folder of its own.
cd "${SLURM_SUBMIT_DIR:?}"
[ -x scripts/explore.py ] || { echo "explore_array.sh: ${PWD}: no scripts/explore.py, expected sbatch to be called in the repository" >&2; exit 2; }
exec scripts/explore.py "$@" -j "${SLURM_CPUS_PER_TASK:-1}" \
  --out "out/explore_${SLURM_ARRAY_JOB_ID}/${SLURM_ARRAY_TASK_ID}"
