# shellcheck shell=bash
# Starts and stops a Slurm cluster with one node, this machine; slurm.sh sources this file. All
# files of the cluster lie in one folder. Several clusters may run side by side, since each has its
# own ports, munge daemon and key. stop_cluster ends all processes of the cluster.

# Slurm's daemons lie in these folders, which not every PATH has.
PATH=$PATH:/usr/sbin:/sbin

# start_cluster FOLDER CPUS: starts the cluster and exports SLURM_CONF. munge requires that
# everybody may enter the folder. The node pretends to have CPUS processors. The cluster has two
# partitions, `batch` and `urgent`; jobs of `urgent` preempt those of `batch`.
start_cluster() {
    local folder=$1 cpus=$2 host user program ports
    for program in munged slurmctld slurmd sbatch scontrol srun; do
        command -v $program >/dev/null || { echo "$program is not installed; tools/setup farm installs it" >&2; exit 1; }
    done
    host=$(hostname -s) user=$(id -un)
    read -ra ports < <(/usr/bin/python3 -c '
import socket
free = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
print(*(each.getsockname()[1] for each in free))')
    mkdir -p "$folder"/{munge,state,spool}
    chmod 755 "$folder" "$folder/munge"
    head -c 1024 /dev/urandom >"$folder/munge/key"
    chmod 400 "$folder/munge/key"
    # cred_expire is how long a requeued job waits, in seconds; 5 is the least that Slurm allows.
    # proctrack/pgid finds the processes of a step by their process group, without cgroups.
    cat >"$folder/slurm.conf" <<END
ClusterName=kiln
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmdPort=${ports[1]}
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$folder/munge/socket,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
MailProg=/bin/true
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/jobs.log
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=bf_interval=1,sched_interval=2
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
KillWait=5
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cpus RealMemory=16000 State=UNKNOWN
PartitionName=batch Nodes=ALL Default=YES PriorityTier=1 GraceTime=2 State=UP
PartitionName=urgent Nodes=ALL PriorityTier=2 PreemptMode=OFF State=UP
END
    export SLURM_CONF=$folder/slurm.conf
    munged --foreground --num-threads=2 --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
        --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" >"$folder/munge.log" 2>&1 &
    until [[ -S $folder/munge/socket ]] || ! kill -0 $! 2>/dev/null; do
        sleep 0.1
    done
    slurmctld -D 2>/dev/null &
    slurmd -D 2>/dev/null &
    disown -a # so that bash prints no message when they end
    local last=$((SECONDS + 30))
    while ((SECONDS < last)); do
        [[ $(sinfo --noheader --partition=batch --format=%T 2>/dev/null) != idle ]] || return 0
        sleep 0.2
    done
    tail -- "$folder"/*.log >&2
    echo "the cluster has not started within 30 seconds" >&2
    exit 1
}

# cluster_processes: prints the processes of the cluster, its daemons and jobs. They are those whose
# environment has the cluster's SLURM_CONF.
cluster_processes() {
    env -u SLURM_CONF grep -lzxF "SLURM_CONF=$SLURM_CONF" /proc/[0-9]*/environ 2>/dev/null | cut -d / -f 3
}

# stop_cluster: kills all processes of the cluster, if it was started. Fails if some do not end
# within 5 seconds.
stop_cluster() {
    [[ ${SLURM_CONF:-} ]] || return 0
    local left tries
    for ((tries = 0; tries < 50; tries++)); do
        mapfile -t left < <(cluster_processes)
        ((${#left[@]} > 0)) || return 0
        kill -KILL "${left[@]}" 2>/dev/null || true # some have ended
        sleep 0.1
    done
    echo "processes of the cluster do not end: ${left[*]}" >&2
    return 1
}
