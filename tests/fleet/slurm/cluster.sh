# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# A Slurm cluster of one node, to be sourced: everything that it writes is in $cluster, and it is heard on loopback only.
#
#   cluster=/some/folder, then  in_namespaces SCRIPT ARGUMENT...; start_cluster; stop_node; start_node
#
: "${cluster:?is the folder}"
export SLURM_CONF=$cluster/slurm.conf

# in_namespaces SCRIPT ARGUMENT...: does the script in namespaces of its own for processes, mounts, network and host name,
# and ends as it ends; returns where that is done already. The daemons take no port of the machine there, and they and
# whatever they have started end with the script, however that ends. A second address lets names be resolved, which is not
# done where the machine has none but 127.0.0.1.
in_namespaces() {
    [[ ${fidservo_in_namespaces:-} == yes ]] && return
    ((EUID == 0)) || { echo "a cluster needs root" >&2 && exit 2; }
    fidservo_in_namespaces=yes unshare --mount --propagation private --pid --fork --kill-child=KILL --mount-proc --net --uts \
        bash -c 'hostname localhost && ip link set lo up && ip address add 127.0.0.2/8 dev lo && exec "$@"' _ "$@" &
    namespaces=$!
    trap 'kill -KILL "$namespaces" 2>/dev/null' EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM HUP
    wait "$namespaces"
    exit
}

# A node of two cores, whatever the machine has. A task that is queued again waits until the credential of its first
# start is void (cred_expire), two minutes if nothing is said. A node that says nothing for SlurmdTimeout is down.
write_configuration() {
    cat >"$SLURM_CONF" <<CONFIGURATION
ClusterName=fidservo
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=6817
SlurmdPort=6818
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$cluster/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SlurmdTimeout=15
ReturnToService=0
MinJobAge=86400
SchedulerParameters=sched_interval=5
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 Boards=1 SocketsPerBoard=1 CoresPerSocket=2 ThreadsPerCore=1 RealMemory=8000 State=UNKNOWN
PartitionName=fleet Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONFIGURATION
}

# until_true SECONDS WHAT COMMAND...: waits for it.
until_true() {
    local seconds=$1 what=$2 begin=$SECONDS
    shift 2
    until "$@"; do
        ((SECONDS - begin < seconds)) || { echo "$what: not within $seconds s; see $cluster/*.log" >&2 && return 1; }
        sleep 0.2
    done
}

node_state() { sinfo --noheader --format=%T 2>/dev/null || true; }
node_works() { [[ $(node_state) =~ ^(idle|mixed|allocated)$ ]]; }
node_is_down() { [[ $(node_state) == down* ]]; }

# start_node: its daemon; again after stop_node. It finds what it had started, as it would not with -c, which ends that.
start_node() { slurmd; }

nothing_at_work() { ! pgrep slurmstepd >/dev/null; }

# resume_node: as whoever looks after a node does that was given up, when its daemon is there again and has ended what was
# begun again elsewhere. Slurm 22.05 refuses to start a job again within the second in which it is told that it was ended,
# and lets it fail.
resume_node() {
    until_true 60 "what the node did before" nothing_at_work
    sleep 2
    scontrol update NodeName=localhost State=RESUME
    until_true 60 "the node" node_works
}

# stop_node: its daemon is killed; what it has started goes on.
stop_node() { kill -KILL "$(<"$cluster/slurmd.pid")"; }

start_cluster() {
    rm -rf "$cluster"
    mkdir -p "$cluster"/{state,spool}
    chmod 755 "$cluster" "$cluster"/{state,spool}
    write_configuration
    dd if=/dev/urandom of="$cluster/munge.key" bs=1024 count=1 status=none
    chmod 600 "$cluster/munge.key"
    munged --key-file="$cluster/munge.key" --socket="$cluster/munge.socket" --pid-file="$cluster/munge.pid" \
        --log-file="$cluster/munge.log" --seed-file="$cluster/munge.seed"
    slurmctld -c
    start_node
    until_true 60 "the node" node_works
}
