#!/bin/sh
# What has become of a job, for Snakemake, in the output folder: running, success or failed. Needs no accounting. The
# queue is asked every few seconds at most, for all jobs together.
if [ ! -f "batch/ended/$1" ]; then
    queue=batch/queue
    if [ -z "$(find $queue -newermt '-3 seconds' 2>/dev/null)" ]; then
        squeue --noheader --me --format=%i >$queue.new && mv $queue.new $queue || { echo running && exit; }
    fi
    grep -qx "$1" $queue && echo running && exit
    squeue --noheader --jobs="$1" --format=%i 2>/dev/null | grep -q . && echo running && exit # younger than the list
    sleep 1 # what a node has written may take a moment on a shared folder
fi
[ "$(cat "batch/ended/$1" 2>/dev/null)" = 0 ] && echo success || echo failed
