#!/bin/bash
# A batch job for Slurm: one scene on all ranks of the allocation.
#   sbatch -n 16 scripts/hpc/slurm.sh inputs/hertz2d.yml -adapt_tolerance 0.01
# Further arguments go to mortise. Results land in the scene's output.directory under the directory the job was submitted from.
#SBATCH --job-name=mortise
#SBATCH --ntasks=4
#SBATCH --cpus-per-task=1
#SBATCH --time=02:00:00
#SBATCH --output=mortise-%j.log
set -eu
: "${1:?usage: sbatch scripts/hpc/slurm.sh SCENE.yml [options]}"
cd "${SLURM_SUBMIT_DIR:-.}"
mortise=${MORTISE:-bin/mortise}

# One thread a rank: ranks scale, threads of the dense kernels only get in each other's way.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1

# Wrong input is found here, before the allocation is spent on it.
"$mortise" "$@" -check
exec srun --cpu-bind=cores "$mortise" "$@" -log_view
