#!/bin/bash
# A batch job for Slurm: one scene on all ranks of the allocation, over as many jobs as it takes.
#   sbatch -n 16 scripts/hpc/slurm.sh inputs/hertz2d.yml -adapt_tolerance 0.01
# Further arguments go to mortise. Results land in the scene's output.directory under the directory the job was submitted from.
# Two minutes before the time limit Slurm tells mortise to stop (SIGUSR1): it writes a checkpoint and ends with status 3. The job is then queued again under
# its number and goes on from there, until mortise ends with another status, at most MORTISE_JOBS times (default 100). A job that Slurm itself queues again
# (a node failed, or was taken away) goes on from the checkpoint of its last load step.
#SBATCH --job-name=mortise
#SBATCH --ntasks=4
#SBATCH --cpus-per-task=1
#SBATCH --time=02:00:00
#SBATCH --signal=USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=mortise-%j.log
set -eu
: "${1:?usage: sbatch scripts/hpc/slurm.sh SCENE.yml [options]}"
cd "${SLURM_SUBMIT_DIR:-.}"
mortise=${MORTISE:-bin/mortise}
[ -n "${MORTISE:-}" ] || [ -x "$mortise" ] || mortise=mortise # installed
before=${SLURM_RESTART_COUNT:-0}
[ "$before" -gt 0 ] && set -- "$@" -restart auto

# One thread a rank: ranks scale, threads of the dense kernels only get in each other's way.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1

# Wrong input is found here, before the allocation is spent on it.
"$mortise" "$@" -check
status=0
srun --cpu-bind=cores "$mortise" "$@" -log_view || status=$?
[ $status -eq 3 ] || exit $status
[ "$before" -lt "${MORTISE_JOBS:-100}" ] || { echo "slurm.sh: stopped after $before jobs more; MORTISE_JOBS allows no further one" >&2; exit 3; }
scontrol requeue "$SLURM_JOB_ID"
