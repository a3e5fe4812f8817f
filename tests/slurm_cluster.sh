#!/bin/sh
# A Slurm cluster on this machine, for tests: munged, slurmctld and slurmd of two nodes with a core each, on loopback, all
# that they write in one folder. As root (slurmd wants it), with Debian's packages slurm-wlm and munge.
# Usage: slurm_cluster.sh start|stop|stop-node|start-node DIR [NODE]; then SLURM_CONF=DIR/slurm.conf for sbatch and the like.
set -eu
command=$1 dir=$(realpath -m "$2") node=${3:-node1}
port=${ROEVO_SLURM_PORT:-16817}
export SLURM_CONF="$dir/slurm.conf"

die() {
    echo "slurm_cluster.sh: error: $*" >&2
    exit 1
}

# Waits until a command does well.
soon() {
    for _ in $(seq 100); do
        "$@" >/dev/null 2>&1 && return
        sleep 0.1
    done
    die "it did not come to: $*"
}

configure() {
    mkdir -p "$dir/state"
    head -c 64 /dev/urandom >"$dir/munge.key"
    chmod 700 "$dir"
    chmod 600 "$dir/munge.key"
    cat >"$SLURM_CONF" <<EOF
ClusterName=roevo
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
SlurmctldPort=$port
SlurmctldPidFile=$dir/slurmctld.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdPidFile=$dir/%n.pid
SlurmdLogFile=$dir/%n.log
SlurmdSpoolDir=$dir/%n.spool
StateSaveLocation=$dir/state
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=1
JobAcctGatherParams=OverMemoryKill
AccountingStorageType=accounting_storage/none
SlurmdParameters=config_overrides
SlurmdTimeout=10
KillWait=2
ReturnToService=2
NodeName=node1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1 RealMemory=8000
NodeName=node2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1 RealMemory=8000
PartitionName=batch Nodes=node[1-2] Default=YES State=UP MaxTime=INFINITE
EOF
}

start_node() {
    slurmd -N "$1"
}

# By the number that it has written itself.
stop_program() {
    [ -f "$dir/$1.pid" ] && kill "${2:--TERM}" "$(cat "$dir/$1.pid")" 2>/dev/null || true
}

case $command in
start)
    for program in munged slurmctld slurmd sbatch; do
        command -v $program >/dev/null || die "there is no $program (packages slurm-wlm, munge)"
    done
    configure
    munged --force --socket="$dir/munge.socket" --key-file="$dir/munge.key" --pid-file="$dir/munged.pid" \
        --log-file="$dir/munged.log" --seed-file="$dir/munged.seed"
    slurmctld
    for each in node1 node2; do start_node $each; done
    soon sh -c "[ \$(sinfo --noheader --Node --states=idle | wc -l) = 2 ]"
    ;;
stop)
    for each in node1 node2 slurmctld munged; do stop_program $each; done
    ;;
stop-node) stop_program "$node" -KILL ;; # as if its power went: slurmd does not tell anybody
start-node) start_node "$node" ;;
*) die "unknown command '$command'" ;;
esac
