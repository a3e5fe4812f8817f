"""Snakemake, on this machine or with Slurm."""

import ctypes
import hashlib
import json
import os
import re
import shlex
import signal
import subprocess

from messages import Fault, Progress

SHARE = os.path.dirname(os.path.realpath(__file__))
JOBS_AT_ONCE = 1000  # given to Snakemake


def side_by_side(args):
    return args.jobs or (200 if args.profile else len(os.sched_getaffinity(0)))


def engine(args, jobs):
    command = ["snakemake", "--snakefile", os.path.join(SHARE, "Snakefile"), "--nolock", "--ignore-incomplete",
               "--drop-metadata", "--keep-going", "--scheduler", "greedy", "--rerun-triggers", "mtime"]
    if args.profile != "slurm":
        if args.profile:
            return command + ["--profile", args.profile, "--jobs", str(side_by_side(args))]
        command += ["--cores", str(side_by_side(args))]
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e6
        # So many at a time as have their memory, but always one
        return command + ["--resources", f"mem_mb={round(max(0.9 * memory, jobs[0]['mem_mb']))}"]
    log = "--output=logs/{wildcards.sequence}/{wildcards.method}.slurm.log"
    submit = ["sbatch", "--parsable", f"--job-name={slurm_name(args)}", "--ntasks=1", "--cpus-per-task=1",
              "--mem={resources.mem_mb}M", "--time={resources.runtime}", log, "--open-mode=truncate"]
    return command + ["--jobs", str(side_by_side(args)), "--latency-wait", "30", "--max-jobs-per-second", "50",
                      "--max-status-checks-per-second", "50", "--cluster-cancel", "scancel",
                      "--cluster-status", shlex.quote(os.path.join(SHARE, "slurm_status.sh")), "--cluster",
                      " ".join(submit + [shlex.quote(os.path.join(SHARE, "slurm_job.sh")), "{params.command:q} {log:q}"])]


def slurm_name(args):
    return "roevo-" + hashlib.sha256(args.output.encode()).hexdigest()[:12]


def cancel_left_over(args):
    """Jobs of a batch that was killed: they would make the same rows."""
    name = f"--name={slurm_name(args)}"
    try:
        subprocess.run(["scancel", "--signal=KILL", name], check=True)
        subprocess.run(["scancel", name], check=True)
        while subprocess.run(["squeue", "--noheader", name], capture_output=True, check=True).stdout.strip():
            subprocess.run(["sleep", "0.5"], check=True)
    except (OSError, subprocess.CalledProcessError) as e:
        raise Fault(f"Slurm does not answer: {e}") from e


def make_rows(args, jobs):
    """@return whether it was interrupted"""
    for job in jobs:
        os.makedirs(os.path.join("logs", job["sequence"]), exist_ok=True)
    # Snakemake looks at all jobs that wait whenever one ends
    most = max(JOBS_AT_ONCE, 20 * side_by_side(args))
    progress = Progress(args, len(jobs))
    interrupted = False
    for begin in range(0, len(jobs), most):
        interrupted = interrupted or run_engine(args, jobs[begin : begin + most], begin, progress)
    progress.finish()
    return interrupted


def end_with_parent():
    """Snakemake starts no more jobs when roevo-batch is gone, whatever has ended that."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)


def run_engine(args, jobs, before, progress):
    with open("batch/jobs.json", "w", encoding="utf-8") as file:
        json.dump(jobs, file)
    # Not in the group that Ctrl-C reaches, or it would be told twice
    process = subprocess.Popen(engine(args, jobs), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True,
                               preexec_fn=end_with_parent)
    told = []

    def stop(*_):
        told.append(True)
        os.killpg(process.pid, signal.SIGINT)

    before_this = {each: signal.signal(each, stop) for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    with open("logs/engine.log", "a", encoding="utf-8") as log:
        for line in process.stdout:
            log.write(line)
            log.flush()
            steps = re.match(r"(\d+) of \d+ steps", line)
            if steps:
                progress.update(before + min(int(steps[1]), len(jobs)))
    process.wait()
    for each, handler in before_this.items():
        signal.signal(each, handler)
    return bool(told)
