#!/bin/sh
# A job of roevo-batch on a node of a Slurm cluster, in the output folder: COMMAND LOG. The node needs roevo-compare and the
# shared folder, nothing else. Its exit code is kept for slurm_status.sh.
sh -c "$1" >"$2" 2>&1
code=$?
echo $code >"batch/ended/.$SLURM_JOB_ID" && mv "batch/ended/.$SLURM_JOB_ID" "batch/ended/$SLURM_JOB_ID"
exit $code
