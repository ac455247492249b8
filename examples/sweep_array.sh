#!/bin/sh
# A sweep as a job array of SLURM: each task computes its part of the chunks, all into one folder.
#
#     sbatch examples/sweep_array.sh
#
# A task that is killed resumes when it is submitted again, for example with sbatch --array=7. When all
# have ended, the same command without --chunks writes summary.html.
#SBATCH --job-name=gains
#SBATCH --array=1-16
#SBATCH --cpus-per-task=4
#SBATCH --time=01:00:00
#SBATCH --mem=2G

STUDY=${STUDY:-examples/gain_sweep.toml}
OUT=${OUT:-gains}

# The number of parts stays that of the whole array when some tasks are submitted again.
PARTS=${PARTS:-16}

exec hrsafety sweep "$STUDY" --out "$OUT" --store parquet \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --chunks "$SLURM_ARRAY_TASK_ID/$PARTS"
