#!/bin/sh
# A render in 8 parts by the real Slurm (Debian's slurm-wlm and munge) on loopback, as root: a part is killed and requeued,
# a missing one stops the merge, and the picture is that of one render. Leaves the machine's own Slurm alone.
# Usage: tests/farm/slurm.sh [PROGRAM]
set -eu
program=$(realpath "${1:-target/release/pathtracer}")
scene=$(realpath scenes/bigBalls.yaml)
command -v slurmctld >/dev/null || { echo "needs slurm-wlm" >&2; exit 2; }
folder=$(mktemp -d)
stop() {
    for name in slurmd slurmctld munged; do
        [ -f "$folder/$name.pid" ] && kill "$(cat "$folder/$name.pid")" 2>/dev/null || true
    done
    sleep 1
    rm -rf "$folder"
}
trap stop EXIT
mkdir -p "$folder/state" "$folder/spool" /run/munge /var/log/munge
export SLURM_CONF="$folder/slurm.conf"
cat > "$SLURM_CONF" <<EOF
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
MpiDefault=none
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=render Nodes=localhost Default=YES MaxTime=INFINITE State=UP
EOF
chown munge: /run/munge /var/log/munge
chmod 755 /run/munge
pgrep -x munged >/dev/null || { su -s /bin/sh munge -c "exec /usr/sbin/munged"; cp /run/munge/munged.pid "$folder/munged.pid"; }
slurmctld -f "$SLURM_CONF"
slurmd -N localhost -f "$SLURM_CONF"
for _ in $(seq 60); do sinfo -h -o %T 2>/dev/null | grep -q idle && break; sleep 1; done

render="$scene 400 240 200 6"
cd "$folder"
"$program" $render whole.exr --quiet --threads 1
"$program" farm slurm --parts 8 $render out.exr --threads 1 > job.sh
sh job.sh
for _ in $(seq 60); do squeue -h -t R -r -o '%F_%K' | grep -q '^1_' && break; sleep 1; done
task=$(squeue -h -t R -r -o '%F_%K' | grep '^1_' | head -1)
echo "requeue of the running task $task: it is killed and put back into the queue"
scontrol requeue "$task"
for _ in $(seq 300); do
    [ -z "$(squeue -h)" ] && break
    squeue -h -o %r | grep -q DependencyNeverSatisfied && break
    sleep 1
done
cmp out.exr whole.exr
echo "the picture of the farm is that of one render"

rm out.exr out.exr.parts/part-3.film
echo "kill -9 of a task: it fails, and the merge is cancelled; the same script makes what is missing"
sh job.sh
killed=
for _ in $(seq 600); do
    for pid in $(pgrep -x pathtracer); do
        if { tr '\0' ' ' < "/proc/$pid/cmdline"; } 2>/dev/null | grep -q "part-3.film --part"; then
            kill -9 "$pid" && killed=yes
        fi
    done
    [ -n "$killed" ] && break
    sleep 0.05
done
for _ in $(seq 300); do [ -z "$(squeue -h)" ] && break; sleep 1; done
[ -n "$killed" ] && { [ ! -e out.exr ] || { echo "a picture without a part" >&2; exit 1; }; }
sh job.sh
for _ in $(seq 300); do [ -z "$(squeue -h)" ] && break; sleep 1; done
cmp out.exr whole.exr
echo "the picture of the farm is that of one render, again"
