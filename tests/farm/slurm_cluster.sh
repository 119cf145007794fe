#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A Slurm of its own for tests: a controller and two nodes on this machine, by Debian's packages slurmctld, slurmd,
# slurm-client and munge, without systemd. Everything is in one folder and talks by 127.0.0.1 only; a Slurm of the system
# is not touched. To be sourced where `cluster` is the name of an empty folder that all may enter.
# shellcheck disable=SC2154

declare -A daemons=() # process by name

start_munge() {
  dd if=/dev/urandom of="$cluster/munge.key" bs=128 count=1 status=none
  chmod 400 "$cluster/munge.key"
  munged --foreground --key-file="$cluster/munge.key" --socket="$cluster/munge.sock" --pid-file="$cluster/munge.pid" \
    --log-file="$cluster/munge.log" --seed-file="$cluster/munge.seed" > "$cluster/munge.out" 2>&1 &
  daemons[munged]=$!
}

write_configuration() {
  local host
  host=$(hostname -s)
  cat > "$cluster/slurm.conf" << CONF
ClusterName=vernier_test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$cluster/munge.sock
SlurmctldPort=26817
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool.%n
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.%n.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
JobRequeue=1
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=27001 CPUs=1 RealMemory=1000
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=27002 CPUs=1 RealMemory=1000
PartitionName=render Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$cluster/slurm.conf
}

start_node() {
  slurmd -D -N "$1" > "$cluster/$1.out" 2>&1 &
  daemons[$1]=$!
}

# Fails unless both nodes come up.
start_cluster() {
  mkdir "$cluster/state" "$cluster/spool.n1" "$cluster/spool.n2"
  write_configuration
  start_munge
  slurmctld -D > "$cluster/slurmctld.out" 2>&1 &
  daemons[slurmctld]=$!
  start_node n1
  start_node n2
  local tries
  for ((tries = 0; tries < 120; ++tries)); do
    if [[ $(sinfo -h -t idle -o %D 2> "$cluster/sinfo.out") == 2 ]]; then return; fi
    sleep 0.25
  done
  echo "Slurm's nodes do not come up:" >&2
  tail -n 20 "$cluster"/*.log "$cluster"/*.out >&2
  return 1
}

no_jobs() { [[ -z $(squeue -h 2> "$cluster/squeue.out") ]]; }

# Jobs first: those that watch them wait for the controller.
stop_cluster() {
  local daemon tries
  scancel --user=root > "$cluster/scancel.out" 2>&1 || true
  for ((tries = 0; tries < 120; ++tries)); do
    if no_jobs; then break; fi
    sleep 0.25
  done
  for daemon in n1 n2 slurmctld munged; do kill "${daemons[$daemon]:-}" 2> "$cluster/kill.out" || true; done
  wait
}
